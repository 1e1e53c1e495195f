// Which samples take the hard shadows of pixels' centres nearby.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "render/antialias/sample_picture.h"
#include "render/antialias/surface_match.h"

namespace tenebra::render {

/// What the pixels' centres see, and their masks of the lights without an area.
struct CentreMasks {
  int width = 0;
  int height = 0;
  std::span<const std::uint32_t> ids;
  std::vector<std::span<const std::uint8_t>> masks;
  std::vector<std::uint8_t>
      glass;  ///< 1: something see-through is before it, or colours a light; empty: none

  bool has_glass(std::size_t pixel) const { return !glass.empty() && glass[pixel] != 0; }
};

/// As with whole pixels, a surface within a pixel needs no further sample where no shadow's edge is near: the
/// samples of a surface have the masks of the centres of their own and the eight pixels around that see the
/// same surface, if these are two or more, have the same masks, and no glass changes what they show.
class MaskAgreement {
public:
  static constexpr std::uint32_t none = 0xffffffffu, unlit = 0xfffffffeu;

  MaskAgreement(const CentreMasks& centres, SurfaceMatch& match) : centres_(centres), match_(match) {}

  /// A pixel whose masks those samples of `pixel` have that see triangle `id`, as one at `place` does; none:
  /// they need their own; unlit: no triangle.
  std::uint32_t find(std::uint32_t id, std::uint32_t pixel, glm::vec2 place);
  bool same_masks(std::uint32_t a, std::uint32_t b) const;

private:
  const CentreMasks& centres_;
  SurfaceMatch& match_;
};

struct MaskSharing {
  std::vector<std::uint32_t> from;  ///< by slot: as MaskAgreement::find

  // Samples with masks of their own, as compute_sample_points takes them.
  std::vector<std::uint32_t> own_slots;
  std::vector<std::uint32_t> own_ids;  ///< by pixel of SampleGrid(own_slots.size())
  std::vector<glm::vec2> own_places;   ///< likewise
};

void share_masks(const CentreMasks& centres, const SamplePicture& samples, const SurfaceMatch& match,
                 MaskSharing& out);

}  // namespace tenebra::render
