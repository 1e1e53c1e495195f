#include "stage/cutout/piece_ring.h"

#include <algorithm>

namespace tenebra::stage {
namespace {

class RingCutter {
public:
  RingCutter(const PlaneTriangle& triangle, const Rectangle& leaf) : triangle_(triangle), leaf_(leaf) {}

  Ring run() {
    Ring ring;
    for (int k = 0; k < 3; ++k) ring.push_back({triangle_.corner_spot(k), k});
    for (int side = leaf_side; side < side_count && !ring.empty(); ++side) ring = cut(ring, side);
    return ring;
  }

private:
  bool keeps(int side, glm::dvec2 place) const {
    const double at = place[leaf_.axis(side)];
    return leaf_.is_low(side) ? at >= leaf_.line(side) : at <= leaf_.line(side);
  }

  Spot meet(const RingPoint& point, int side) const {
    if (point.side < leaf_side) return triangle_.edge_spot(point.side, leaf_.axis(side), leaf_.line(side));
    glm::dvec2 corner;
    corner[leaf_.axis(side)] = leaf_.line(side);
    corner[leaf_.axis(point.side)] = leaf_.line(point.side);
    return triangle_.spot(corner);
  }

  Ring cut(const Ring& ring, int side) const {
    Ring out;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const bool here = keeps(side, ring[i].spot.at);
      const bool there = keeps(side, ring[(i + 1) % ring.size()].spot.at);
      if (here) out.push_back(ring[i]);
      if (here != there) out.push_back({meet(ring[i], side), here ? side : ring[i].side});
    }
    return without_doubles(out);
  }

  /// The ring with one point for each place: of two points in one place the side of the second counts.
  static Ring without_doubles(const Ring& ring) {
    Ring out;
    for (std::size_t i = 0; i < ring.size(); ++i)
      if (!(ring[i].spot == ring[(i + 1) % ring.size()].spot)) out.push_back(ring[i]);
    return out.size() < 3 ? Ring{} : out;
  }

  const PlaneTriangle& triangle_;
  const Rectangle& leaf_;
};

/// What stands between a point of the ring and its next, which is at `end`.
void insert_between(const RingPoint& point, glm::dvec2 end, const PlaneTriangle& triangle,
                    const Rectangle& bounds, const Leaf& leaf, const Tile& tile, Ring& out) {
  const int axis = bounds.axis(point.side), along = 1 - axis;
  const bool low_in_leaf = bounds.is_low(point.side) == (tile.sign[axis] > 0);
  const auto& corners = leaf.corners_on_side[static_cast<std::size_t>(2 * axis + (low_in_leaf ? 0 : 1))];
  const double from = point.spot.at[along], to = end[along];
  std::vector<double> between;
  for (const double corner : corners) {
    const double at = tile.offset[along] + tile.sign[along] * corner;
    if (at > std::min(from, to) && at < std::max(from, to)) between.push_back(at);
  }
  std::sort(between.begin(), between.end());
  if (to < from) std::reverse(between.begin(), between.end());
  for (const double at : between) {
    glm::dvec2 place;
    place[axis] = bounds.line(point.side), place[along] = at;
    out.push_back({triangle.spot(place), point.side});
  }
}

}  // namespace

Rectangle place_leaf(const Leaf& leaf, const Tile& tile) {
  const glm::dvec2 a = tile.offset + tile.sign * leaf.low, b = tile.offset + tile.sign * leaf.high;
  return {glm::min(a, b), glm::max(a, b)};
}

Ring cut_ring(const PlaneTriangle& triangle, const Rectangle& leaf) {
  return RingCutter(triangle, leaf).run();
}

Ring with_leaf_corners(const Ring& ring, const PlaneTriangle& triangle, const Rectangle& bounds,
                       const Leaf& leaf, const Tile& tile) {
  Ring out;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    out.push_back(ring[i]);
    if (ring[i].side >= leaf_side)
      insert_between(ring[i], ring[(i + 1) % ring.size()].spot.at, triangle, bounds, leaf, tile, out);
  }
  return out;
}

}  // namespace tenebra::stage
