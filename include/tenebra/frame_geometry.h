// The scene at one instant, in world space: what the rasteriser draws and what the shadow rays meet.
#pragma once

#include <tenebra/scene.h>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace tenebra {

/// Where a node is at one instant.
struct NodePose {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  glm::dmat4 to_world{1.0};
  bool visible = true;           ///< its own flag and those of its ancestors
  std::size_t first_weight = 0;  ///< in Pose::weights: one a morph target of the node's mesh
};

struct Pose {
  std::vector<NodePose> nodes;
  std::vector<double> weights;
  std::vector<double> track_values;  ///< scratch
};

/// Vertices of one mesh in the space of its node, after its shapes or morph targets; and its skin's matrices.
struct DeformBuffers {
  std::vector<glm::dvec3> positions;
  std::vector<glm::dvec3> normals;
  std::vector<glm::dmat4> joints;
};

/// World-space triangles of one instant. Positions are transformed in double and rounded once to float: the
/// floats are the geometry, exact from here on. Triangle order and count are the same in all frames.
struct FrameGeometry {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;          ///< unit, or zero: the face normal; size of positions
  std::vector<glm::uvec3> triangles;       ///< triangle id -> vertices; (0,0,0) for dropped ones
  std::vector<std::uint32_t> materials;    ///< one a triangle
  std::vector<std::uint8_t> casts_shadow;  ///< one a triangle, 0 or 1
  std::vector<std::uint32_t> parts;        ///< first triangle of each mesh at its node
  std::uint32_t dropped_non_finite = 0;    ///< triangles with a NaN or infinite vertex, or beyond 1.8e18
                                           ///< (such a vertex is stored as zero: all positions are finite)
  Pose pose;                               ///< the nodes at this instant
  DeformBuffers deformed;                  ///< scratch
};

/// A light of one instant in world space.
struct WorldLight {
  int light = -1;  ///< index into Scene::lights
  int node = -1;
  glm::vec3 position{0.0f};       ///< point, spot; centre of an area light
  glm::vec3 direction{0, 0, -1};  ///< unit, the way the light shines: spot, directional, area
  glm::vec3 axis_x{1, 0, 0};      ///< area: half of its width in world space
  glm::vec3 axis_y{0, 1, 0};      ///< area: half of its height
};

/// A camera of one instant: the rays through the pixels. With pixel (x, y), row 0 at the top, the ray through
/// its centre starts at `eye` (perspective) and runs along d0 + (x + 0.5) dx + (y + 0.5) dy.
/// Orthographic: it starts at eye + (x + 0.5) dx + (y + 0.5) dy and runs along d0.
/// The floats are exact from here on; the rasteriser's matrix is made from them too.
struct ViewRays {
  glm::vec3 eye{0.0f};
  glm::vec3 d0{0, 0, -1};
  glm::vec3 dx{1, 0, 0};
  glm::vec3 dy{0, -1, 0};
  bool orthographic = false;
  float near_m = 0.1f;  ///< distance of the near plane along the view axis
};

/// Evaluates nodes, skins, morph targets and shapes of clip `clip` (-1: none, the rest pose) at `time_s`.
/// `out` keeps its capacity.
void evaluate_frame(const Scene& scene, int clip, double time_s, FrameGeometry& out);
std::vector<WorldLight> evaluate_lights(const Scene& scene, int clip, double time_s);

/// Rays of camera `camera` (an index into Scene::cameras; its first node places it).
ViewRays evaluate_camera(const Scene& scene, int clip, double time_s, int camera, int width, int height);
/// Rays of a camera at `eye`; `up` parallel to the view axis falls back to another axis.
ViewRays look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, float vertical_fov_rad, float near_m,
                 int width, int height);

}  // namespace tenebra
