// What rays may meet in a frame: moving objects, each in its own space, geometry that stands, and what
// deforms. Trees over their triangles are made when first needed and kept while the shapes stay the same.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/stop_flag.h>
#include "ao/cache/tree_file.h"
#include "ao/cast/ray_kernels.h"
#include "ao/objects/scene_objects.h"
#include "ao/objects/sphere.h"
#include "ao/receivers/receivers.h"
#include "math/box.h"
#include "trees/triangle_bvh.h"

namespace tenebra::ao {

/// For one frame.
struct CasterSettings {
  double reach = 0;              ///< metres: nothing farther away is met
  bool deforming = true;         ///< what deforms is met, too
  std::filesystem::path folder;  ///< keeps trees; empty: none
};

/// Casters have numbers: those of the objects, then standing(), deforming() and gathered().
class Casters {
public:
  /// Triangles that gather() puts into one tree: more take too long to build anew.
  static constexpr std::size_t most_gathered = 100'000;

  /// Objects found anew. Trees of shapes that are still there stay.
  void reset(const SceneObjects& objects);
  /// The instant of `geometry`. Keeps references to both, and to `stop`, until the next call. What is in the
  /// making when a stop is requested is not kept.
  void begin_frame(const SceneObjects& objects, const FrameGeometry& geometry, const CasterSettings& settings,
                   const RayKernels& kernels, const StopFlag* stop);

  const SceneObjects& objects() const { return *objects_; }
  int standing() const { return static_cast<int>(objects_->objects.size()); }
  int deforming() const { return standing() + 1; }
  int gathered() const { return standing() + 2; }
  bool is_object(int caster) const { return caster < standing(); }
  /// Whose triangles an owner's are.
  int of(const TriangleOwner& owner) const {
    return owner.object >= 0                         ? owner.object
           : owner.object == TriangleOwner::standing ? standing()
                                                     : deforming();
  }

  /// What may come within the reach of a point in the box, in ascending order.
  void near(const math::Box<double>& box, std::vector<int>& out) const;
  /// Whether a caster hides its own points, or whether that is somebody else's business.
  enum class Itself { counts, left_out };
  /// out[i]: whether any part of it may lie above receiver i's planes, within the reach. Returns whether any
  /// is.
  bool reaches(int caster, std::span<const Receiver> receivers, Itself itself, std::uint8_t* out) const;

  /// Puts into one tree, in the world, all that moves or deforms and is named in `casters`, for this frame:
  /// gathered(). False, and nothing made, if there is nothing or too much of it, or a stop was requested.
  bool gather(std::span<const int> casters);
  /// Makes the trees of `casters` that are not there, until a stop is requested.
  void build(std::span<const int> casters);
  /// Null: not made yet.
  const trees::TriangleBvh* tree(int caster) const;
  /// The trees over the casting triangles of a shape, and of what stands: those of many triangles are kept on
  /// disk. Made if they are not there; null: a stop was requested.
  const trees::TriangleBvh* shape_tree(int shape);
  const trees::TriangleBvh* standing_tree();

  /// Where the rays of a receiver start: its position, lifted off its face.
  glm::dvec3 start_of(const Receiver& receiver) const;
  /// Shortens the distances of rays of one receiver, which run in the world from start_of(), to where they
  /// hit the caster. Its tree is there. Adds to `rays_cast`.
  void meet(int caster, const Receiver& receiver, const glm::dvec3& origin,
            std::span<const trees::RayBatch> rays, float* distances, std::uint64_t& rays_cast) const;
  /// Like meet() for rays of any receivers: those of a batch start at one point.
  void meet_each(int caster, std::span<const trees::RayBatch> rays, float* distances,
                 std::uint64_t& rays_cast) const;

  /// On files that hold trees.
  std::vector<std::string> take_notes() { return std::exchange(files_.notes, {}); }

private:
  struct ShapeTree {
    std::uint64_t hash = 0;  ///< of the shape
    std::optional<trees::TriangleBvh> tree;
    float lift = 0;  ///< surface_lift(), once there is a tree
    math::Box<float> box;
  };
  /// In this frame.
  struct Placed {
    int shape = -1;  ///< of an object
    Sphere sphere;   ///< world; no radius: nothing is met
    glm::mat4x3 to_object{1.0f};
  };
  const trees::TriangleBvh* tree_of(ShapeTree& kept, const ObjectShape& shape);
  const ShapeTree& shape_of(int object) const { return shapes_[index(placed_[index(object)].shape)]; }
  void place_object(std::size_t object);
  static std::size_t index(int number) { return static_cast<std::size_t>(number); }

  const SceneObjects* objects_ = nullptr;
  const FrameGeometry* geometry_ = nullptr;
  const StopFlag* stop_ = nullptr;
  RayKernels kernels_;
  double reach_ = 0;
  float standing_lift_ = 0;
  std::vector<ShapeTree> shapes_;  ///< one for each shape
  ShapeTree standing_;
  std::optional<trees::TriangleBvh> deforming_, gathered_;
  std::vector<Placed> placed_;     ///< one for each caster
  std::vector<std::size_t> by_x_;  ///< visible objects by the middle of their spheres
  double largest_radius_ = 0;      ///< of objects
  KeptTrees files_;
};

}  // namespace tenebra::ao
