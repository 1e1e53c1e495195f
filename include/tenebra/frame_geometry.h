// The scene at one instant, in world space: the triangles that are drawn and that cast shadows.
#pragma once

#include <tenebra/scene.h>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <vector>

namespace tenebra {

/// Where a node is at one instant.
struct NodePose {
  glm::dvec3 translation{0.0};              ///< in the parent's space, metres
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit, in the parent's space
  glm::dvec3 scale{1.0};                    ///< in the parent's space
  glm::dmat4 to_world{1.0};                 ///< from the space of the node to world space
  bool visible = true;                      ///< its own flag and those of its ancestors
  std::size_t first_weight = 0;  ///< in Pose::weights: one for each morph target of the node's mesh
};

/// Where all nodes are at one instant.
struct Pose {
  std::vector<NodePose> nodes;       ///< one for each of Scene::nodes
  std::vector<double> weights;       ///< of morph targets, node after node
  std::vector<double> track_values;  ///< scratch
};

/// Scratch for one mesh: its vertices in the space of its node, after shapes or morph targets, and its skin's
/// matrices.
struct DeformBuffers {
  std::vector<glm::dvec3> positions;  ///< metres
  std::vector<glm::dvec3> normals;    ///< not unit
  std::vector<glm::dvec4> tangents;   ///< as Mesh::tangents, not unit
  std::vector<glm::dmat4> joints;     ///< one for each of Skin::joints
};

/// World-space triangles of one instant. Positions are transformed in double and rounded once to float; from
/// here on the floats are taken as exact. Triangle order and count are the same in all frames.
struct FrameGeometry {
  std::vector<glm::vec3> positions;  ///< metres, world space; finite
  std::vector<glm::vec3> normals;    ///< unit, or zero: the face normal; size of positions
  /// Size of positions, or empty. Unit, along the surface: where the x of a normal map points to; its y along
  /// w * cross(normal, tangent), w 1 or -1. Zero: where the first coordinate of the map grows.
  std::vector<glm::vec4> tangents;
  std::vector<glm::uvec3> triangles;       ///< triangle id -> vertices; (0,0,0) for dropped ones
  std::vector<std::uint32_t> materials;    ///< one for each triangle
  std::vector<std::uint8_t> casts_shadow;  ///< one for each triangle, 0 or 1
  /// One for each triangle; empty: all 0, opaque. 1 and 2 are see-through: drawn over what is behind them,
  /// with casts_shadow 0. 1 dims and tints the light that passes; 2 would if it cast shadows.
  std::vector<std::uint8_t> see_through;
  std::vector<std::uint32_t> parts;      ///< first triangle of each mesh at its node
  std::uint32_t dropped_non_finite = 0;  ///< triangles with a NaN or infinite vertex, or beyond 1.8e18
                                         ///< (such a vertex is stored as zero: all positions are finite)
  Pose pose;                             ///< the nodes at this instant
  DeformBuffers deformed;                ///< scratch
};

/// What does not change from instant to instant: texture coordinates and colours of FrameGeometry's vertices,
/// in the same order. Empty lists where no mesh has any.
struct SurfaceCoordinates {
  std::array<std::vector<glm::vec2>, 2> texture_coordinates;  ///< (0,0) a picture's top left
  std::vector<glm::vec4> colors;                              ///< white where a mesh has none
};
/// The coordinates of the vertices that evaluate_frame makes from `scene`.
SurfaceCoordinates surface_coordinates(const Scene& scene);

/// A light of one instant in world space.
struct WorldLight {
  int light = -1;                 ///< index into Scene::lights
  int node = -1;                  ///< index into Scene::nodes
  glm::vec3 position{0.0f};       ///< of point and spot lights; the centre of area lights
  glm::vec3 direction{0, 0, -1};  ///< unit, the way that spot, directional and area lights shine
  glm::vec3 axis_x{1, 0, 0};      ///< area lights: half of the width
  glm::vec3 axis_y{0, 1, 0};      ///< area lights: half of the height

  // Values that the clip gives the light at this instant instead of the scene's; empty: it gives none.
  std::optional<glm::vec3> color;       ///< as Light::color
  std::optional<float> intensity;       ///< as Light::intensity
  std::optional<float> range_m;         ///< as Light::range_m
  std::optional<float> inner_cone_rad;  ///< as Light::inner_cone_rad
  std::optional<float> outer_cone_rad;  ///< as Light::outer_cone_rad
};

/// The scene's light with what the clip changes of it at that instant.
Light light_at(const Scene& scene, const WorldLight& placed);

/// A camera at one instant, as the rays through its pixels. The ray through the centre of pixel (x, y), row 0
/// at the top, starts at `eye` and runs along d0 + (x + 0.5) dx + (y + 0.5) dy; in orthographic views it
/// starts at eye + (x + 0.5) dx + (y + 0.5) dy and runs along d0. The floats are taken as exact from here on;
/// the rasteriser's matrix is made from them too.
struct ViewRays {
  glm::vec3 eye{0.0f};        ///< metres, world space
  glm::vec3 d0{0, 0, -1};     ///< any length but zero
  glm::vec3 dx{1, 0, 0};      ///< from one column to the next
  glm::vec3 dy{0, -1, 0};     ///< from one row to the next, down the picture
  bool orthographic = false;  ///< parallel rays
  float near_m = 0.1f;        ///< distance of the near plane along the view axis
};

/// Evaluates nodes, skins, morph targets and shapes at `time_s` of clip `clip` (-1: no clip, the rest pose).
/// `out` keeps its capacity, so use one object for all frames.
void evaluate_frame(const Scene& scene, int clip, double time_s, FrameGeometry& out);
/// The scene's lights at that instant, one for each node that has one.
std::vector<WorldLight> evaluate_lights(const Scene& scene, int clip, double time_s);

/// Rays of camera `camera`, an index into Scene::cameras; the first node that has it says where it is.
ViewRays evaluate_camera(const Scene& scene, int clip, double time_s, int camera, int width, int height);
/// Rays of a camera at `eye`. If `up` is parallel to the view axis, another axis takes its place.
ViewRays look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, float vertical_fov_rad, float near_m,
                 int width, int height);

}  // namespace tenebra
