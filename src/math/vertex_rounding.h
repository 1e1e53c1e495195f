// What rounding to float does to a vertex.
#pragma once

namespace tenebra::math {

/// sqrt(3) 2^-24: by how much rounding to float moves a vertex at most, for a largest |coordinate| of 1.
inline constexpr double vertex_rounding = 1.7320508075688772 * 0x1p-24;

}  // namespace tenebra::math
