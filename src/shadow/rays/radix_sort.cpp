#include <algorithm>
#include <array>
#include <utility>

#include "parallel/parallel.h"
#include "shadow/rays/shadow_rays.h"

namespace tenebra::shadow {

namespace {

constexpr int digit_bits = 11;
constexpr std::size_t buckets = std::size_t{1} << digit_bits;
constexpr std::size_t keys_a_range = 1 << 16;

std::size_t digit_of(std::uint64_t key, int shift) {
  return (key >> shift) & (buckets - 1);
}

// Turns counts[range][bucket] into the place of the first key of that range and bucket.
void prefix_sums(std::vector<std::uint32_t>& counts, std::size_t ranges) {
  std::uint32_t place = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    for (std::size_t range = 0; range < ranges; ++range) {
      place += std::exchange(counts[range * buckets + bucket], place);
    }
  }
}

}  // namespace

void radix_sort(std::vector<std::uint64_t>& keys, RayKeys& scratch) {
  const std::size_t ranges = (keys.size() + keys_a_range - 1) / keys_a_range;
  scratch.other.resize(keys.size());
  for (int shift = 32; shift < 32 + 3 * digit_bits; shift += digit_bits) {
    scratch.counts.assign(ranges * buckets, 0);
    parallel::parallel_ranges(keys.size(), keys_a_range, [&](std::size_t first, std::size_t last) {
      std::uint32_t* counts = &scratch.counts[first / keys_a_range * buckets];
      for (std::size_t i = first; i < last; ++i) ++counts[digit_of(keys[i], shift)];
    });
    prefix_sums(scratch.counts, ranges);
    parallel::parallel_ranges(keys.size(), keys_a_range, [&](std::size_t first, std::size_t last) {
      std::uint32_t* places = &scratch.counts[first / keys_a_range * buckets];
      for (std::size_t i = first; i < last; ++i) scratch.other[places[digit_of(keys[i], shift)]++] = keys[i];
    });
    keys.swap(scratch.other);
  }
}

}  // namespace tenebra::shadow
