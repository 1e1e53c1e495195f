// How geometry that keeps its shape hides itself: one table of samples for all instances of one shape and
// size.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tenebra/ao_config.h>
#include <tenebra/expected.h>

#include "ao/casters/casters.h"
#include "ao/surface/sample_file.h"
#include "ao/surface/self_occlusion.h"

namespace tenebra::ao {

/// A sample of a body that a receiver lacks.
struct MissingSample {
  std::uint32_t body;
  std::uint64_t sample;
  auto operator<=>(const MissingSample&) const = default;
};

class Bodies {
public:
  explicit Bodies(MemoryBudget& budget) : budget_(&budget) {}
  /// Writes what is not on disk yet.
  ~Bodies() {
    save_all([](const Body&) { return true; });
  }
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;

  /// No body is made yet; samples that were there for more than one frame are written to disk. Keeps a
  /// reference to `objects` until the next call.
  void reset(const SceneObjects& objects, double reach);
  /// `cache`: folder that keeps samples; empty: nowhere.
  void begin_frame(std::uint64_t frame, const std::filesystem::path& cache);

  /// Whether what an object's points lie on keeps its shape.
  bool exists(std::int32_t object) const {
    return object == TriangleOwner::standing ||
           (object >= 0 && objects_->objects[static_cast<std::size_t>(object)].rigid);
  }
  /// Number of an object's body; -1 if it has none or it is not made yet.
  int number(std::int32_t object) const { return exists(object) ? at_[index(object)] : -1; }
  const SelfOcclusion& body(int number) const { return *bodies_[static_cast<std::size_t>(number)].samples; }

  /// Makes the bodies of `objects` (ascending, unique): with samples, those on disk among them, or, without
  /// room, answered by rays. Some of them, if `stop` is requested.
  void make(std::span<const int> objects, Casters& casters, const StopFlag* stop);
  /// A body is needed in this frame.
  void use(int number) { bodies_[static_cast<std::size_t>(number)].used = frame_; }
  /// Casts the rays of what is missing (ascending, unique). Fails with "stopped".
  Expected<void> fill(std::span<const MissingSample> missing, const RayKernels& kernels,
                      const AoProgress& progress, const StopFlag* stop);
  /// Writes those of which much is new to disk: a body that is there for one frame alone leaves no file, and
  /// one that is seen little by little is not written again for each frame.
  void save_grown();

  /// Of those with samples that this frame does not need, the one that was used least recently.
  std::optional<LastUse> oldest() const;
  void drop_oldest();

  std::uint64_t filled() const;  ///< samples cast, of all bodies
  std::uint64_t known() const;   ///< samples in memory
  std::size_t bytes() const;
  std::vector<std::string> take_notes() { return std::exchange(notes_, {}); }

private:
  struct Body {
    int shape = -1;
    CacheKey key;
    std::unique_ptr<SelfOcclusion> samples;
    std::uint64_t made = 0, used = 0;  ///< frames
    std::uint64_t saved = 0;           ///< samples on disk, of those known()
    LastUse last_use() const { return {used, shape}; }
  };
  std::size_t index(std::int32_t object) const {
    return object == TriangleOwner::standing ? objects_->objects.size() : static_cast<std::size_t>(object);
  }
  int body_of(std::int32_t object, Casters& casters);
  void load(std::span<const int> bodies);
  void save(Body& body);
  void save_all(const std::function<bool(const Body&)>& chosen);
  std::vector<Body>::const_iterator find_oldest() const;

  MemoryBudget* budget_;
  const SceneObjects* objects_ = nullptr;
  double reach_ = 0;
  std::uint64_t frame_ = 0;
  std::filesystem::path cache_;
  std::vector<Body> bodies_;
  std::vector<int> at_;  ///< one per object, the last of what stands; -1 until made
  std::vector<std::string> notes_;
  bool unwritten_ = false;  ///< a file could not be written, which was noted
};

}  // namespace tenebra::ao
