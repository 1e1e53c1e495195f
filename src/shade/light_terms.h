// A light as shading sees it: constants of a frame.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include <tenebra/area_light.h>
#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>

namespace tenebra::shade {

/// A light that a frame draws.
struct DrawnLight {
  Light light;
  WorldLight placed;
  std::optional<AreaLight> area{};  ///< it shines as this polygon: its samples come with their irradiance,
                                    ///< its shadows are soft; none: as a point, or from a direction
  std::optional<AreaLight> back{};  ///< shines alike in every direction: the polygon's other side
  int number = -1;                  ///< its place in the frame's list of lights; emissive meshes follow them
};

/// The shares of a light's red, green and blue that see-through surfaces let pass at each sample; empty: all
/// of it.
struct TintFactors {
  static constexpr std::size_t run = 64;
  std::span<const glm::vec3> factors;
  std::span<const std::uint8_t> coloured;  ///< one for each `run` samples: 0 where all are white
};

/// How much of a light reaches each sample.
struct LightFactors {
  std::span<const std::uint8_t> mask;  ///< without area: 255 lit to 0 dark; empty: all lit
  std::span<const float> irradiance;   ///< with an area: of a light of radiance 1
  TintFactors tint;
};

/// What the kernels need of a light. What a white diffuse surface that faces it shows is color * fade; fade
/// is made of distance and angle.
struct LightTerms {
  glm::vec3 color{0.0f};
  glm::vec3 from_eye{0.0f};    ///< place relative to the eye: far from the origin absolute floats are coarse
  glm::vec3 direction{0.0f};   ///< unit, the way it shines
  glm::vec2 cone{0.0f, 1.0f};  ///< scale and offset of the cosine
  float range_m = 0;           ///< 0: unbounded
  int distance_power = 0;      ///< -2, 0 or 2
  bool directional = false;
  bool spot = false;
  bool cosine_emitter = false;
  bool by_irradiance = false;  ///< the cosine at the surface comes with the irradiance

  // By irradiance: the polygon, for what mirrors it.
  glm::vec3 area_from_eye{0.0f};  ///< its centre relative to the eye; of a sun the unit direction to it
  float area_weight = 1;          ///< 0: a sun, seen in that direction from everywhere
  glm::vec3 area_normal{0.0f};
  glm::vec3 axis_x{0.0f}, axis_y{0.0f};  ///< unit
  int corner_count = 0;
  std::array<glm::vec2, 14> corners{};  ///< along the axes, metres, counter-clockwise; of a sun at 1 m
  float radius_m = 0;                   ///< of the disc of the same area
};
LightTerms light_terms(const DrawnLight& light, const ViewRays& view);

/// Fading with distance and angle at one point, by the formula of diffuse-inl.h, in double; not of
/// directional lights. `to_light`: unit, from the point to the light's place.
double fade_of(const LightTerms& terms, const glm::dvec3& to_light, double distance);

}  // namespace tenebra::shade
