// A convex polygon minus a union of convex polygons, by a sweep: between two neighbouring abscissae of
// corners and crossings the difference is a stack of trapezoids. No polygon is ever cut by another. Numbers
// are a template parameter: rationals give the exact answer; long doubles one whose error is bounded (below).
#pragma once

#include <algorithm>
#include <vector>

namespace tenebra::oracle {

template <class N>
struct Point2 {
  N x, y;
};
template <class N>
using Polygon = std::vector<Point2<N>>;  ///< convex, counter-clockwise

/// c + x p.x + y p.y >= 0
template <class N>
struct HalfPlane {
  N c, x, y;
  N at(const Point2<N>& p) const { return N(c + x * p.x + y * p.y); }
};

/// The part of `polygon` inside `half`; empty if no corner lies strictly inside: it has no area then.
template <class N>
Polygon<N> clipped(const Polygon<N>& polygon, const HalfPlane<N>& half) {
  Polygon<N> out;
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2<N>&p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const N dp = half.at(p), dq = half.at(q);
    inside = inside || dp > 0;
    if (dp >= 0) out.push_back(p);
    if ((dp < 0 && dq > 0) || (dp > 0 && dq < 0)) {
      const N t = dp / N(dp - dq);
      out.push_back({N(p.x + t * N(q.x - p.x)), N(p.y + t * N(q.y - p.y))});
    }
  }
  return inside ? out : Polygon<N>();
}

template <class N>
N doubled_area(const Polygon<N>& polygon) {
  N sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Point2<N>&o = polygon[0], &p = polygon[i], &q = polygon[i + 1];
    sum += N(p.x - o.x) * N(q.y - o.y) - N(p.y - o.y) * N(q.x - o.x);
  }
  return sum;
}

/// A non-vertical edge, left to right.
template <class N>
struct SlabEdge {
  Point2<N> left;
  N right, slope;
  std::size_t polygon;
  N at(const N& x) const { return N(left.y + slope * N(x - left.x)); }
};

/// The lower or upper boundary of a polygon, left to right; the sweep moves `now` along.
template <class N>
struct SlabChain {
  std::vector<SlabEdge<N>> edges;
  std::size_t now = 0;

  /// Appends the edge to p, unless it does not go to the right.
  void extend(Point2<N>& last, const Point2<N>& p, std::size_t polygon) {
    if (!(p.x > last.x)) return;
    edges.push_back({last, p.x, N(N(p.y - last.y) / N(p.x - last.x)), polygon});
    last = p;
  }
  /// The edge above or below x; null where the chain does not reach.
  const SlabEdge<N>* over(const N& x) {
    while (now < edges.size() && edges[now].right < x) ++now;
    return now < edges.size() && edges[now].left.x <= x ? &edges[now] : nullptr;
  }
};

template <class N>
struct SlabPolygon {
  SlabChain<N> lower, upper;

  SlabPolygon(const Polygon<N>& polygon, std::size_t index) {
    const std::size_t n = polygon.size();
    const auto x_less = [](const Point2<N>& a, const Point2<N>& b) { return a.x < b.x; };
    const auto [least, most] = std::minmax_element(polygon.begin(), polygon.end(), x_less);
    const auto first = static_cast<std::size_t>(least - polygon.begin());
    const auto last = static_cast<std::size_t>(most - polygon.begin());
    // Vertical sides: the lower chain starts at the lower of the leftmost corners, the upper one at the
    // upper.
    std::size_t bottom = first, top = first;
    while (polygon[(bottom + 1) % n].x == polygon[first].x) bottom = (bottom + 1) % n;
    while (polygon[(top + n - 1) % n].x == polygon[first].x) top = (top + n - 1) % n;
    std::size_t right_bottom = last, right_top = last;
    while (polygon[(right_bottom + n - 1) % n].x == polygon[last].x)
      right_bottom = (right_bottom + n - 1) % n;
    while (polygon[(right_top + 1) % n].x == polygon[last].x) right_top = (right_top + 1) % n;
    Point2<N> at = polygon[bottom];
    for (std::size_t i = bottom; i != right_bottom; i = (i + 1) % n)
      lower.extend(at, polygon[(i + 1) % n], index);
    at = polygon[top];
    for (std::size_t i = top; i != right_top; i = (i + n - 1) % n)
      upper.extend(at, polygon[(i + n - 1) % n], index);
  }
};

/// Appends the abscissae where edges of different polygons cross.
template <class N>
void add_crossings(std::vector<SlabEdge<N>> edges, std::vector<N>& abscissae) {
  std::sort(edges.begin(), edges.end(),
            [](const SlabEdge<N>& a, const SlabEdge<N>& b) { return a.left.x < b.left.x; });
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const SlabEdge<N>& a = edges[i];
    for (std::size_t j = i + 1; j < edges.size() && edges[j].left.x < a.right; ++j) {
      const SlabEdge<N>& b = edges[j];
      if (a.polygon == b.polygon) continue;
      const N &from = b.left.x, &to = a.right < b.right ? a.right : b.right;
      const N d0 = N(a.at(from) - b.left.y), d1 = N(a.at(to) - b.at(to));
      if ((d0 > 0 && d1 < 0) || (d0 < 0 && d1 > 0))
        abscissae.push_back(N(from + N(to - from) * N(d0 / N(d0 - d1))));
    }
  }
}

template <class N>
bool wide(const Polygon<N>& polygon) {
  return std::any_of(polygon.begin(), polygon.end(), [&](const Point2<N>& p) { return p.x != polygon[0].x; });
}

/// Calls visit(left, right, low, high) for each trapezoid of `base` minus the union of `holes`, which lie in
/// `base`: abscissae, and the edges that bound it from below and above.
///
/// In long double, with eps = 2^-63: `holes` as given are met exactly but for the trapezoids' sides, each
/// evaluated within 4 eps of the base's extent, and for crossings misplaced by d <= eps extent: between
/// corners and crossings the height is linear, so that taking it in the middle of a slab costs d^2 times the
/// difference of slopes only.
template <class N, class Visit>
void for_each_trapezoid(const Polygon<N>& base, const std::vector<Polygon<N>>& holes, Visit visit) {
  if (!wide(base)) return;
  std::vector<SlabPolygon<N>> polygons;
  std::vector<SlabEdge<N>> edges;
  std::vector<N> abscissae;
  const auto add = [&](const Polygon<N>& polygon) {
    if (!wide(polygon)) return;
    polygons.emplace_back(polygon, polygons.size());
    for (const auto* chain : {&polygons.back().lower, &polygons.back().upper})
      edges.insert(edges.end(), chain->edges.begin(), chain->edges.end());
    for (const Point2<N>& p : polygon) abscissae.push_back(p.x);
  };
  add(base);
  for (const Polygon<N>& hole : holes) add(hole);
  add_crossings(std::move(edges), abscissae);
  std::sort(abscissae.begin(), abscissae.end());
  abscissae.erase(std::unique(abscissae.begin(), abscissae.end()), abscissae.end());

  struct Section {
    N low, high;
    const SlabEdge<N>*lower, *upper;
  };
  std::vector<Section> sections;
  for (std::size_t k = 0; k + 1 < abscissae.size(); ++k) {
    const N &left = abscissae[k], &right = abscissae[k + 1];
    const N middle = N(N(left + right) / 2);
    sections.clear();
    for (SlabPolygon<N>& polygon : polygons) {
      const SlabEdge<N>*lower = polygon.lower.over(middle), *upper = polygon.upper.over(middle);
      if (lower != nullptr && upper != nullptr)
        sections.push_back({lower->at(middle), upper->at(middle), lower, upper});
    }
    if (sections.empty() || sections[0].lower->polygon != 0) continue;  // beside the base, by rounding
    const Section whole = sections[0];
    std::sort(sections.begin() + 1, sections.end(),
              [](const Section& a, const Section& b) { return a.low < b.low; });
    N covered = whole.low;
    const SlabEdge<N>* under = whole.lower;
    for (std::size_t i = 1; i < sections.size(); ++i) {
      const Section& section = sections[i];
      if (section.low > covered) visit(left, right, *under, *section.lower);
      if (section.high > covered) covered = section.high, under = section.upper;
    }
    if (whole.high > covered) visit(left, right, *under, *whole.upper);
  }
}

}  // namespace tenebra::oracle
