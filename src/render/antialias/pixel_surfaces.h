// The surfaces that the samples of one pixel see.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "render/antialias/surface_match.h"

namespace tenebra::render {

/// Numbers them: 0 is that of the centre, then by the first sample that sees it. Triangles are matched once
/// each, where the first sample that sees them is.
class PixelSurfaces {
public:
  /// The centre's, one for each of sixteen samples, and those of the eight centres around.
  static constexpr std::size_t most = 25;

  explicit PixelSurfaces(SurfaceMatch& match) : match_(match) {}

  void begin(std::uint32_t centre_id) {
    ids_[0] = first_ids_[0] = centre_id;
    surfaces_[0] = 0;
    known_ = count_ = 1;
    last_ = 0;
  }
  std::size_t of(std::uint32_t id, glm::vec2 place) {
    if (ids_[last_] == id) return surfaces_[last_];
    const auto i = static_cast<std::size_t>(std::find(ids_, ids_ + known_, id) - ids_);
    last_ = i;
    if (i < known_) return surfaces_[i];
    std::size_t surface = 0;
    while (surface < count_ && !match_.same(first_ids_[surface], id, place)) ++surface;
    if (surface == count_) first_ids_[count_++] = id;
    ids_[known_] = id;
    return surfaces_[known_++] = surface;
  }

  std::uint32_t first_id(std::size_t surface) const { return first_ids_[surface]; }

private:
  SurfaceMatch& match_;
  std::uint32_t ids_[most], first_ids_[most];
  std::size_t surfaces_[most];
  std::size_t known_ = 0, count_ = 0;
  std::size_t last_ = 0;  // in ids_, found last
};

}  // namespace tenebra::render
