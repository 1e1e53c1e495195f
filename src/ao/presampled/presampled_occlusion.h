// The paper's method: Gaitatzes, Chrysanthou and Papaioannou 2010, "Presampled Visibility for Ambient
// Occlusion". Displacement fields of bodies that move, and samples of how each body hides itself, are made
// once and kept as long as there is room.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "ao/presampled/field_pass.h"

namespace tenebra::ao {

class PresampledOcclusion {
public:
  /// Keeps a reference to `casters`.
  explicit PresampledOcclusion(Casters& casters) : casters_(casters) {
    budget_.set_drop([this] { return drop_oldest(); });
  }
  PresampledOcclusion(const PresampledOcclusion&) = delete;
  PresampledOcclusion& operator=(const PresampledOcclusion&) = delete;

  /// Objects found anew: what is known of shapes that are still there stays.
  void reset(const SceneObjects& objects);
  /// The instant of the casters, after their begin_frame(). Keeps a reference to `stop` until the next call.
  void begin_frame(const AoConfig& config, double reach, const RayKernels& kernels, const StopFlag* stop);

  /// As FieldPass::run.
  Expected<void> compute(const ReceiverSet& set, AoPart part, const PointRays& rays,
                         std::vector<float>& values, AoStats& stats, FrameTimings& timings,
                         const AoProgress& progress);
  /// Writes what is new to disk, counts what is kept, and adds notes.
  void end_frame(AoStats& stats, std::vector<std::string>& notes);

private:
  bool drop_oldest();

  Casters& casters_;
  MemoryBudget budget_;
  FieldOccluders occluders_{casters_, budget_};
  Bodies bodies_{budget_};
  RayKernels kernels_;
  const StopFlag* stop_ = nullptr;
  double reach_ = 0;
  bool fresh_ = false;       ///< the objects were found anew
  std::uint64_t frame_ = 0;  ///< counts begin_frame()
  int memory_mb_ = 0;
  bool noted_memory_ = false;
  FieldRoom room_;
};

}  // namespace tenebra::ao
