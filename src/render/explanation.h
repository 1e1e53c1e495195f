// Why is it dark? What one pixel sees, and for each light what is in its way.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/frame_lights.h"
#include "shadow/rays/sightlines.h"

namespace tenebra::render {

/// A pixel of a frame, and the data that the frame was made from.
struct PixelQuestion {
  const Scene& scene;             ///< for its nodes: as the frame's
  const FrameGeometry& geometry;  ///< of the frame, its see-through surfaces cast as the settings say
  const ViewRays& view;
  std::span<const std::uint32_t> ids;  ///< Renderer::triangle_ids
  int width = 0;
  std::span<const DrawnLight> lights;  ///< Renderer::drawn_lights
  std::span<const LightMask> masks;    ///< FrameResult::masks; empty: without shadows
  const RenderSettings& settings;
  glm::ivec2 pixel{0};  ///< within the picture
};

/// A triangle and what it belongs to; -1: nothing.
struct TrianglePlace {
  std::uint32_t triangle = no_triangle;
  int node = -1;      ///< index into Scene::nodes
  int material = -1;  ///< index into Scene::materials
};

/// One light as the pixel's sample sees it.
struct LightExplanation {
  int number = -1;  ///< DrawnLight::number
  std::string name;
  /// What the mask says of a light without an area; of one with an area, `lit` if any of it is visible.
  shadow::LightSight sight = shadow::LightSight::lit;
  /// Without an area: whether the shading normal faces the light. Where it does not, light that comes to the
  /// sample does not shine on it.
  bool faces_shading = true;
  std::optional<float> visible_fraction;  ///< of a light with an area, 0 to 1: the mask's
  /// What is in the way: the first triangle on the sightline to the light; of lights with an area the one
  /// that is first on most of `asked` sightlines to points spread over it. None where all are free.
  std::optional<TrianglePlace> occluder;
  glm::dvec3 met_at{0.0};  ///< where the sightline meets it
  int asked = 1;
  int held_by_it = 0;       ///< of these, sightlines on which it is first
  glm::vec3 light_at{0.0};  ///< where the sightline ends; of directional lights a direction towards them
  bool directional = false;
};

struct PixelExplanation {
  bool background = true;  ///< nothing is seen, and what follows is empty
  TrianglePlace seen;
  glm::dvec3 point{0.0};  ///< the sample, world space; lifted off its triangle where the settings say so
  std::vector<LightExplanation> lights;
};

/// Exact where the mask is: sightlines are lit where it has 255. Takes milliseconds: every triangle is looked
/// at once for each light.
PixelExplanation explain_pixel(const PixelQuestion& question);

/// The node whose mesh has this triangle of a frame of `scene`; -1: none.
int node_of_triangle(const Scene& scene, const FrameGeometry& geometry, std::uint32_t triangle);

}  // namespace tenebra::render
