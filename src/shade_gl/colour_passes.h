// Colours of samples and pictures by OpenGL: what src/shade does on the CPU, by the passes of shaders/. Lists
// of samples in, colours out. The CPU's pictures are the measure: the formulas are the same, the roundings
// are not, so levels are at most 1 of 255 apart but for rare samples (tests/shade_gl).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/expected.h>
#include "gl/transfers.h"
#include "io/image.h"
#include "shade/shading.h"
#include "shade_gl/frame_inputs.h"
#include "shade_gl/word_lists.h"

namespace tenebra::shade_gl {

/// What crossed the bus, and how often the CPU waited for it.
struct Traffic {
  std::size_t sent_bytes = 0, read_bytes = 0;
  int passes = 0, waits = 0;
};

/// What samples have a share in: pixels from `first` on of those that begin_means was given.
struct Shares {
  std::size_t first = 0;
  std::span<const std::uint32_t> pixels;  ///< of each sample, counted from the first; runs
  std::span<const float> shares;          ///< of each sample
  std::span<const float> centres;         ///< of each pixel
};

/// Needs the gl::Context that was current at create. Keeps its buffers.
class ColourPasses {
public:
  /// Fails with a sentence if a shader does not build.
  static Expected<ColourPasses> create();

  /// Begins a frame that `lacks` nothing; what it refers to lives until its end.
  Expected<void> begin(const shade::Subject& subject, const shade::Lighting& lighting,
                       const shade::Display& display);
  /// The picture of pixels' centres, whose linear colours are kept.
  Expected<void> shade_centres(const shade::PixelSamples& centres, io::Image8& picture);
  /// Gives other colours to some of the kept ones.
  Expected<void> replace_centres(std::span<const std::uint32_t> pixels, std::span<const glm::vec3> colors);
  /// The kept colours.
  Expected<void> read_centres(io::ImageF& out);
  Expected<void> shade_samples(const shade::Samples& samples, std::vector<shade::ShadedSample>& out);

  /// Sums of what samples show, for some pixels; with the centres' if `centre_counts`.
  Expected<void> begin_means(std::span<const std::uint32_t> pixels, bool centre_counts);
  Expected<void> add_samples(const shade::Samples& samples, const Shares& shares);
  Expected<void> add_colors(std::span<const shade::ShadedSample> colors, const Shares& shares);
  /// Writes the sums, divided by `samples`, over these pixels of the picture.
  Expected<void> finish_means(std::size_t samples, io::Image8& picture);

  const Traffic& traffic() const { return traffic_; }  ///< of the frame

private:
  ColourPasses() = default;
  /// Adds a list's factors to `lists_`, and tells the pass where they are.
  void add_factors(std::span<const shade::LightFactors> factors, std::span<const float> openness);
  Expected<void> run_colours(std::size_t count, const gl::Buffer& to);
  Expected<void> add_shares(std::size_t count, const gl::Buffer& colors, const Shares& shares,
                            std::uint32_t pixels_at, std::uint32_t shares_at, std::uint32_t centres_at);
  void run(const gl::Program& program, std::size_t count);
  Expected<std::span<const std::byte>> read(const gl::Buffer& from, std::size_t bytes);

  gl::Program colours_, replaced_, picture_, centre_sums_, sample_sums_, means_;
  FrameInputs inputs_;
  WordLists lists_;
  gl::Buffer centre_colors_ = gl::Buffer::create(), sample_colors_ = gl::Buffer::create();
  gl::Buffer sums_ = gl::Buffer::create(), pixels_on_gpu_ = gl::Buffer::create(),
             bytes_ = gl::Buffer::create();
  gl::Download download_;
  std::size_t light_count_ = 0;
  int width_ = 0, height_ = 0;
  std::span<const std::uint32_t> pixels_;  // of begin_means
  Traffic traffic_;
};

}  // namespace tenebra::shade_gl
