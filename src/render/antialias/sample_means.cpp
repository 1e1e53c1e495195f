#include "render/antialias/sample_means.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

constexpr std::size_t at_once = 4096;

float fraction_of(const LightMask& mask, std::size_t pixel) {
  return mask.visible_fraction.pixels.empty() ? (mask.mask.pixels[pixel] != 0 ? 1.0f : 0.0f)
                                              : mask.visible_fraction.pixels[pixel];
}

}  // namespace

SampleMeans::SampleMeans(const SamplePattern& pattern, const shade::Display& display, bool sample_masks,
                         std::span<const glm::vec3> colors, FrameResult& result)
    : pattern_(pattern),
      display_(display),
      sample_masks_(sample_masks),
      centre_colors_(colors),
      result_(result) {}

void SampleMeans::begin(std::span<const std::uint32_t> edges, std::span<const std::uint32_t> contrasts) {
  chosen_.assign(edges.begin(), edges.end());
  chosen_.insert(chosen_.end(), contrasts.begin(), contrasts.end());
  edges_ = edges.size();
  colors_.assign(chosen_.size(), glm::vec3(0.0f));
  visible_.assign(result_.masks.size(), std::vector<float>(edges_, 0.0f));
  for (LightMask& mask : result_.masks) {
    mask.mean = {mask.mask.width, mask.mask.height, 1, mask.visible_fraction.pixels};
    if (mask.mean.pixels.empty()) {
      mask.mean.pixels.resize(mask.mask.pixels.size());
      for (std::size_t i = 0; i < mask.mean.pixels.size(); ++i) mask.mean.pixels[i] = fraction_of(mask, i);
    }
    if (sample_masks_) mask.samples.assign(pattern_.count(), mask.mask);
  }
  if (!pattern_.centre_counts) return;
  parallel::parallel_ranges(chosen_.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) colors_[i] = shown(display_, centre_colors_[chosen_[i]]);
    for (std::size_t light = 0; light < visible_.size(); ++light)
      for (std::size_t i = first; i < std::min(last, edges_); ++i)
        visible_[light][i] = fraction_of(result_.masks[light], chosen_[i]);
  });
}

void SampleMeans::add_colors(std::size_t first, const ShadingList& list,
                             std::span<const shade::ShadedSample> shaded) {
  parallel::parallel_ranges(list.centres.size(), at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (list.centres[i] > 0)
        colors_[first + i] += list.centres[i] * shown(display_, centre_colors_[chosen_[first + i]]);
  });
  shown_.resize(shaded.size());
  parallel::parallel_ranges(shaded.size(), at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) shown_[i] = list.shares[i] * shown(display_, shaded[i].color);
  });
  for (std::size_t i = 0; i < shaded.size(); ++i) colors_[first + list.pixels[i]] += shown_[i];
}

void SampleMeans::add_masks(std::size_t first, std::size_t place, const SamplePicture& samples,
                            const LitSamples& lit) {
  for (std::size_t light = 0; light < visible_.size(); ++light) add_masks(first, place, samples, lit, light);
}

void SampleMeans::add_masks(std::size_t first, std::size_t place, const SamplePicture& samples,
                            const LitSamples& lit, std::size_t light) {
  const auto& mask = lit.masks[light];
  const auto& fraction = lit.visible_fraction[light];
  const std::size_t before = place + (pattern_.centre_counts ? 1 : 0);
  const std::size_t count = samples.count / samples.per_pixel;
  parallel::parallel_ranges(count, at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < samples.per_pixel; ++k) {
        const std::size_t slot = samples.slots[i * samples.per_pixel + k];
        const float visible = fraction.empty() ? (mask[slot] != 0 ? 1.0f : 0.0f) : fraction[slot];
        visible_[light][first + i] += visible;
        if (sample_masks_)
          result_.masks[light].samples[before + k].pixels[chosen_[first + i]] =
              static_cast<std::uint8_t>(std::lround(255.0f * visible));
      }
    }
  });
}

void SampleMeans::finish() {
  const float share = 1.0f / static_cast<float>(pattern_.count());
  parallel::parallel_ranges(chosen_.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      encode_shown(display_, share * colors_[i], &result_.image.pixels[3 * std::size_t{chosen_[i]}]);
    for (std::size_t light = 0; light < visible_.size(); ++light)
      for (std::size_t i = first; i < std::min(last, edges_); ++i)
        result_.masks[light].mean.pixels[chosen_[i]] = share * visible_[light][i];
  });
}

}  // namespace tenebra::render
