#include "soft/sample/light_means.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "points/sample_sides.h"

namespace tenebra::soft {

namespace {

float share(float part, float all, float otherwise) {
  return all > 0 ? std::clamp(part / all, 0.0f, 1.0f) : otherwise;
}

void find_own(const SampledBlocks& blocks, const LightTally& tally, std::vector<OwnAnswer>& out) {
  out.resize(blocks.pixels.size());
  parallel::parallel_ranges(out.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    for (std::size_t slot = first; slot < last; ++slot) {
      const auto &a = tally.half[0], &b = tally.half[1];
      OwnAnswer& own = out[slot];
      own.fraction = share(a.seen[slot] + b.seen[slot], a.places[slot] + b.places[slot], 0);
      own.irradiance[0] = share(a.weight_seen[slot], a.weight[slot], own.fraction);
      own.irradiance[1] = share(b.weight_seen[slot], b.weight[slot], own.fraction);
    }
  });
}

/// Whether two points that are `d` apart may lie on one smooth surface: normals within 18 degrees, and each
/// point off the other's plane by at most a tenth of the distance between them.
bool alike(const SampledSurface& a, const SampledSurface& b, const glm::dvec3& d) {
  const double most = 0.1 * glm::length(d);
  return glm::dot(a.normal, b.normal) > 0.95f && std::abs(glm::dot(d, glm::dvec3(a.face))) <= most &&
         std::abs(glm::dot(d, glm::dvec3(b.face))) <= most;
}

/// Weights of 3x3: all four phases have a quarter.
constexpr float weights[3] = {0.25f, 0.5f, 0.25f};

/// Slots on one surface with the slot in the middle, which is one of them. Weights are multiples of 1/16, so
/// that the mean of equal values is that value.
struct Around {
  std::uint32_t slots[9];
  float weight[9];
  float sum = 0;
  int count = 0;
  float of_phase[phases] = {};  ///< weight
  /// Sum of the squares of the phases' shares: from a quarter, if all four have as much, to 1.
  float of_few_phases() const {
    float squares = 0;
    for (const float weight_of_one : of_phase) squares += weight_of_one * weight_of_one;
    return squares / (sum * sum);
  }
};

Around around(const SoftFrame& frame, const points::SeenTogether& near, const SampledBlocks& blocks,
              std::uint32_t slot) {
  Around out;
  const std::uint32_t pixel = blocks.pixels[slot], width = static_cast<std::uint32_t>(blocks.width);
  const int x = static_cast<int>(pixel % width), y = static_cast<int>(pixel / width);
  const glm::dvec3 at = frame.points.positions[pixel];
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint32_t other = blocks.slot(x + dx, y + dy);
      if (other == no_slot) continue;
      const glm::dvec3 there = frame.points.positions[blocks.pixels[other]];
      if (other != slot &&
          !(near(at, there) && alike(blocks.surfaces[slot], blocks.surfaces[other], there - at)))
        continue;
      const float weight = weights[dx + 1] * weights[dy + 1];
      out.slots[out.count] = other, out.weight[out.count++] = weight;
      out.sum += weight;
      out.of_phase[other % block_slots / phase_slots] += weight;
    }
  }
  return out;
}

/// The variance of a slot's weighted mean over its number of places, if each is seen with the probability
/// `share`, independently of the others.
float spread_of(const LightTally& tally, std::size_t slot, float share) {
  return share * (1 - share) * tally.unevenness(slot);
}

/// What the halves tell, by the logarithm of the number of places: over all slots that have looked at about
/// as many. The halves of a few pixels may agree by chance, and all pixels of a block see the same places;
/// all slots together tell.
///
/// The mean over 3x3 pixels has four times as many places as a pixel, so its halves tell how the error falls
/// with their number n. If its square falls as n^-p, the squared difference of the halves falls so too, from
/// n to 4 n by 4^-p; and the mean at n is off by the sum of the steps to all of 2 n, 4 n, ..., of which each
/// is half of the difference of the halves there: by a quarter of the squared difference at n times
/// 2^-p + 4^-p + ... (p = 1 if places are independent, more where they complete each other).
class UsualNoise {
public:
  UsualNoise(const SampledBlocks& blocks, const LightTally& tally, const LightMeans& means) : tally_(tally) {
    std::array<Sum, levels> sums{};
    for (std::size_t slot = 0; slot < means.own.size(); ++slot) {
      if (blocks.pixels[slot] == no_pixel) continue;
      Sum& sum = sums[level(slot)];
      const double apart = square(means.own[slot].apart());
      sum.apart += apart;
      sum.spread += static_cast<double>(spread_of(tally, slot, means.smooth[slot]));
      if (means.smooth_apart[slot] < 0) continue;
      sum.apart_inside += apart;
      sum.smooth_apart += square(means.smooth_apart[slot]);
    }
    for (std::size_t i = 0; i < levels; ++i) levels_[i] = told_by(sums[i]);
  }

  /// The mean square of the error of a slot's own mean is this times the squared difference of its halves.
  float of_halves(std::size_t slot) const { return levels_[level(slot)].of_halves; }
  /// What is left of it in the mean with the neighbours; between what is left by all phases and by one, which
  /// is all of it, as if the phases were independent.
  float left(std::size_t slot, const Around& near) const {
    const float of_four = levels_[level(slot)].left;
    return of_four + (1 - of_four) * (near.of_few_phases() - 0.25f) / 0.75f;
  }
  /// The usual one of a slot that sees this share of the light.
  float at(std::size_t slot, float share) const {
    return levels_[level(slot)].of_spread * spread_of(tally_, slot, share);
  }

private:
  static constexpr std::size_t levels = 33;
  static constexpr double least_left = 1.0 / 64, most_left = 0.5;  ///< p = 3; phases that see much the same
  struct Sum {
    double apart = 0, spread = 0;
    double apart_inside = 0, smooth_apart = 0;  ///< of slots with all their neighbours
  };
  struct Level {
    float of_halves = 0.25f, left = 0.25f, of_spread = 0;
  };
  static double square(float x) { return static_cast<double>(x) * static_cast<double>(x); }
  static Level told_by(const Sum& sum) {
    const double left =
        sum.apart_inside > 0 ? std::max(sum.smooth_apart / sum.apart_inside, least_left) : 0.25;
    const double halving = std::sqrt(std::min(left, 0.25));  // 2^-p
    const double of_halves = 0.25 * halving / (1 - halving);
    return {static_cast<float>(of_halves), static_cast<float>(std::min(left, most_left)),
            static_cast<float>(sum.spread > 0 ? of_halves * sum.apart / sum.spread : 0.0)};
  }
  std::size_t level(std::size_t slot) const {
    return static_cast<std::size_t>(std::bit_width(tally_.rays[slot / block_slots]));
  }
  const LightTally& tally_;
  std::array<Level, levels> levels_;
};
constexpr float trust = 0.25f;  ///< in the halves of nine pixels; the rest is in the usual noise

}  // namespace

void find_means(const SoftFrame& frame, const SampledBlocks& blocks, const LightTally& tally,
                LightMeans& out) {
  const points::SeenTogether near_in_view(frame.points.seen_from);
  find_own(blocks, tally, out.own);
  const std::vector<OwnAnswer>& own = out.own;
  std::vector<float>& smooth = out.smooth;
  smooth.assign(own.size(), 0.0f);
  for (auto* values : {&out.irradiance, &out.fraction, &out.square}) values->assign(own.size(), 0.0f);
  out.smooth_apart.assign(own.size(), -1.0f);
  const auto each = [&](const auto& body) {
    parallel::parallel_ranges(own.size(), 1 << 10, [&](std::size_t first, std::size_t last) {
      for (std::size_t slot = first; slot < last; ++slot)
        if (blocks.pixels[slot] != no_pixel) body(static_cast<std::uint32_t>(slot));
    });
  };
  each([&](std::uint32_t slot) {
    const Around near = around(frame, near_in_view, blocks, slot);
    float apart = 0;
    for (int k = 0; k < near.count; ++k) {
      apart += near.weight[k] * own[near.slots[k]].apart();
      smooth[slot] += near.weight[k] * own[near.slots[k]].mean();
      out.fraction[slot] += near.weight[k] * own[near.slots[k]].fraction;
    }
    smooth[slot] = std::min(smooth[slot] / near.sum, 1.0f);
    out.fraction[slot] = std::min(out.fraction[slot] / near.sum, 1.0f);
    if (near.count == 9) out.smooth_apart[slot] = std::abs(apart);
  });
  const UsualNoise usual(blocks, tally, out);
  each([&](std::uint32_t slot) {
    const Around near = around(frame, near_in_view, blocks, slot);
    float apart = 0, moved = 0;  // mean squares
    for (int k = 0; k < near.count; ++k) {
      const OwnAnswer& other = own[near.slots[k]];
      const float by = other.mean() - smooth[near.slots[k]];
      apart += other.apart() * other.apart() / static_cast<float>(near.count);
      moved += by * by / static_cast<float>(near.count);
    }
    const float left = usual.left(slot, near);
    const float noise = trust * usual.of_halves(slot) * apart + (1 - trust) * usual.at(slot, smooth[slot]);
    // The smooth value differs by noise alone, or by more, which is blur. Both values are blended for the
    // least error. Over the phases, a slot's own error times that of the mean of them is, in the mean, the
    // square of the latter: the part `left` of the noise.
    const float noise_moves = noise * (1 - left);
    const float smeared = std::max(0.0f, moved - noise_moves);
    const float keep = moved > 0 ? smeared / (smeared + noise_moves) : 0.0f, give = 1 - keep;
    out.irradiance[slot] = keep * own[slot].mean() + give * smooth[slot];
    out.fraction[slot] = keep * own[slot].fraction + give * out.fraction[slot];
    out.square[slot] =
        keep * keep * noise + give * give * (smeared + left * noise) + 2 * keep * give * left * noise;
  });
}

}  // namespace tenebra::soft
