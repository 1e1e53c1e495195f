// The masks of pixels with several samples: their means, and each sample's own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "render/antialias/pattern.h"
#include "render/antialias/sample_picture.h"
#include "render/lit_samples.h"
#include "render/renderer.h"

namespace tenebra::render {

/// Means of visible fractions over the samples of pixels with an edge: LightMask::mean, and
/// LightMask::samples, as far as the settings want them. All is added in one order, so the bits do not depend
/// on the number of threads.
class MaskMeans {
public:
  /// Works on `result`, which has the masks of the pixels' centres.
  MaskMeans(const RenderSettings& settings, const SamplePattern& pattern, FrameResult& result);

  /// Starts with the centres, if they count.
  void begin(std::span<const std::uint32_t> edges);
  /// The masks of edges `first` ..., at the pattern's places `place` ...
  void add(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit);
  /// Writes the means.
  void finish();

private:
  void add(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit,
           std::size_t light);

  const SamplePattern& pattern_;
  bool means_, samples_;
  FrameResult& result_;
  std::span<const std::uint32_t> edges_;
  std::vector<std::vector<float>> visible_;  // sums, by light and edge; or empty
};

}  // namespace tenebra::render
