#include "render/antialias/mask_sharing.h"

#include <algorithm>

#include "parallel/parallel.h"

namespace tenebra::render {
namespace {

constexpr std::size_t pixels_at_once = 512, most_ids = 16;

/// Sets `from` at the samples of chosen pixel `i`; returns how many need their own.
std::size_t share(MaskAgreement& agreement, const SamplePicture& samples, std::size_t i,
                  std::vector<std::uint32_t>& from) {
  std::uint32_t ids[most_ids], pixels[most_ids];
  std::size_t known = 0, own = 0;
  for (std::size_t k = 0; k < samples.per_pixel; ++k) {
    const std::uint32_t slot = samples.slots[i * samples.per_pixel + k], id = samples.ids[slot];
    const auto found = static_cast<std::size_t>(std::find(ids, ids + known, id) - ids);
    if (found == known) {
      ids[known] = id;
      pixels[known++] = agreement.find(id, samples.pixels[slot], samples.places[slot]);
    }
    from[slot] = pixels[found];
    own += pixels[found] == MaskAgreement::none ? 1 : 0;
  }
  return own;
}

}  // namespace

std::uint32_t MaskAgreement::find(std::uint32_t id, std::uint32_t pixel, glm::vec2 place) {
  if (id == no_triangle) return unlit;
  const int x = static_cast<int>(pixel) % centres_.width, y = static_cast<int>(pixel) / centres_.width;
  std::uint32_t ids[9], first = none;
  bool same[9];
  std::size_t known = 0;
  int seeing = 0;
  for (int to_y = std::max(y - 1, 0); to_y <= std::min(y + 1, centres_.height - 1); ++to_y) {
    for (int to_x = std::max(x - 1, 0); to_x <= std::min(x + 1, centres_.width - 1); ++to_x) {
      const auto next = static_cast<std::uint32_t>(to_y * centres_.width + to_x);
      const std::uint32_t other = centres_.ids[next];
      const auto i = static_cast<std::size_t>(std::find(ids, ids + known, other) - ids);
      if (i == known) {
        ids[known] = other;
        same[known++] = match_.same(id, other, place);
      }
      if (!same[i]) continue;
      if (centres_.has_glass(next)) return none;
      ++seeing;
      if (first == none) {
        first = next;
      } else if (!same_masks(first, next)) {
        return none;
      }
    }
  }
  return seeing >= 2 ? first : none;
}

bool MaskAgreement::same_masks(std::uint32_t a, std::uint32_t b) const {
  return std::all_of(centres_.masks.begin(), centres_.masks.end(),
                     [&](std::span<const std::uint8_t> mask) { return mask[a] == mask[b]; });
}

void share_masks(const CentreMasks& centres, const SamplePicture& samples, const SurfaceMatch& match,
                 MaskSharing& out) {
  const std::size_t pixels = samples.per_pixel == 0 ? 0 : samples.count / samples.per_pixel;
  std::vector<std::size_t> starts((pixels + pixels_at_once - 1) / pixels_at_once + 1, 0);
  out.from.resize(samples.grid.pixels());
  parallel::parallel_ranges(pixels, pixels_at_once, [&](std::size_t first, std::size_t last) {
    SurfaceMatch own_match(match);
    MaskAgreement agreement(centres, own_match);
    for (std::size_t i = first; i < last; ++i)
      starts[first / pixels_at_once + 1] += share(agreement, samples, i, out.from);
  });
  for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
  const std::size_t count = starts.back();
  const points::SampleGrid grid(count);
  out.own_slots.resize(count);
  out.own_ids.assign(grid.pixels(), no_triangle);
  out.own_places.resize(grid.pixels());
  parallel::parallel_ranges(pixels, pixels_at_once, [&](std::size_t first, std::size_t last) {
    std::size_t next = starts[first / pixels_at_once];
    for (std::size_t i = first * samples.per_pixel; i < last * samples.per_pixel; ++i) {
      const std::uint32_t slot = samples.slots[i];
      if (out.from[slot] != MaskAgreement::none) continue;
      out.own_slots[next] = slot;
      out.own_ids[grid.pixel(next)] = samples.ids[slot];
      out.own_places[grid.pixel(next)] = samples.places[slot];
      ++next;
    }
  });
}

}  // namespace tenebra::render
