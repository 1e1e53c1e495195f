#include "render/antialias/sample_means.h"

#include <algorithm>

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

/// Of every pixel.
base::ImageF visible_fractions(const LightMask& mask) {
  base::ImageF out{mask.mask.width, mask.mask.height, 1, mask.visible_fraction.pixels};
  if (!out.pixels.empty()) return out;
  out.pixels.resize(mask.mask.pixels.size());
  parallel::parallel_ranges(out.pixels.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) out.pixels[i] = visible_fraction(mask, i);
  });
  return out;
}

}  // namespace

SampleMeans::SampleMeans(const RenderSettings& settings, const SamplePattern& pattern,
                         const shade::Display& display, std::span<const glm::vec3> colors,
                         FrameResult& result)
    : pattern_(pattern),
      display_(display),
      mask_means_(settings.mask_means),
      sample_masks_(settings.sample_masks),
      linear_mean_(settings.linear_mean),
      centre_colors_(colors),
      result_(result) {}

void SampleMeans::begin(const ChosenPixels& chosen) {
  chosen_.clear();
  for (const auto* list : {&chosen.edges, &chosen.contrasts})
    chosen_.insert(chosen_.end(), list->begin(), list->end());
  edges_ = chosen.edges.size();
  colors_.assign(chosen_.size(), glm::vec3(0.0f));
  linear_.assign(linear_mean_ ? chosen_.size() : 0, glm::vec3(0.0f));
  visible_.assign(mask_means_ ? result_.masks.size() : 0, std::vector<float>(edges_, 0.0f));
  for (LightMask& mask : result_.masks) {
    if (mask_means_) mask.mean = visible_fractions(mask);
    if (sample_masks_) mask.samples.assign(pattern_.count(), mask.mask);
  }
  if (!pattern_.centre_counts) return;
  parallel::parallel_ranges(chosen_.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) colors_[i] = shown(display_, centre_colors_[chosen_[i]]);
    for (std::size_t i = first; linear_mean_ && i < last; ++i) linear_[i] = centre_colors_[chosen_[i]];
    for (std::size_t light = 0; light < visible_.size(); ++light)
      for (std::size_t i = first; i < std::min(last, edges_); ++i)
        visible_[light][i] = visible_fraction(result_.masks[light], chosen_[i]);
  });
}

void SampleMeans::add_colors(std::size_t first, const ShadingList& list,
                             std::span<const shade::ShadedSample> shaded) {
  parallel::parallel_ranges(list.centres.size(), at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (list.centres[i] != 0)
        colors_[first + i] += list.centres[i] * shown(display_, centre_colors_[chosen_[first + i]]);
  });
  parallel::parallel_ranges(shaded.size(), at_once, [&](std::size_t begin, std::size_t end) {
    // A pixel's samples follow each other; they all belong to the range in which they begin.
    const auto goes_on = [&](std::size_t i) { return i > 0 && list.pixels[i] == list.pixels[i - 1]; };
    std::size_t i = begin;
    while (i < end && goes_on(i)) ++i;
    if (i == end) return;
    for (; i < end || (i < shaded.size() && goes_on(i)); ++i)
      colors_[first + list.pixels[i]] += list.shares[i] * shown(display_, shaded[i].color);
  });
  if (linear_mean_) add_linear(first, list, shaded);
}

void SampleMeans::add_linear(std::size_t first, const ShadingList& list,
                             std::span<const shade::ShadedSample> shaded) {
  for (std::size_t i = 0; i < list.centres.size(); ++i)
    if (list.centres[i] != 0) linear_[first + i] += list.centres[i] * centre_colors_[chosen_[first + i]];
  for (std::size_t i = 0; i < shaded.size(); ++i)
    linear_[first + list.pixels[i]] += list.shares[i] * shaded[i].color;
}

void SampleMeans::add_masks(std::size_t first, std::size_t place, const SamplePicture& samples,
                            const LitSamples& lit) {
  if (!mask_means_ && !sample_masks_) return;
  for (std::size_t light = 0; light < result_.masks.size(); ++light)
    add_masks(first, place, samples, lit, light);
}

void SampleMeans::add_masks(std::size_t first, std::size_t place, const SamplePicture& samples,
                            const LitSamples& lit, std::size_t light) {
  const std::size_t before = place + (pattern_.centre_counts ? 1 : 0);
  const std::size_t count = samples.count / samples.per_pixel;
  parallel::parallel_ranges(count, at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < samples.per_pixel; ++k) {
        const float visible = visible_at(lit, light, samples.slots[i * samples.per_pixel + k]);
        if (mask_means_) visible_[light][first + i] += visible;
        if (sample_masks_)
          result_.masks[light].samples[before + k].pixels[chosen_[first + i]] = in_levels(visible);
      }
    }
  });
}

void SampleMeans::finish() {
  const float share = 1.0f / static_cast<float>(pattern_.count());
  parallel::parallel_ranges(chosen_.size(), at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      encode_shown(display_, share * colors_[i], &result_.image.pixels[3 * std::size_t{chosen_[i]}]);
    for (std::size_t i = first; linear_mean_ && i < last; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        result_.linear_mean.pixels[3 * std::size_t{chosen_[i]} + c] = share * linear_[i][static_cast<int>(c)];
    for (std::size_t light = 0; light < visible_.size(); ++light)
      for (std::size_t i = first; i < std::min(last, edges_); ++i)
        result_.masks[light].mean.pixels[chosen_[i]] = share * visible_[light][i];
  });
}

}  // namespace tenebra::render
