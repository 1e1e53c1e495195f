// Colours by OpenGL, where it can make all that a frame asks for; by the CPU's way elsewhere.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/cpu_shading.h"
#include "shade_gl/colour_passes.h"

namespace tenebra::render {

/// A frame is made by one way alone. Whatever OpenGL cannot do yet, or fails at before a frame's first
/// colour, is a note, and the CPU makes the frame; after a failure it makes all that follow, too.
class GlShading : public FrameShading {
public:
  /// In the context that is current, which outlives it. Fails with a sentence if a shader does not build.
  static Expected<std::unique_ptr<FrameShading>> create();

  Expected<void> begin(const ShadingTask& task) override;
  Expected<void> shade_centres(const shade::PixelSamples& centres, io::Image8& picture) override;
  Expected<void> replace_centres(std::span<const std::uint32_t> pixels, std::span<const glm::vec3> colors,
                                 io::Image8& picture) override;
  Expected<void> copy_linear(io::ImageF& out) override;
  Expected<void> shade_samples(const shade::Samples& samples, std::vector<shade::ShadedSample>& out) override;
  Expected<void> begin_means(const MeansTask& task) override;
  Expected<void> add_colors(const SampleShares& shares, std::span<const shade::ShadedSample> colors) override;
  Expected<void> add_samples(const shade::Samples& samples, const SampleShares& shares) override;
  Expected<void> finish_means(io::Image8& picture, io::ImageF& linear) override;
  std::vector<std::string> take_notes() override;

private:
  explicit GlShading(shade_gl::ColourPasses passes) : passes_(std::move(passes)) {}
  /// Leaves this frame, and those that follow, to the CPU.
  Expected<void> give_up(const Error& failure);

  shade_gl::ColourPasses passes_;
  CpuShading cpu_;
  std::optional<ShadingTask> task_;
  bool by_gl_ = false, broken_ = false;  // of the frame; of all that follow
  std::size_t samples_ = 1;              // of MeansTask
  std::vector<std::string> notes_;
};

}  // namespace tenebra::render
