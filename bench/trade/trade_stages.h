// Parts of the part `stages` of `tenebra-bench trade`.
#pragma once

#include "bench/hard/hard_views.h"
#include "bench/trade/trade_session.h"
#include "render/renderer.h"

namespace tenebra::bench {

/// A way to draw a frame: what, how, and what the renderer has met before, which is not timed.
struct Drawing {
  const Scene* scene = nullptr;
  render::FrameInput input;
  render::RenderSettings settings;
  bool moved_before = false;  ///< it has drawn the frame with every vertex elsewhere
  bool fresh = false;         ///< it has drawn nothing
};

/// One stage on one view: the program as it is, and the same with that stage alone switched off.
struct StagePair {
  const char* stage;
  Drawing as_is, without;
  bool same_bits = true;  ///< are promised
};

/// What is there to switch off in this frame of `scene`; `others` keeps the scenes that pairs need beside it.
std::vector<StagePair> stage_pairs(const Scene& scene, int frame, PictureSize size,
                                   std::vector<Scene>& others);

/// Draws both in turns, on the threads that the caller allows.
Expected<StageRow> measure_stage(const StagePair& pair, const std::string& view, const Turns& turns);

}  // namespace tenebra::bench
