#include "soft/sample/light_tally.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "points/sample_points.h"

namespace tenebra::soft {

void LightTally::start(const SampledBlocks& blocks) {
  for (Half& h : half)
    for (auto* sums : {&h.weight_seen, &h.weight, &h.weight_square, &h.seen, &h.places})
      sums->assign(blocks.pixels.size(), 0.0f);
  rays.assign(blocks.count(), 0);
}

float LightTally::unevenness(std::size_t slot) const {
  float sum = 0, square = 0, places = 0;
  for (const Half& h : half) sum += h.weight[slot], square += h.weight_square[slot], places += h.places[slot];
  return sum > 0 ? std::max(1.0f, places * (square / sum) / sum) : 1.0f;
}

void LightTally::add(const SoftFrame& frame, const SampledBlocks& blocks,
                     std::span<const std::uint32_t> chosen, std::uint32_t phase, std::size_t which,
                     const glm::vec3& place, const ShadowMask& mask) {
  const points::SampleGrid grid(chosen.size() * phase_slots);
  const glm::vec3 axis(frame.light.normal);
  Half& sums = half[which];
  parallel::parallel_ranges(chosen.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::size_t slots = chosen[k] * block_slots + phase * phase_slots;
      for (std::uint32_t i = 0; i < phase_slots; ++i) {
        if (blocks.pixels[slots + i] == no_pixel) continue;
        const SampledSurface& from = blocks.surfaces[slots + i];
        const glm::vec3 to = place - from.at;
        const float at_light = -glm::dot(axis, to), at_point = glm::dot(from.normal, to);
        const bool lit = mask[grid.pixel(k * phase_slots + i)] != 0;
        if (!(at_light > 0) || !((lit && !from.sees_half) || glm::dot(from.face, to) > 0)) continue;
        const float square = glm::dot(to, to);
        const float weight =
            std::max(at_point, 0.0f) / square * (at_light / square) * glm::dot(from.at, from.at);
        const float counts = lit ? 1.0f : 0.0f;
        sums.weight[slots + i] += weight;
        sums.weight_square[slots + i] += weight * weight;
        sums.weight_seen[slots + i] += counts * weight;
        sums.places[slots + i] += 1;
        sums.seen[slots + i] += counts;
      }
    }
  });
}

}  // namespace tenebra::soft
