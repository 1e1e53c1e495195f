// Hard shadows of the samples of pixels with an edge: those of pixels' centres nearby, or their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/antialias/edge_samples.h"
#include "render/antialias/sample_stages.h"

namespace tenebra::render {

/// Whether hard shadows of pixels' centres may stand for those of samples: not with more than four samples,
/// where the shadows that this misses would weigh more than what is left at edges, nor where masks of samples
/// are asked for.
bool shares_masks(const Frame& frame);

class EdgeShadows {
public:
  /// Finds the hard shadows of all samples of a task.
  Expected<void> find(const SampleStages& stages, const EdgeTask& task);
  /// Of the last task.
  const EdgeSamples& samples() const { return edges_; }

private:
  Expected<void> trace_own(const SampleStages& stages);

  EdgeSamples edges_;
  std::vector<std::uint32_t> own_ids_;  // of edges_.own
  std::vector<glm::vec2> own_places_;
  LitSamples own_;
};

}  // namespace tenebra::render
