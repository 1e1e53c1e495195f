// The light of scenes that have none: a sun and a soft sky. Values have no unit: they are what a white
// diffuse surface shows.
#pragma once

#include "io/image.h"

namespace tenebra::stage {

inline constexpr float default_sun = 0.75f;      ///< facing it
inline constexpr float default_sun_deg = 1;      ///< its diameter, twice the real sun's: soft shadows show it
inline constexpr float default_lamp = 0.6f;      ///< facing the lamp of a closed room
inline constexpr float default_ambient = 0.35f;  ///< facing up, in the open
inline constexpr float default_horizon = 0.3f;   ///< radiance of the horizon and of the ground below: darker
                                                 ///< than a grey model, lit or not, and lighter than shadows

/// The soft sky as an environment: the ground is as bright as the horizon, and above the sky gets brighter in
/// proportion to the sine of the height, so that what faces up gets default_ambient.
io::ImageF soft_sky();

}  // namespace tenebra::stage
