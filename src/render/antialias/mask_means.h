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

/// Means of visible fractions over the samples of pixels with an edge, LightMask::mean, and
/// LightMask::samples, as far as the settings want them. All is added in one order, so the bits do not depend
/// on the number of threads.
class MaskMeans {
public:
  /// `result` has a mask for each light that has one at the pixels' centres.
  MaskMeans(const RenderSettings& settings, const SamplePattern& pattern, const LitSamples& centres,
            FrameResult& result)
      : settings_(settings), pattern_(pattern), centres_(centres), result_(result) {}

  /// Starts with the centres, if they count.
  void begin(std::span<const std::uint32_t> edges);
  /// The masks of edges `first` ..., at the pattern's places `place` ...
  void add(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit);
  /// Writes the means.
  void finish();

private:
  void add(std::size_t first, std::size_t place, const SamplePicture& samples, const SampleLight& lit,
           std::size_t light);

  const RenderSettings& settings_;
  const SamplePattern& pattern_;
  const LitSamples& centres_;
  FrameResult& result_;
  std::span<const std::uint32_t> edges_;
  std::vector<std::vector<float>> visible_;  // sums, by light and edge; or empty
};

}  // namespace tenebra::render
