#include "stage/cutout/outline_tree.h"

#include <algorithm>
#include <cmath>

namespace tenebra::stage {
namespace {

using Segments = std::vector<std::uint32_t>;

constexpr std::size_t leaf_size = 384;
/// Cuts lie beside medians, which vertices of regular pictures share, so that few vertices lie on a cut.
constexpr double beside = 0.0123456789;

/// Segments that cross the line coordinate[axis] = at, between `low` and `high` along it: even or odd.
bool odd_crossings(const Outline& outline, const Segments& segments, int axis, double at, double low,
                   double high) {
  bool odd = false;
  for (const std::uint32_t s : segments) {
    const glm::dvec2 a = outline.points[s], b = outline.points[outline.next[s]];
    if ((a[axis] >= at) == (b[axis] >= at)) continue;
    const double along = a[1 - axis] + (at - a[axis]) * ((b[1 - axis] - a[1 - axis]) / (b[axis] - a[axis]));
    odd ^= along >= low && along < high;
  }
  return odd;
}

/// Splits rectangles at the median of their segments along the longer side of these.
class TreeBuilder {
public:
  explicit TreeBuilder(OutlineTree& tree) : outline_(tree.outline), leaves_(tree.leaves) {}

  void build() {
    Segments all(outline_.points.size());
    Leaf root;
    for (std::uint32_t s = 0; s < all.size(); ++s) all[s] = s;
    root.low = glm::dvec2(-1.0), root.high = glm::dvec2(1.0);
    for (const glm::dvec2 point : outline_.points) {
      root.low = glm::min(root.low, point - 1.0);
      root.high = glm::max(root.high, point + 1.0);
    }
    root.segments = std::move(all);
    split(std::move(root));
  }

private:
  glm::dvec2 middle(std::uint32_t s) const {
    return 0.5 * (outline_.points[s] + outline_.points[outline_.next[s]]);
  }

  bool meets(std::uint32_t s, const Leaf& leaf) const {
    const glm::dvec2 a = outline_.points[s], b = outline_.points[outline_.next[s]];
    const glm::dvec2 low = glm::min(a, b), high = glm::max(a, b);
    return low.x <= leaf.high.x && low.y <= leaf.high.y && high.x >= leaf.low.x && high.y >= leaf.low.y;
  }

  /// The axis along which the middles of the segments spread most, and their median there.
  std::pair<int, double> choose_cut(const Segments& segments) const {
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (const std::uint32_t s : segments) {
      low = glm::min(low, middle(s));
      high = glm::max(high, middle(s));
    }
    const int axis = high.x - low.x >= high.y - low.y ? 0 : 1;
    std::vector<double> places(segments.size());
    std::transform(segments.begin(), segments.end(), places.begin(),
                   [&](std::uint32_t s) { return middle(s)[axis]; });
    const auto median = places.begin() + static_cast<std::ptrdiff_t>(places.size() / 2);
    std::nth_element(places.begin(), median, places.end());
    return {axis, *median + beside};
  }

  Leaf part(const Leaf& leaf, int axis, double at, bool upper) const {
    Leaf result{leaf.low, leaf.high, {}, leaf.corner_inside, {}};
    (upper ? result.low : result.high)[axis] = at;
    std::copy_if(leaf.segments.begin(), leaf.segments.end(), std::back_inserter(result.segments),
                 [&](std::uint32_t s) { return meets(s, result); });
    if (upper) {
      result.corner_inside ^=
          odd_crossings(outline_, leaf.segments, 1 - axis, leaf.low[1 - axis], leaf.low[axis], at);
    }
    return result;
  }

  /// Without recursion deeper than the logarithm: a split that does not help ends it.
  void split(Leaf leaf) {
    if (leaf.segments.size() > leaf_size) {
      const auto [axis, at] = choose_cut(leaf.segments);
      if (at > leaf.low[axis] && at < leaf.high[axis]) {
        Leaf lower = part(leaf, axis, at, false), upper = part(leaf, axis, at, true);
        if (std::max(lower.segments.size(), upper.segments.size()) < leaf.segments.size() * 7 / 8) {
          leaf = {};
          split(std::move(lower));
          split(std::move(upper));
          return;
        }
      }
    }
    leaves_.push_back(std::move(leaf));
  }

  const Outline& outline_;
  std::vector<Leaf>& leaves_;
};

void collect_corners(std::vector<Leaf>& leaves) {
  if (leaves.size() == 1) return;
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2, along = 1 - axis;
    std::vector<std::pair<double, double>> corners;  // on lines across `axis`: the line, the place along it
    for (const Leaf& leaf : leaves)
      for (const glm::dvec2& corner : {leaf.low, leaf.high})
        for (const double other : {leaf.low[along], leaf.high[along]})
          corners.emplace_back(corner[axis], other);
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (Leaf& leaf : leaves) {
      const double line = side % 2 == 0 ? leaf.low[axis] : leaf.high[axis];
      auto at = std::upper_bound(corners.begin(), corners.end(), std::pair(line, leaf.low[along]));
      for (; at != corners.end() && at->first == line && at->second < leaf.high[along]; ++at)
        leaf.corners_on_side[static_cast<std::size_t>(side)].push_back(at->second);
    }
  }
}

}  // namespace

OutlineTree build_tree(Outline outline) {
  OutlineTree tree{std::move(outline), {}};
  TreeBuilder(tree).build();
  collect_corners(tree.leaves);
  return tree;
}

bool is_inside(const Outline& outline, const Leaf& leaf, glm::dvec2 place) {
  return leaf.corner_inside ^ odd_crossings(outline, leaf.segments, 0, leaf.low.x, leaf.low.y, place.y) ^
         odd_crossings(outline, leaf.segments, 1, place.y, leaf.low.x, place.x);
}

}  // namespace tenebra::stage
