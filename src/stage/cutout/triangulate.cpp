#include "stage/cutout/triangulate.h"

#include <algorithm>
#include <numeric>

#include "stage/cutout/cross.h"

namespace tenebra::stage {
namespace {

using Points = std::span<const glm::dvec2>;

/// Twice the area of a triangle; positive if counter-clockwise.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return cross(b - a, c - a);
}

double twice_area(Points points, const Loop& loop) {
  double sum = 0;
  const glm::dvec2 origin = points[loop[0]];
  for (std::size_t i = 0; i < loop.size(); ++i)
    sum += cross(points[loop[i]] - origin, points[loop[(i + 1) % loop.size()]] - origin);
  return sum;
}

bool contains(Points points, const Loop& loop, glm::dvec2 p) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::dvec2 a = points[loop[i]], b = points[loop[(i + 1) % loop.size()]];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    inside ^= p.x < a.x + (p.y - a.y) * ((b.x - a.x) / (b.y - a.y));
  }
  return inside;
}

/// Whether a hole lies in a loop: most of its vertices do. Some may lie on the loop itself.
bool contains(Points points, const Loop& loop, const Loop& hole) {
  const auto count = std::count_if(hole.begin(), hole.end(),
                                   [&](std::uint32_t v) { return contains(points, loop, points[v]); });
  return 2 * static_cast<std::size_t>(count) > hole.size();
}

/// Whether `p` lies on the way into the loop at its vertex `i`.
bool opens_to(Points points, const Loop& loop, std::size_t i, glm::dvec2 p) {
  const glm::dvec2 at = points[loop[i]], next = points[loop[(i + 1) % loop.size()]];
  const glm::dvec2 previous = points[loop[(i + loop.size() - 1) % loop.size()]];
  const bool left_of_next = cross(next - at, p - at) > 0;
  const bool right_of_previous = cross(p - at, previous - at) > 0;
  return turn(previous, at, next) >= 0 ? left_of_next && right_of_previous
                                       : left_of_next || right_of_previous;
}

bool boxes_meet(glm::dvec2 a, glm::dvec2 b, glm::dvec2 p, glm::dvec2 q) {
  const glm::dvec2 low = glm::max(glm::min(a, b), glm::min(p, q));
  const glm::dvec2 high = glm::min(glm::max(a, b), glm::max(p, q));
  return low.x <= high.x && low.y <= high.y;
}

/// Whether the segment meets the loop anywhere but in vertices at its own ends, or with its first.
bool crosses(Points points, const Loop& loop, glm::dvec2 p, glm::dvec2 q) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const glm::dvec2 a = points[loop[i]], b = points[loop[(i + 1) % loop.size()]];
    if (a == p || a == q || b == p || b == q) continue;
    const double of_a = turn(p, q, a), of_b = turn(p, q, b), of_p = turn(a, b, p), of_q = turn(a, b, q);
    const bool apart = (of_a > 0 && of_b > 0) || (of_a < 0 && of_b < 0) || (of_p > 0 && of_q > 0) ||
                       (of_p < 0 && of_q < 0) || of_p == 0;
    if (!apart && boxes_meet(a, b, p, q)) return true;
  }
  return false;
}

/// A polygon with its holes joined to it by bridges, each walked both ways.
class Bridging {
public:
  Bridging(Points points, Loop outer, std::vector<Loop> holes)
      : points_(points), outer_(std::move(outer)), holes_(std::move(holes)) {
    for (Loop& hole : holes_) std::rotate(hole.begin(), rightmost(hole), hole.end());
    std::sort(holes_.begin(), holes_.end(),
              [&](const Loop& a, const Loop& b) { return before(b.front(), a.front()); });
  }

  Loop run() {
    for (std::size_t h = 0; h < holes_.size(); ++h) splice(holes_[h], find_bridge(h));
    return std::move(outer_);
  }

private:
  bool before(std::uint32_t a, std::uint32_t b) const {
    const glm::dvec2 p = points_[a], q = points_[b];
    return p.x != q.x ? p.x < q.x : p.y < q.y;
  }
  Loop::iterator rightmost(Loop& loop) const {
    return std::max_element(loop.begin(), loop.end(),
                            [&](std::uint32_t a, std::uint32_t b) { return before(a, b); });
  }

  /// The nearest vertex of the polygon that the hole's first vertex sees; the nearest at all if rounding
  /// hides every one.
  std::size_t find_bridge(std::size_t hole) const {
    const glm::dvec2 from = points_[holes_[hole].front()];
    std::vector<std::pair<double, std::size_t>> order(outer_.size());
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      const glm::dvec2 way = points_[outer_[i]] - from;
      order[i] = {glm::dot(way, way), i};
    }
    std::sort(order.begin(), order.end());
    for (const auto& [distance, i] : order)
      if (opens_to(points_, outer_, i, from) && sees(hole, from, points_[outer_[i]])) return i;
    return order.front().second;
  }
  bool sees(std::size_t hole, glm::dvec2 from, glm::dvec2 to) const {
    if (crosses(points_, outer_, from, to)) return false;
    return std::none_of(holes_.begin() + static_cast<std::ptrdiff_t>(hole), holes_.end(),
                        [&](const Loop& other) { return crosses(points_, other, from, to); });
  }

  void splice(const Loop& hole, std::size_t at) {
    Loop way(hole.begin(), hole.end());
    way.push_back(hole.front());
    way.push_back(outer_[at]);
    outer_.insert(outer_.begin() + static_cast<std::ptrdiff_t>(at) + 1, way.begin(), way.end());
  }

  Points points_;
  Loop outer_;
  std::vector<Loop> holes_;
};

/// Cuts ears off a polygon, that is corners whose triangle holds no other vertex.
class EarCutter {
public:
  EarCutter(Points points, const Loop& loop, std::vector<glm::uvec3>& out)
      : points_(points), loop_(loop), out_(out), left_(loop.size()) {
    const auto n = loop.size();
    next_.resize(n), previous_.resize(n), blunt_.resize(n);
    for (std::size_t i = 0; i < n; ++i) next_[i] = (i + 1) % n, previous_[i] = (i + n - 1) % n;
    for (std::size_t i = 0; i < n; ++i) blunt_[i] = corner(i) <= 0;
  }

  void run() {
    std::size_t at = 0, tried = 0;
    while (left_ > 3) {
      if (corner(at) > 0 && is_free(at)) {
        cut(at);
        at = next_[next_[at]];  // every other corner first: rounder triangles
        tried = 0;
      } else if (++tried > left_) {
        at = widest();
        cut(at);
        at = next_[at];
        tried = 0;
      } else {
        at = next_[at];
      }
    }
    if (left_ == 3) cut(at);
  }

private:
  glm::dvec2 point(std::size_t i) const { return points_[loop_[i]]; }
  double corner(std::size_t i) const { return turn(point(previous_[i]), point(i), point(next_[i])); }

  bool is_free(std::size_t i) const {
    const glm::dvec2 a = point(previous_[i]), b = point(i), c = point(next_[i]);
    const glm::dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    for (std::size_t k = next_[next_[i]]; k != previous_[i]; k = next_[k]) {
      if (!blunt_[k]) continue;
      const glm::dvec2 p = point(k);
      if (p.x < low.x || p.y < low.y || p.x > high.x || p.y > high.y) continue;
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

  /// Where no ear is left, by rounding: the corner with most area.
  std::size_t widest() const {
    std::size_t first = 0;
    while (next_[previous_[first]] != first) ++first;  // one that is still in the ring
    std::size_t best = first;
    for (std::size_t i = next_[first]; i != first; i = next_[i])
      if (corner(i) > corner(best)) best = i;
    return best;
  }

  void cut(std::size_t i) {
    const std::size_t a = previous_[i], c = next_[i];
    const glm::uvec3 triangle(loop_[a], loop_[i], loop_[c]);
    if (triangle.x != triangle.y && triangle.y != triangle.z && triangle.z != triangle.x)
      out_.push_back(triangle);
    next_[a] = c;
    previous_[c] = a;
    --left_;
    blunt_[a] = corner(a) <= 0;
    blunt_[c] = corner(c) <= 0;
  }

  Points points_;
  const Loop& loop_;
  std::vector<glm::uvec3>& out_;
  std::size_t left_;
  std::vector<std::size_t> next_, previous_;
  std::vector<std::uint8_t> blunt_;
};

}  // namespace

std::vector<glm::uvec3> triangulate(Points points, std::vector<Loop> loops) {
  std::vector<glm::uvec3> triangles;
  std::vector<double> area(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i)
    area[i] = loops[i].size() < 3 ? 0 : twice_area(points, loops[i]);
  std::vector<std::vector<Loop>> holes(loops.size());
  for (std::size_t h = 0; h < loops.size(); ++h) {
    if (!(area[h] < 0)) continue;
    std::size_t owner = loops.size();
    for (std::size_t i = 0; i < loops.size(); ++i) {
      if (area[i] > 0 && (owner == loops.size() || area[i] < area[owner]) &&
          contains(points, loops[i], loops[h]))
        owner = i;
    }
    if (owner < loops.size()) holes[owner].push_back(loops[h]);
  }
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (!(area[i] > 0)) continue;
    const Loop polygon = Bridging(points, std::move(loops[i]), std::move(holes[i])).run();
    EarCutter(points, polygon, triangles).run();
  }
  return triangles;
}

}  // namespace tenebra::stage
