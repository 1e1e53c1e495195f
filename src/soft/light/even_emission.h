// Lights whose every part shines with the same intensity in every direction, to both sides, as a point light
// does: seen from afar they are that point light.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include <tenebra/area_light.h>
#include <tenebra/simd_level.h>
#include <tenebra/soft_config.h>
#include <tenebra/visible_points.h>

namespace tenebra::soft {

/// The light turned round: the same vertices, with front and back exchanged.
AreaLight reversed(const AreaLight& light);

/// Whether a visible point lies behind the light's plane.
bool any_behind(const VisiblePoints& points, const AreaLight& light);

/// cos / d^2 integrated over the polygon's part in the hemisphere of the unit `normal` at `at`: what a light
/// of 1 cd/m2 in every direction sends if nothing is in between. In closed form; error below 1e-12 of the
/// same integral without the cosine, or 1e-15 times the distance over the light's size if that is more.
double even_irradiance(const AreaLight& light, const glm::dvec3& at, const glm::dvec3& normal);

/// Irradiance as from radiance 1 (the same integral times the cosine at the light), also in closed form, and
/// for suns, too.
double whole_irradiance(const AreaLight& light, const glm::dvec3& at, const glm::dvec3& normal);

/// Turns the irradiance in `mask`, which is that of radiance 1 (SoftShadowTracer's of `light`, with these
/// normals), into that of 1 cd/m2 in every direction. Fractions stay as they are.
///
/// Points that see the whole light, or all of it that is above their horizon: even_irradiance, within 1e-5 of
/// area / distance^2. In a penumbra: even_irradiance times the visible share of the irradiance from radiance
/// 1. So light and shadow are exact, and a penumbra has its exact place and width and never grows lighter
/// towards the shadow; within it, the light's parts have the weights of a diffuse light in place of their
/// own, which differ by the cosine at the light over its mean: by nothing for lights that are small compared
/// with their distance. The same bits for any number of threads and each vector level.
void weigh_evenly(const VisiblePoints& points, std::span<const glm::vec3> normals, const AreaLight& light,
                  SimdLevel simd, SoftMask& mask);

}  // namespace tenebra::soft
