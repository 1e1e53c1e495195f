// The order of triangles for clusters: near ones of like size together.
#pragma once

#include <cstdint>
#include <vector>

#include <tenebra/stop_flag.h>
#include <tenebra/visible_points.h>

namespace tenebra::shadow {

/// Ids of all casters: by class of size (largest first), within a class part by part (triangles that move
/// together stay together), within a part cut in halves. Classes begin at multiples of 256, the length
/// is a multiple of 16; gaps are no_triangle. Of no use if `stop` was requested.
void cluster_order(const TriangleView& triangles, std::vector<std::uint32_t>& order, const StopFlag* stop);

}  // namespace tenebra::shadow
