// How casters hide ambient light from points of other bodies: rigid objects by their fields, all else by cast
// rays. Fields are made when first needed, kept while the objects stay the same.
//
// Static geometry close to moving objects (floors under feet) is met by rays that end at the reach: these are
// exact at the contact, where tables are not. Objects of few triangles are met by rays, too: their tree is a
// block or two.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "ao/casters/casters.h"
#include "ao/field/field_lookup.h"
#include "ao/field/shape_fields.h"

namespace tenebra::ao {

/// Work of one group of receivers, added up in the order of the groups.
struct OccluderCounts {
  std::uint64_t lookups = 0;
  std::uint64_t rays_cast = 0;
};

/// By the numbers of Casters.
class FieldOccluders {
public:
  /// An object of up to this many triangles needs no field: its tree is two blocks. With a limit of 128,
  /// robots 100 took 1.8 times as long, with 600 city 60 took 5.3 times as long, at the same error: an entry
  /// of a table is quicker than any tree.
  static constexpr std::size_t few_triangles = 16;

  /// Keeps references to both.
  FieldOccluders(Casters& casters, MemoryBudget& budget) : casters_(&casters), fields_(budget) {}

  /// Objects found anew. Fields of shapes that are still there stay.
  void reset(const SceneObjects& objects);
  /// After that of the casters. `frame`: counts calls. What is in the making when a stop is requested is not
  /// kept.
  void begin_frame(const FieldSettings& settings, const std::filesystem::path& cache, SimdLevel level,
                   std::uint64_t frame, const StopFlag* stop);

  const Casters& casters() const { return *casters_; }
  /// Like Casters::reaches, but for a receiver's own body, whose surface is sampled (not that of an object
  /// which is stretched or sheared: its samples would not hold).
  bool reaches(int occluder, std::span<const Receiver> receivers, std::uint8_t* out) const;
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

private:
  struct Shape {
    std::uint64_t hash = 0;
    bool by_rays = false;
  };
  int shape_of(int object) const { return casters_->objects().objects[index(object)].shape; }
  static std::size_t index(int number) { return static_cast<std::size_t>(number); }
  void place(int object, const DisplacementField& field);
  Expected<void> build_object(int object, const AoProgress& progress);
  void load_fields(std::span<const int> occluders);
  bool wants_field(int shape, const trees::TriangleBvh& tree);

  Casters* casters_;
  const StopFlag* stop_ = nullptr;
  FieldSettings settings_;
  FieldKernels kernels_;
  std::vector<Shape> shapes_;
  ShapeFields fields_;
  std::vector<std::optional<FieldInstance>> instances_;  ///< one for each object
};

}  // namespace tenebra::ao
