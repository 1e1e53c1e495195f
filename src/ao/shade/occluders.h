// What can hide ambient light in a frame beyond the receiver's own body: rigid objects by their fields,
// static and deforming geometry by cast rays; with `--ao adaptive` everything by cast rays, the own body,
// too. Made when first needed, kept while the objects stay the same.
//
// Static geometry close to moving objects (floors under feet) is met by rays that end at the reach: these are
// exact at the contact, where tables are not. Objects of few triangles are met by rays, too: their tree is a
// block or two.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/expected.h>
#include "ao/cache/tree_file.h"
#include "ao/field/ao_kernels.h"
#include "ao/field/shape_fields.h"
#include "ao/objects/scene_objects.h"
#include "ao/shade/receivers.h"
#include "math/box.h"
#include "trees/triangle_bvh.h"

namespace tenebra::ao {

/// Work of one tile, added up in the order of the tiles.
struct OccluderCounts {
  std::uint64_t lookups = 0;
  std::uint64_t rays_cast = 0;
};

class Occluders {
public:
  /// An object of up to this many triangles needs no field: its tree is two blocks. With a limit of 128,
  /// robots 100 took 1.8 times as long, with 600 city 60 took 5.3 times as long, at the same error: an entry
  /// of a table is quicker than any tree.
  static constexpr std::size_t few_triangles = 16;
  static constexpr int standing = -1, deforming = -2;  ///< beside the indices of objects
  static constexpr int moving = -3;  ///< all that moves or deforms, as gather_moving() found it
  static constexpr std::size_t most_gathered = 100'000;  ///< triangles: more take too long to build anew

  explicit Occluders(MemoryBudget& budget) : fields_(budget) {}

  /// Objects found anew. Fields of shapes that are still there stay.
  void reset(const SceneObjects& objects);
  /// The instant of `geometry`. Keeps references to both, and to `stop`, until the next call. `frame`: counts
  /// calls. What is in the making when a stop is requested is not kept.
  void begin_frame(const SceneObjects& objects, const FrameGeometry& geometry, const AoConfig& config,
                   double reach, std::uint64_t frame, const StopFlag* stop);

  /// What may come within the reach of a point in the box: objects in ascending order, then `standing`,
  /// `deforming`.
  void near(const math::Box<double>& box, std::vector<int>& out) const;
  /// How a rigid body hides its own points: by samples of its surface, so that it is no occluder of theirs,
  /// or as any other does.
  enum class Itself { by_samples, counts };
  /// out[i]: whether any part of it may lie above receiver i's planes, within the reach, and is not its own
  /// body (but for an object that is stretched or sheared: samples of its surface would not hold). Returns
  /// whether any is.
  bool reaches(int occluder, std::span<const Receiver> receivers, std::uint8_t* out,
               Itself itself = Itself::by_samples) const;
  bool ready(int occluder) const;
  /// Makes what `missing` (ascending, unique) lacks. Fails with "stopped".
  Expected<void> build(std::span<const int> missing, const AoProgress& progress);

  /// An occluder is needed in this frame: its field stays.
  void use(int occluder);
  ShapeFields& fields() { return fields_; }
  void drop_field(int shape);

  /// Shortens the distances of rays of points on object `owner` to where they hit `occluder`. The rays of a
  /// batch start at one point.
  void meet(int occluder, std::int32_t owner, std::span<const trees::RayBatch> rays, float* distances,
            OccluderCounts& counts) const;

  /// One tree, in the world, of all that moves and is named in `occluders` (what deforms too), for this
  /// frame. False, and nothing made, if there is nothing or too much of it, or a stop was requested.
  bool gather_moving(std::span<const int> occluders);
  /// Makes the trees of `occluders` that are not there, until a stop is requested: what meet_triangles()
  /// needs.
  void build_trees(std::span<const int> occluders);
  /// Like meet(), but by triangles alone, those of the receiver's own body, too. The rays run in the world
  /// and start at `origin`: the receiver's position, lifted off its face.
  void meet_triangles(int occluder, const Receiver& receiver, const glm::dvec3& origin,
                      std::span<const trees::RayBatch> rays, float* distances, OccluderCounts& counts) const;

  /// The tree over the casting triangles of a shape, or of what stands (-1): those of many triangles are kept
  /// on disk. Null: a stop was requested.
  const trees::TriangleBvh* casters(int shape);

  std::vector<std::string> take_notes();

private:
  const Sphere& sphere(int occluder) const;
  const trees::TriangleBvh& world_tree(int occluder) const;
  struct Shape {
    std::uint64_t hash = 0;
    std::optional<trees::TriangleBvh> casters;
    bool by_rays = false;
    float lift = 0;  ///< surface_lift(), once there are casters
    math::Box<float> box;
  };
  struct Placed {
    int shape = -1;
    bool visible = false;
    Sphere sphere;  ///< world
    std::optional<FieldInstance> instance;
    glm::mat4x3 to_object{1.0f};
  };
  Expected<void> build_object(std::size_t object, const AoProgress& progress);
  std::optional<trees::TriangleBvh> tree_of_deforming() const;
  void load_fields(std::span<const int> occluders);
  bool wants_field(int shape, const trees::TriangleBvh& casters);
  void place(std::size_t object);

  const SceneObjects* objects_ = nullptr;
  const FrameGeometry* geometry_ = nullptr;
  const StopFlag* stop_ = nullptr;
  FieldSettings settings_;
  AoKernels kernels_;
  double reach_ = 0;
  std::vector<Shape> shapes_;
  ShapeFields fields_;
  std::vector<Placed> placed_;     ///< one per object
  std::vector<std::size_t> by_x_;  ///< visible objects by the middle of their spheres
  double largest_radius_ = 0;
  std::optional<trees::TriangleBvh> standing_, deforming_, moving_;
  Sphere standing_sphere_, deforming_sphere_, moving_sphere_;
  KeptTrees trees_;
};

}  // namespace tenebra::ao
