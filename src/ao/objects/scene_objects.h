// The scene as ambient occlusion sees it: static geometry (one body in world space), objects that move (each
// in its own space; equal ones share one shape), and triangles that deform. A node moves if a channel of any
// clip changes it; all meshes below the deepest such ancestor move as one, so a robot's limb is one object
// however many nodes it is modelled with.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include <tenebra/stop_flag.h>
#include "ao/objects/node_motion.h"

namespace tenebra::ao {

/// Triangles in the space of the object (what stands: world space).
struct ObjectShape {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;     ///< size of positions; unit, or zero: the face normal
  std::vector<glm::uvec3> triangles;  ///< one with three equal corners does not count
  std::vector<std::uint8_t> casts;    ///< one per triangle: occludes
  glm::vec3 center{0.0f};             ///< a sphere about the casting triangles
  float radius = 0;                   ///< 0: none casts
  std::uint64_t hash = 0;             ///< of the geometry
};

/// The shape's triangles that cast; not all of them if `stop` is requested.
std::vector<glm::uvec3> casting_triangles(const ObjectShape& shape, const StopFlag* stop = nullptr);

struct MovingObject {
  std::string name;
  int node = -1;              ///< whose motion it shares
  int shape = -1;             ///< index into SceneObjects::shapes
  glm::dvec3 own_scale{1.0};  ///< of the node, over its largest: part of the shape
  double scale = 1.0;         ///< metres in the world per unit of the object, when found
  // Of this instant:
  glm::dmat4 to_world{1.0};
  glm::dmat4 to_object{1.0};
  double largest_scale = 1.0;  ///< no vector grows by more
  bool rigid = true;    ///< to_world is a rotation (or reflection), `scale` and a translation, nothing else
  bool visible = true;  ///< drawn, and not flattened to nothing
};

/// Whose triangle it is.
struct TriangleOwner {
  static constexpr std::int32_t standing = -1, deforming = -2;
  std::int32_t object = standing;  ///< or an index into SceneObjects::objects
  std::uint32_t triangle = 0;      ///< in the object's shape; deforming: meaningless
};

struct SceneObjects {
  ObjectShape standing;
  std::vector<ObjectShape> shapes;
  std::vector<MovingObject> objects;
  std::vector<TriangleOwner> owners;         ///< one per triangle of the frame
  std::vector<std::uint32_t> deforming;      ///< ids of triangles that deform
  std::vector<std::string> deforming_names;  ///< of their meshes, each once
  NodeMotion motion;
  std::uint64_t signature = 0;  ///< of all that must not change while the above is kept
};

/// Everything anew, at the instant of `geometry`. Of no use if `stop` was requested.
SceneObjects find_objects(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop = nullptr);

/// Moves the objects to the instant of `geometry`. False if what stood has moved: then they have to be found
/// anew.
bool move_objects(const Scene& scene, const FrameGeometry& geometry, SceneObjects& objects);

}  // namespace tenebra::ao
