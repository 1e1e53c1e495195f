#include "oracle/mask_check.h"

#include <algorithm>

#include "parallel/parallel.h"

namespace tenebra::oracle {
namespace {

constexpr std::size_t samples_of_a_part = 256;
constexpr std::size_t samples_of_a_round =
    256 * samples_of_a_part;  // whose wrong ones are all kept meanwhile

/// Well-mixed bits of `x` (splitmix64).
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

void check_round(const ExactShadow& exact, const VisiblePoints& points, std::span<const std::uint8_t> mask,
                 std::span<const std::size_t> pixels, const StopFlag* stop, MaskCheck& all) {
  std::vector<MaskCheck> parts((pixels.size() + samples_of_a_part - 1) / samples_of_a_part);
  parallel::parallel_ranges(pixels.size(), samples_of_a_part, [&](std::size_t first, std::size_t last) {
    if (stop != nullptr && stop->requested()) return;
    MaskCheck& part = parts[first / samples_of_a_part];
    for (std::size_t i = first; i < last; ++i) {
      const std::size_t pixel = pixels[i];
      const std::uint32_t id = points.triangles[pixel];
      ExactAnswer answer;
      if (id != no_triangle) answer = exact.answer(points.positions[pixel], id, part.stats);
      if (answer.value == mask[pixel]) continue;
      ++part.wrong_count;
      part.wrong.push_back({pixel, id, mask[pixel], answer});
    }
  });
  for (const MaskCheck& part : parts) {
    all.stats += part.stats;
    all.wrong_count += part.wrong_count;
    const std::size_t room = MaskCheck::most_named - all.wrong.size();
    all.wrong.insert(all.wrong.end(), part.wrong.begin(),
                     part.wrong.begin() + static_cast<std::ptrdiff_t>(std::min(room, part.wrong.size())));
  }
}

}  // namespace

MaskCheck check_mask(const ExactShadow& exact, const VisiblePoints& points,
                     std::span<const std::uint8_t> mask, std::span<const std::size_t> pixels,
                     const StopFlag* stop) {
  MaskCheck all;
  for (std::size_t first = 0; first < pixels.size(); first += samples_of_a_round)
    check_round(exact, points, mask,
                pixels.subspan(first, std::min(samples_of_a_round, pixels.size() - first)), stop, all);
  return all;
}

std::vector<std::size_t> spread_samples(std::span<const std::uint32_t> ids, std::size_t count,
                                        std::uint64_t seed) {
  std::vector<std::size_t> visible;
  for (std::size_t i = 0; i < ids.size(); ++i)
    if (ids[i] != no_triangle) visible.push_back(i);
  if (visible.size() <= count) return visible;
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k * visible.size() / count, end = (k + 1) * visible.size() / count;
    chosen.push_back(visible[first + mixed(seed ^ mixed(k)) % (end - first)]);
  }
  return chosen;
}

}  // namespace tenebra::oracle
