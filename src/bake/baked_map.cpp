#include "bake/baked_map.h"

#include <algorithm>

namespace tenebra::bake {
namespace {

/// Calls use(index) for the neighbours of texel `i`, eight or fewer.
template <class Use>
void each_neighbour(const BakedMap& map, std::size_t i, const Use& use) {
  const auto size = static_cast<std::size_t>(map.size);
  const std::size_t x = i % size, y = i / size;
  for (std::size_t row = y - (y > 0); row <= std::min(y + 1, size - 1); ++row)
    for (std::size_t column = x - (x > 0); column <= std::min(x + 1, size - 1); ++column)
      if (row != y || column != x) use(row * size + column);
}

}  // namespace

std::size_t BakedMap::lit_texels() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < texels.size(); ++i)
    count += filled[i] != 0 && std::max({texels[i].r, texels[i].g, texels[i].b}) > 0;
  return count;
}

std::size_t BakedMap::filled_texels() const {
  return static_cast<std::size_t>(std::count(filled.begin(), filled.end(), std::uint8_t{1}));
}

void add_means(std::span<const Sample> samples, std::span<const Light> light, BakedMap& map) {
  for (std::size_t i = 0; i < samples.size();) {
    const std::uint32_t texel = samples[i].target;
    glm::dvec4 sum(0.0);
    double shares = 0;
    for (; i < samples.size() && samples[i].target == texel; ++i) {
      const double share = samples[i].share;
      sum += share * glm::dvec4(light[i]);
      shares += share;
    }
    map.texels[texel] = Light(sum / shares);
    map.filled[texel] = 1;
  }
}

void dilate(BakedMap& map, int rings) {
  std::vector<std::size_t> ring, next;
  std::vector<std::uint8_t> waiting(map.filled);  // 1: has a value or is in the ring at hand
  const auto gather = [&](std::size_t i) {
    each_neighbour(map, i, [&](std::size_t n) {
      if (waiting[n] == 0) waiting[n] = 1, next.push_back(n);
    });
  };
  for (std::size_t i = 0; i < map.filled.size(); ++i)
    if (map.filled[i] != 0) gather(i);
  for (; rings > 0 && !next.empty(); --rings) {
    ring.swap(next), next.clear();
    for (const std::size_t i : ring) {
      glm::dvec4 sum(0.0);
      int count = 0;
      each_neighbour(map, i, [&](std::size_t n) {
        if (map.filled[n] != 0) sum += glm::dvec4(map.texels[n]), ++count;
      });
      map.texels[i] = Light(sum / static_cast<double>(count));
    }
    for (const std::size_t i : ring) map.filled[i] = 1;
    for (const std::size_t i : ring) gather(i);
  }
}

}  // namespace tenebra::bake
