// The means of pixels over their samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/pattern.h"
#include "render/antialias/sample_picture.h"
#include "render/lit_samples.h"
#include "render/renderer.h"
#include "shade/display.h"
#include "shade/shading.h"

namespace tenebra::render {

/// A pixel's colour is the mean of what its samples show (each clamped by itself, so that the edge of a
/// bright thing is smooth), before the transfer curve; its masks are means of visible fractions. Samples are
/// added in the order of the pattern: the bits depend on nothing else.
class SampleMeans {
public:
  /// Works on `result`, which has what the pixels' centres show and the lights' masks.
  SampleMeans(const SamplePattern& pattern, const shade::Display& display, bool sample_masks,
              FrameResult& result);

  /// Starts with the centres. `colors`: theirs, linear.
  void begin(std::span<const std::uint32_t> chosen, std::span<const glm::vec3> colors);
  /// Samples of chosen pixels `first` ..., of the pattern's places `place` ...
  void add(std::size_t first, std::size_t place, const SamplePicture& samples,
           std::span<const shade::ShadedSample> shaded, const LitSamples& lit);
  /// Writes the means.
  void finish();

private:
  void add_masks(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit,
                 std::size_t light);

  const SamplePattern& pattern_;
  shade::Display display_;
  bool sample_masks_;
  FrameResult& result_;
  std::vector<std::uint32_t> chosen_;
  std::vector<glm::vec3> colors_;            // sums, by chosen pixel
  std::vector<std::vector<float>> visible_;  // sums, by light and chosen pixel
};

}  // namespace tenebra::render
