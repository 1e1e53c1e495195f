// Colours by the processor's cores.
#pragma once

#include <optional>
#include <vector>

#include "render/frame_shading.h"

namespace tenebra::render {

/// A pixel with several samples is the mean of what they show (each clamped by itself, so that the edge of a
/// bright thing is smooth), before the transfer curve; its linear mean is that of their linear colours. All
/// is added in one order, so the bits do not depend on the number of threads. Never fails.
class CpuShading : public FrameShading {
public:
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

private:
  void add_linear(const SampleShares& shares, std::span<const shade::ShadedSample> colors);

  std::optional<ShadingTask> frame_;
  std::vector<glm::vec3> centres_;           // linear; empty if nothing needs them
  std::vector<shade::ShadedSample> shaded_;  // of add_samples
  MeansTask means_;
  std::vector<glm::vec3> sums_, linear_sums_;  // of what is shown, and linear if wanted; by pixel of means_
};

}  // namespace tenebra::render
