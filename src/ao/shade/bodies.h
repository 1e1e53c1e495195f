// What keeps its shape, as it hides itself: one table of samples for all instances of one shape and size.
#pragma once

#include <memory>
#include <vector>

#include "ao/shade/occluders.h"
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
  /// None made yet. Keeps a reference to `objects` until the next call.
  void reset(const SceneObjects& objects, double reach);

  /// Whether what an object's points lie on keeps its shape.
  bool exists(std::int32_t object) const {
    return object == TriangleOwner::standing ||
           (object >= 0 && objects_->objects[static_cast<std::size_t>(object)].rigid);
  }
  /// Number of an object's body; -1 if it has none or it is not made yet.
  int number(std::int32_t object) const { return exists(object) ? at_[index(object)] : -1; }
  const SelfOcclusion& body(int number) const { return *bodies_[static_cast<std::size_t>(number)].samples; }

  void make(std::int32_t object, Occluders& occluders);
  /// Casts the rays of what is missing (ascending, unique). Fails with "stopped".
  Expected<void> fill(std::span<const MissingSample> missing, const AoKernels& kernels,
                      const AoProgress& progress, const StopFlag* stop);
  std::uint64_t filled() const;  ///< samples, of all bodies

private:
  struct Body {
    int shape = -1;
    std::unique_ptr<SelfOcclusion> samples;
  };
  std::size_t index(std::int32_t object) const {
    return object == TriangleOwner::standing ? objects_->objects.size() : static_cast<std::size_t>(object);
  }

  const SceneObjects* objects_ = nullptr;
  double reach_ = 0;
  std::vector<Body> bodies_;
  std::vector<int> at_;  ///< one per object, the last of what stands; -1 until made
};

}  // namespace tenebra::ao
