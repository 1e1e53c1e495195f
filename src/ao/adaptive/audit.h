// The error of a picture, by some of its pixels that look with many rays.
#pragma once

#include <span>
#include <vector>

#include "ao/adaptive/pixel_looks.h"

namespace tenebra::ao {

/// How a pixel came by its value.
enum class Settled : std::uint8_t { none, by_neighbours, by_rays };

/// A pixel that looks with many rays.
struct Judged {
  std::uint32_t pixel;
  float open;
  double weight;  ///< the share of the picture that it stands for
};
/// Lists that are kept from frame to frame.
struct AuditRoom {
  std::vector<std::vector<Judged>> of_tile;
  std::vector<Judged> all;
};

class Audit {
public:
  /// Some 512 pixels, half of each kind where there are both, with the rays of `sets` each: eight times the
  /// usual number leaves little noise compared with the error. Keeps a reference to `room`.
  Audit(PixelLooks& looks, const PixelSurfaces& surfaces, std::span<const Settled> settled,
        const RaySets& sets, AuditRoom& room);

  /// Mean squared errors of `values`: each kind's share of the picture's.
  struct Errors {
    double by_neighbours = 0, by_rays = 0;
    double rms_255() const;
  };
  Errors errors(std::span<const float> values, std::span<const Settled> settled) const;

private:
  std::span<const Judged> judged_;
};

}  // namespace tenebra::ao
