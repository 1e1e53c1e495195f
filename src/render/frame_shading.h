// From samples and their light to colours, and from colours to the picture: lists of samples in, colours out.
// All colours of a frame's picture are made here, so a second way to make them replaces this alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "io/image.h"
#include "shade/display.h"
#include "shade/shading.h"

namespace tenebra::render {

/// What all colours of a frame have in common. Refers to data that lives until the frame ends.
struct ShadingTask {
  shade::Subject subject;
  shade::Lighting lighting;
  shade::Display display;
  int width = 0, height = 0;           ///< of the picture, pixels
  std::span<const std::uint32_t> ids;  ///< of the picture's pixels
  /// Whether the colours of the pixels' centres are needed once more, linear: by the means, or copy_linear.
  bool keeps_linear = false;
  bool linear_means = false;  ///< MeansTask::linear will be set
};

/// Pixels whose colour is the mean over several samples.
struct MeansTask {
  std::span<const std::uint32_t> pixels;  ///< of the picture, each once
  std::size_t samples = 1;                ///< of each of them
  bool centre_counts = true;              ///< the pixel's centre is one of them
  bool linear = false;                    ///< linear means are wanted too
};

/// What samples have a share in: some of MeansTask::pixels that follow each other.
struct SampleShares {
  std::size_t first = 0;                  ///< the first of them; the numbers below count from it
  std::span<const std::uint32_t> pixels;  ///< of each sample: which of them it belongs to; those of a pixel
                                          ///< follow each other
  std::span<const float> shares;          ///< of each sample: for how many samples of its pixel it stands
  std::span<const float> centres;         ///< of each pixel: for how many more samples its centre stands
};

/// Makes the colours of one frame after another. In a frame the calls come in this order: begin,
/// shade_centres, replace_centres, copy_linear, begin_means, add_samples or shade_samples and add_colors,
/// finish_means; shade_samples may come at any time after begin, and what a frame does not need is left out.
/// Each fails with a sentence.
class FrameShading {
public:
  virtual ~FrameShading() = default;

  /// What pixels see is known now, and what lights there are, but not yet what reaches the pixels.
  virtual Expected<void> begin(const ShadingTask& task) = 0;
  /// The picture of the pixels' centres.
  virtual Expected<void> shade_centres(const shade::PixelSamples& centres, io::Image8& picture) = 0;
  /// Gives other linear colours to some pixels of it.
  virtual Expected<void> replace_centres(std::span<const std::uint32_t> pixels,
                                         std::span<const glm::vec3> colors, io::Image8& picture) = 0;
  /// The linear colours of the centres, three channels.
  virtual Expected<void> copy_linear(io::ImageF& out) = 0;
  /// The linear colours of a list of samples.
  virtual Expected<void> shade_samples(const shade::Samples& samples,
                                       std::vector<shade::ShadedSample>& out) = 0;

  /// Starts the means, with the centres where these count.
  virtual Expected<void> begin_means(const MeansTask& task) = 0;
  /// Adds samples by their colours.
  virtual Expected<void> add_colors(const SampleShares& shares,
                                    std::span<const shade::ShadedSample> colors) = 0;
  /// Shades samples and adds them.
  virtual Expected<void> add_samples(const shade::Samples& samples, const SampleShares& shares) = 0;
  /// Writes the means over the picture and, where wanted, over the linear colours of the centres.
  virtual Expected<void> finish_means(io::Image8& picture, io::ImageF& linear) = 0;

  /// What the user should know of the last frame, one sentence each.
  virtual std::vector<std::string> take_notes() { return {}; }
};

}  // namespace tenebra::render
