#include "render/antialias/mask_means.h"

#include "parallel/parallel.h"
#include "render/mask_colour.h"

namespace tenebra::render {
namespace {

constexpr std::size_t means_at_once = 4096;

/// The visible part of a light at every sample.
std::vector<float> visible_fractions(const SampleLight& light) {
  if (!light.soft.visible_fraction.empty()) return light.soft.visible_fraction;
  std::vector<float> out(light.mask.size());
  parallel::parallel_ranges(out.size(), means_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out[i] = light.visible_at(i);
  });
  return out;
}

}  // namespace

void MaskMeans::begin(std::span<const std::uint32_t> edges) {
  edges_ = edges;
  visible_.assign(settings_.mask_means ? result_.masks.size() : 0, std::vector<float>(edges_.size(), 0.0f));
  const int width = settings_.width, height = settings_.height;
  for (std::size_t light = 0; light < result_.masks.size(); ++light) {
    LightMask& mask = result_.masks[light];
    const SampleLight& lit = centres_.lights[light];
    if (settings_.mask_means) mask.mean = {width, height, 1, visible_fractions(lit)};
    if (settings_.sample_masks) mask.samples.assign(pattern_.count(), {width, height, 1, lit.mask});
  }
  if (!pattern_.centre_counts) return;
  for (std::size_t light = 0; light < visible_.size(); ++light)
    for (std::size_t i = 0; i < edges_.size(); ++i)
      visible_[light][i] = centres_.lights[light].visible_at(edges_[i]);
}

void MaskMeans::add(std::size_t first, std::size_t place, const SamplePicture& samples,
                    const LitSamples& lit) {
  if (!settings_.mask_means && !settings_.sample_masks) return;
  for (std::size_t light = 0; light < result_.masks.size(); ++light)
    add(first, place, samples, lit.lights[light], light);
}

void MaskMeans::add(std::size_t first, std::size_t place, const SamplePicture& samples,
                    const SampleLight& lit, std::size_t light) {
  const std::size_t before = place + (pattern_.centre_counts ? 1 : 0);
  const std::size_t count = samples.count / samples.per_pixel;
  parallel::parallel_ranges(count, means_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < samples.per_pixel; ++k) {
        const float visible = lit.visible_at(samples.slots[i * samples.per_pixel + k]);
        if (settings_.mask_means) visible_[light][first + i] += visible;
        if (settings_.sample_masks)
          result_.masks[light].samples[before + k].pixels[edges_[first + i]] = in_levels(visible);
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
