// The means of pixels over their samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/pattern.h"
#include "render/antialias/pixel_choice.h"
#include "render/antialias/sample_picture.h"
#include "render/antialias/shading_list.h"
#include "render/lit_samples.h"
#include "render/renderer.h"
#include "shade/display.h"
#include "shade/shading.h"

namespace tenebra::render {

/// A pixel's colour is the mean of what its samples show (each clamped by itself, so that the edge of a
/// bright thing is smooth), before the transfer curve; its linear colour, if wanted, is the mean of theirs;
/// its masks are means of visible fractions. All is added in one order, so the bits do not depend on the
/// number of threads.
class SampleMeans {
public:
  /// Works on `result`, which has what the pixels' centres show, linear in `colors`, and the lights' masks;
  /// which of their means it gets is in `settings`.
  SampleMeans(const RenderSettings& settings, const SamplePattern& pattern, const shade::Display& display,
              std::span<const glm::vec3> colors, FrameResult& result);

  /// Starts with the centres, if they count; edges get masks of their own.
  void begin(const ChosenPixels& chosen);
  /// Colours of chosen pixels `first` ...
  void add_colors(std::size_t first, const ShadingList& list, std::span<const shade::ShadedSample> shaded);
  /// Masks of chosen pixels `first` ..., at the pattern's places `place` ...: if their means are wanted.
  void add_masks(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit);
  /// Writes the means.
  void finish();

private:
  void add_linear(std::size_t first, const ShadingList& list, std::span<const shade::ShadedSample> shaded);
  void add_masks(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit,
                 std::size_t light);

  const SamplePattern& pattern_;
  shade::Display display_;
  bool mask_means_, sample_masks_, linear_mean_;
  std::span<const glm::vec3> centre_colors_;
  FrameResult& result_;
  std::vector<std::uint32_t> chosen_;
  std::size_t edges_ = 0;
  std::vector<glm::vec3> colors_;            // sums, by chosen pixel
  std::vector<glm::vec3> linear_;            // the same before they are shown; or empty
  std::vector<std::vector<float>> visible_;  // sums, by light and chosen pixel with an edge; or empty
};

}  // namespace tenebra::render
