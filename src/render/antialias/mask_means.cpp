#include "render/antialias/mask_means.h"

#include "parallel/parallel.h"
#include "render/mask_colour.h"

namespace tenebra::render {
namespace {

constexpr std::size_t at_once = 4096;

/// The visible part of a light at a sample.
float visible_at(const LitSamples& lit, std::size_t light, std::size_t slot) {
  const auto& fraction = lit.visible_fraction[light];
  return fraction.empty() ? (lit.masks[light][slot] != 0 ? 1.0f : 0.0f) : fraction[slot];
}

/// The visible part of a light at every pixel's centre.
io::ImageF visible_fractions(const LightMask& mask) {
  io::ImageF out{mask.mask.width, mask.mask.height, 1, mask.visible_fraction.pixels};
  if (!out.pixels.empty()) return out;
  out.pixels.resize(mask.mask.pixels.size());
  parallel::parallel_ranges(out.pixels.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out.pixels[i] = visible_fraction(mask, i);
  });
  return out;
}

}  // namespace

MaskMeans::MaskMeans(const RenderSettings& settings, const SamplePattern& pattern, FrameResult& result)
    : pattern_(pattern), means_(settings.mask_means), samples_(settings.sample_masks), result_(result) {}

void MaskMeans::begin(std::span<const std::uint32_t> edges) {
  edges_ = edges;
  visible_.assign(means_ ? result_.masks.size() : 0, std::vector<float>(edges_.size(), 0.0f));
  for (LightMask& mask : result_.masks) {
    if (means_) mask.mean = visible_fractions(mask);
    if (samples_) mask.samples.assign(pattern_.count(), mask.mask);
  }
  if (!pattern_.centre_counts) return;
  for (std::size_t light = 0; light < visible_.size(); ++light)
    for (std::size_t i = 0; i < edges_.size(); ++i)
      visible_[light][i] = visible_fraction(result_.masks[light], edges_[i]);
}

void MaskMeans::add(std::size_t first, std::size_t place, const SamplePicture& samples,
                    const LitSamples& lit) {
  if (!means_ && !samples_) return;
  for (std::size_t light = 0; light < result_.masks.size(); ++light) add(first, place, samples, lit, light);
}

void MaskMeans::add(std::size_t first, std::size_t place, const SamplePicture& samples, const LitSamples& lit,
                    std::size_t light) {
  const std::size_t before = place + (pattern_.centre_counts ? 1 : 0);
  const std::size_t count = samples.count / samples.per_pixel;
  parallel::parallel_ranges(count, at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < samples.per_pixel; ++k) {
        const float visible = visible_at(lit, light, samples.slots[i * samples.per_pixel + k]);
        if (means_) visible_[light][first + i] += visible;
        if (samples_) result_.masks[light].samples[before + k].pixels[edges_[first + i]] = in_levels(visible);
      }
    }
  });
}

void MaskMeans::finish() {
  const float share = 1.0f / static_cast<float>(pattern_.count());
  for (std::size_t light = 0; light < visible_.size(); ++light)
    for (std::size_t i = 0; i < edges_.size(); ++i)
      result_.masks[light].mean.pixels[edges_[i]] = share * visible_[light][i];
}

}  // namespace tenebra::render
