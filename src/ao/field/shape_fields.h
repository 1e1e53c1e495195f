// The fields of a scene's shapes: read from disk or built when first needed, kept as long as there is room.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include "ao/cache/cache_file.h"
#include "ao/cache/memory_budget.h"
#include "ao/field/displacement_field.h"
#include "ao/objects/scene_objects.h"

namespace tenebra::ao {

class ShapeFields {
public:
  explicit ShapeFields(MemoryBudget& budget) : budget_(&budget) {}

  /// Shapes found anew: fields of those that are still there stay.
  void reset(const std::vector<ObjectShape>& shapes);
  /// `frame` counts calls. `cache`: folder that keeps fields; empty: nowhere. Keeps a reference to `shapes`.
  void begin_frame(const std::vector<ObjectShape>& shapes, const FieldSettings& settings,
                   const std::filesystem::path& cache, std::uint64_t frame);

  /// Null: none yet, or no room.
  const DisplacementField* find(int shape) const {
    const auto& field = fields_[static_cast<std::size_t>(shape)].field;
    return field ? &*field : nullptr;
  }
  /// There was no room for it, in this frame.
  bool refused(int shape) const { return fields_[static_cast<std::size_t>(shape)].refused; }
  /// A shape's field is needed in this frame.
  void use(int shape) { fields_[static_cast<std::size_t>(shape)].used = frame_; }

  /// Reads those of `shapes` (ascending, unique) that are on disk, many at once.
  void load(std::span<const int> shapes);
  /// Null: no room. Fails with "stopped".
  Expected<const DisplacementField*> make(int shape, const trees::TriangleBvh& casters,
                                          const FieldProgress& progress, const StopFlag* stop);

  /// Of those that this frame does not need, the one that was used least recently, by the number of its
  /// shape.
  std::optional<LastUse> oldest() const;
  void drop(int shape) { fields_[static_cast<std::size_t>(shape)].drop(); }

  std::uint64_t built() const { return built_; }  ///< since begin_frame
  std::size_t bytes() const;
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

private:
  struct Kept {
    std::uint64_t hash = 0;  ///< of the shape
    std::optional<DisplacementField> field;
    MemoryShare share;
    std::uint64_t used = 0;  ///< frame that needed it last
    bool refused = false;
    void drop() { field.reset(), share = {}; }
  };
  bool make_room(Kept& kept);
  CacheKey key_of(int shape) const;

  MemoryBudget* budget_;
  std::uint64_t frame_ = 0;
  const std::vector<ObjectShape>* shapes_ = nullptr;
  FieldSettings settings_;
  std::filesystem::path cache_;
  std::vector<Kept> fields_;  ///< one per shape
  std::uint64_t built_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace tenebra::ao
