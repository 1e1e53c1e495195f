// Convex polygons on the light's plane, kept in vector lanes, and their split by a line: the one geometric
// operation of the solvers (a fragment of the light against a plane through the point; Mora et al. 2012,
// section 4.2). Coordinates are in units of the light (light_frame.h). Included once per target.
#if defined(TENEBRA_SOFT_LIGHT_POLYGON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_LIGHT_POLYGON_INL_H_
#undef TENEBRA_SOFT_LIGHT_POLYGON_INL_H_
#else
#define TENEBRA_SOFT_LIGHT_POLYGON_INL_H_
#endif

#include <bit>
#include <cassert>
#include <limits>

#include "simd/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

inline constexpr int polygon_capacity = 16;
template <class T>
inline constexpr LaneIndex<T> lane_numbers[polygon_capacity] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                                8, 9, 10, 11, 12, 13, 14, 15};
/// The lane after each lane. The lane after the last vertex holds a copy of vertex 0, or is lane 0 if the
/// polygon is full.
template <class T>
inline constexpr LaneIndex<T> next_lanes[polygon_capacity] = {1, 2,  3,  4,  5,  6,  7,  8,
                                                              9, 10, 11, 12, 13, 14, 15, 0};

/// The numbers 0 to 15, one in each lane; and the mask of the lanes below `count`.
template <class T>
SIMD_INLINE Pack<T, 16> counted_lanes() {
  constexpr T lanes[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return load<Pack<T, 16>>(lanes);
}
template <class T>
SIMD_INLINE Mask<T, 16> lanes_below(std::size_t count) {
  return lt(counted_lanes<T>(), broadcast<Pack<T, 16>>(static_cast<T>(HWY_MIN(count, std::size_t{16}))));
}

/// Vertex k in lane k, counter-clockwise; lanes from `count` on repeat vertex 0.
template <class T>
struct LightPolygon {
  using Lanes = Pack<T, polygon_capacity>;
  Lanes x, y;
  int count = 0;

  bool empty() const { return count == 0; }
};

/// The points (x, y) with u x + v y + w > 0 are on the positive side.
template <class T>
struct LightLine {
  T u = 0, v = 0, w = 0;
};

/// Vertices nearer to a line than this, in units of the light, count as on it: it bounds what the rounding of
/// a vertex's coordinates (below 1.5 in magnitude), of two products and of two sums amounts to.
template <class T>
inline constexpr T on_line = 4 * std::numeric_limits<T>::epsilon();

template <class T>
struct LineValues {
  Pack<T, polygon_capacity> value;
  std::uint32_t positive = 0;  ///< bit k: vertex k strictly on the positive side, by more than on_line
  std::uint32_t negative = 0;
};

template <class T>
SIMD_INLINE LineValues<T> evaluate(const LightPolygon<T>& polygon, const LightLine<T>& line) {
  using Lanes = Pack<T, polygon_capacity>;
  LineValues<T> r;
  r.value =
      broadcast<Lanes>(line.u) * polygon.x + broadcast<Lanes>(line.v) * polygon.y + broadcast<Lanes>(line.w);
  const Lanes near = broadcast<Lanes>(on_line<T> * (HWY_MAX(line.u, -line.u) + HWY_MAX(line.v, -line.v)));
  r.positive = lt_bits(near, r.value);
  r.negative = lt_bits(r.value, broadcast<Lanes>(T(0)) - near);
  return r;
}

/// Four lines that bound a convex shadow, positive inside.
template <class T>
struct ShadowLines {
  const T *u = nullptr, *v = nullptr, *w = nullptr;  ///< of each line

  LightLine<T> operator[](int k) const { return {u[k], v[k], w[k]}; }
};
inline constexpr std::uint32_t all_lines = 15;

/// Bit k: line k has vertices strictly on that side, by more than on_line.
template <class T>
struct LineSides {
  std::uint32_t positive = 0, negative = 0;
  /// Lanes k, k + 4, k + 8 and k + 12: the least values of line k, each over some of the vertices, in units
  /// of what counts as on the line; anything where u = v = 0.
  Pack<T, polygon_capacity> lowest;

  /// The line, of those of `among` (at least one), with a vertex farthest on its negative side.
  SIMD_INLINE int deepest(std::uint32_t among) const {
    if (std::has_single_bit(among)) return std::countr_zero(among);
    T values[polygon_capacity];
    store(lowest, values);
    int best = std::countr_zero(among);
    T least = std::numeric_limits<T>::max();
    for (; among != 0; among &= among - 1) {
      const int k = std::countr_zero(among);
      const T value = HWY_MIN(HWY_MIN(values[k], values[k + 4]), HWY_MIN(values[k + 8], values[k + 12]));
      best = value < least ? k : best;
      least = HWY_MIN(value, least);
    }
    return best;
  }
};

/// On which sides of the lines the vertices lie: decided as by evaluate(), for four lines and four vertices
/// at a time.
template <class T>
SIMD_INLINE LineSides<T> sides_of(const LightPolygon<T>& polygon, const ShadowLines<T>& lines) {
  using Lanes = Pack<T, polygon_capacity>;
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  constexpr LaneIndex<T> fours[polygon_capacity] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  const Lanes u = load_four<Lanes>(lines.u), v = load_four<Lanes>(lines.v), w = load_four<Lanes>(lines.w);
  const Lanes near = broadcast<Lanes>(on_line<T>) * (abs(u) + abs(v));
  Lanes low = broadcast<Lanes>(std::numeric_limits<T>::max()), high = broadcast<Lanes>(T(0)) - low;
  for (int first = 0; first < polygon.count; first += 4) {
    const Index vertices = load<Index>(fours) + broadcast<Index>(static_cast<LaneIndex<T>>(first));
    const Lanes value = u * permute(polygon.x, vertices) + v * permute(polygon.y, vertices) + w;
    low = min(low, value);
    high = max(high, value);
  }
  const auto lines_of = [](std::uint32_t lanes) {
    lanes |= lanes >> 8;
    return (lanes | lanes >> 4) & all_lines;
  };
  return {lines_of(lt_bits(near, high)), lines_of(lt_bits(low, broadcast<Lanes>(T(0)) - near)), low / near};
}

/// The vertices of one side: `length` vertices from `first` on, cyclic.
struct VertexRun {
  int first = 0, length = 0;
};

/// The run of vertices of `set` around the one with the greatest of `values`.
template <class T>
HWY_NOINLINE VertexRun farthest_run(std::uint32_t set, int count, const T* values) {
  int farthest = 0;
  for (int k = 1; k < count; ++k) {
    if (values[k] > values[farthest]) farthest = k;
  }
  const auto positive = [&](int k) { return (set >> ((k + count) % count) & 1u) != 0; };
  VertexRun run{farthest, 1};
  while (run.length < count - 1 && positive(farthest + run.length)) ++run.length;
  while (run.length < count - 1 && positive(run.first - 1)) {
    run.first = (run.first - 1 + count) % count;
    ++run.length;
  }
  return run;
}

/// The vertices of `set` among the lowest `count` bits as a run. Rounding can break the run of a thin polygon
/// into pieces: then it is the one around the vertex farthest on the positive side; values fall from there on
/// both sides, so that what other pieces hold lies within rounding of the line.
template <class T>
SIMD_INLINE VertexRun run_of(std::uint32_t set, int count, const Pack<T, polygon_capacity>& values) {
  const std::uint32_t all = (1u << count) - 1u;
  set &= all;
  const std::uint32_t starts = set & ~(((set << 1) | (set >> (count - 1))) & all);
  if (std::has_single_bit(starts)) return {std::countr_zero(starts), std::popcount(set)};
  T lanes[polygon_capacity];
  store(values, lanes);
  return farthest_run(set, count, lanes);
}

/// Numbers of the vertices of `run`, repeating its first vertex behind them.
template <class T>
SIMD_INLINE Pack<LaneIndex<T>, polygon_capacity> vertices_of(VertexRun run, int count) {
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  const auto whole = [](int i) { return broadcast<Index>(static_cast<LaneIndex<T>>(i)); };
  const Index lane = load<Index>(lane_numbers<T>), straight = lane + whole(run.first);
  const Index wrapped = select(gt(straight, whole(count - 1)), straight - whole(count), straight);
  return select(gt(whole(run.length), lane), wrapped, whole(run.first));
}

/// Where a line crosses edge k, from vertex k to the next, in lane k: anything where it does not.
template <class T>
struct EdgeCrossings {
  Pack<T, polygon_capacity> x, y;
};

/// Found for all edges at once, before it is known which are crossed. Each place is computed from the edge's
/// end with the larger value, whichever way the edge runs. polygon.count < polygon_capacity.
template <class T>
SIMD_INLINE EdgeCrossings<T> crossings_of(const LightPolygon<T>& polygon,
                                          const Pack<T, polygon_capacity>& values) {
  using Lanes = Pack<T, polygon_capacity>;
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  const Index next = load<Index>(next_lanes<T>);
  const Lanes zero = broadcast<Lanes>(T(0)), one = broadcast<Lanes>(T(1));
  const Lanes next_values = permute(values, next);
  const Lanes next_x = permute(polygon.x, next), next_y = permute(polygon.y, next);
  const auto falls = lt(next_values, values);
  const Lanes from = max(values, next_values), drop = from - min(values, next_values);
  const Lanes t = min(max(from / select(eq(drop, zero), one, drop), zero), one);
  const auto along = [&](Lanes here, Lanes there) {
    const Lanes inside = select(falls, here, there);
    return inside + t * (select(falls, there, here) - inside);
  };
  return {along(polygon.x, next_x), along(polygon.y, next_y)};
}

/// The vertices of `run`, and behind them where the line crosses the edges `leaving` and `returning`.
template <class T>
SIMD_INLINE LightPolygon<T> part_of(const LightPolygon<T>& polygon, const EdgeCrossings<T>& crossings,
                                    VertexRun run, int leaving, int returning) {
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  const auto whole = [](int i) { return broadcast<Index>(static_cast<LaneIndex<T>>(i)); };
  const Index lane = load<Index>(lane_numbers<T>);
  const auto leaves = eq(lane, whole(run.length));
  const auto crosses = leaves | eq(lane, whole(run.length + 1));
  const Index edge = select(leaves, whole(leaving), whole(returning));
  const Index vertex = vertices_of<T>(run, polygon.count);
  return {select(crosses, permute(crossings.x, edge), permute(polygon.x, vertex)),
          select(crosses, permute(crossings.y, edge), permute(polygon.y, vertex)), run.length + 2};
}

/// Both parts of a polygon that has vertices on both sides. Vertices on the line go with the negative side.
/// polygon.count < polygon_capacity.
template <class T>
SIMD_INLINE void split(const LightPolygon<T>& polygon, const LineValues<T>& line, LightPolygon<T>& positive,
                       LightPolygon<T>& negative) {
  assert(polygon.count < polygon_capacity);
  const EdgeCrossings<T> crossings = crossings_of(polygon, line.value);
  const VertexRun run = run_of(line.positive, polygon.count, line.value);
  const int n = polygon.count, behind = run.first + run.length;
  const int leaving = behind <= n ? behind - 1 : behind - 1 - n,
            returning = (run.first > 0 ? run.first : n) - 1;
  const VertexRun others{behind < n ? behind : behind - n, n - run.length};
  const LightPolygon<T> inside = part_of(polygon, crossings, run, leaving, returning);
  negative = part_of(polygon, crossings, others, returning, leaving);
  positive = inside;
}

/// Two polygons for one, along a diagonal: vertices 0 to count / 2, and the others with both ends.
template <class T>
SIMD_INLINE void halve(const LightPolygon<T>& polygon, LightPolygon<T>& low, LightPolygon<T>& high) {
  using Index = Pack<LaneIndex<T>, polygon_capacity>;
  LaneIndex<T> first[polygon_capacity], second[polygon_capacity];
  const int middle = polygon.count / 2;
  for (int k = 0; k < polygon_capacity; ++k) {
    first[k] = static_cast<LaneIndex<T>>(k <= middle ? k : 0);
    const int v = middle + k;
    second[k] = static_cast<LaneIndex<T>>(v < polygon.count ? v : v == polygon.count ? 0 : middle);
  }
  low = {permute(polygon.x, load<Index>(first)), permute(polygon.y, load<Index>(first)), middle + 1};
  high = {permute(polygon.x, load<Index>(second)), permute(polygon.y, load<Index>(second)),
          polygon.count - middle + 1};
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
