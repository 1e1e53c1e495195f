// Convex polygons on the light's plane in lanes, one for each point of a packet, and their split by a line
// that differs from point to point: light_polygon-inl.h transposed. Included once per target.
#if defined(TENEBRA_SOFT_PACKET_POLYGON_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_PACKET_POLYGON_INL_H_
#undef TENEBRA_SOFT_PACKET_POLYGON_INL_H_
#else
#define TENEBRA_SOFT_PACKET_POLYGON_INL_H_
#endif

#include "soft/polygon/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

inline constexpr int packet_size = 16;      ///< points
inline constexpr int packet_vertices = 12;  ///< of a polygon, at most

using PacketMask = Mask<float, packet_size>;

/// Vertex k of the polygons in x[k] and y[k], counter-clockwise. A lane with fewer vertices than `count`
/// repeats some of them, each next to itself.
struct alignas(64) PacketPolygon {
  int count = 0;
  Float16 x[packet_vertices], y[packet_vertices];

  void assign(const PacketPolygon& from) {
    count = from.count;
    int k = 0;
    do {
      x[k] = from.x[k];
      y[k] = from.y[k];
    } while (++k < count);
  }
  int behind(int k) const { return k + 1 < count ? k + 1 : 0; }
  int before(int k) const { return k > 0 ? k - 1 : count - 1; }
};

/// A LightLine in each lane.
struct alignas(64) PacketLine {
  Float16 u, v, w;

  SIMD_INLINE Float16 at(Float16 x, Float16 y) const { return u * x + v * y + w; }
  /// Vertices of smaller values count as on the line (on_line).
  SIMD_INLINE Float16 near() const { return broadcast<Float16>(on_line<float>) * (abs(u) + abs(v)); }
};

struct PacketValues {
  Float16 value[packet_vertices];
  Float16 near;
  std::uint32_t positive = 0, negative = 0;  ///< bits of the lanes that have vertices strictly on that side
};

SIMD_INLINE PacketValues evaluate(const PacketPolygon& polygon, const PacketLine& line) {
  PacketValues r;
  r.near = line.near();
  Float16 low = r.value[0] = line.at(polygon.x[0], polygon.y[0]), high = low;
  for (int k = 1; k < polygon.count; ++k) {
    r.value[k] = line.at(polygon.x[k], polygon.y[k]);
    low = min(low, r.value[k]);
    high = max(high, r.value[k]);
  }
  r.positive = lt_bits(r.near, high);
  r.negative = lt_bits(low, broadcast<Float16>(0.0f) - r.near);
  return r;
}

/// Bits of the lanes where some vertex lies strictly on the line's positive side.
SIMD_INLINE std::uint32_t reaching(const PacketPolygon& polygon, const PacketLine& line) {
  Float16 high = line.at(polygon.x[0], polygon.y[0]);
  for (int k = 1; k < polygon.count; ++k) high = max(high, line.at(polygon.x[k], polygon.y[k]));
  return lt_bits(line.near(), high);
}

/// A vertex with its value.
struct PacketVertex {
  Float16 x, y, value;

  SIMD_INLINE void take(PacketMask where, const PacketPolygon& from, const PacketValues& line, int k) {
    x = select(where, from.x[k], x);
    y = select(where, from.y[k], y);
    value = select(where, line.value[k], value);
  }
};

struct PacketPoint2 {
  Float16 x, y;
};

/// Where the line crosses the way from a vertex on its positive side to one that is not.
SIMD_INLINE PacketPoint2 crossing_of(const PacketVertex& from, const PacketVertex& beyond) {
  const Float16 zero = broadcast<Float16>(0.0f), one = broadcast<Float16>(1.0f);
  const Float16 drop = from.value - beyond.value;
  const Float16 t = min(max(from.value / select(eq(drop, zero), one, drop), zero), one);
  return {from.x + t * (beyond.x - from.x), from.y + t * (beyond.y - from.y)};
}

/// One side of a cut: the vertices that are `kept`, and in place of the run of those `dropped` first `first`
/// and then `second`. Where that run is a single vertex, in a lane of `cut`, room is made for both.
SIMD_INLINE void replace_run(const PacketPolygon& polygon, const PacketMask (&kept)[packet_vertices],
                             const PacketMask (&dropped)[packet_vertices], PacketMask cut,
                             const PacketPoint2& first, const PacketPoint2& second, PacketPolygon& out) {
  const int n = polygon.count;
  PacketMask alone[packet_vertices];    // a run of one vertex
  PacketMask reached[packet_vertices];  // there was one, here or before
  PacketMask some = kept[0] & dropped[0];
  for (int k = 0; k < n; ++k) {
    const PacketMask begins = kept[polygon.before(k)] & dropped[k];
    alone[k] = begins & kept[polygon.behind(k)] & cut;
    reached[k] = some = some | alone[k];
    out.x[k] = select(dropped[k], select(begins, first.x, second.x), polygon.x[k]);
    out.y[k] = select(dropped[k], select(begins, first.y, second.y), polygon.y[k]);
  }
  out.count = n;
  if (!any(some)) return;
  out.x[n] = out.x[0];
  out.y[n] = out.y[0];
  for (int k = n; k > 0; --k) {
    out.x[k] = select(alone[k - 1], second.x, select(reached[k - 1], out.x[k - 1], out.x[k]));
    out.y[k] = select(alone[k - 1], second.y, select(reached[k - 1], out.y[k - 1], out.y[k]));
  }
  out.count = n + 1;
}

/// Both parts of the polygons in the lanes of `cut`, which have vertices strictly on both sides; vertices on
/// the line go with the negative side. In the other lanes, `positive` is the polygon as it was, `negative`
/// anything. False where rounding breaks the vertices of a thin polygon into more than two runs, or there are
/// too many.
SIMD_INLINE bool split(const PacketPolygon& polygon, PacketValues& line, std::uint32_t cut,
                       PacketPolygon& positive, PacketPolygon& negative) {
  if (polygon.count == packet_vertices) return false;
  const PacketMask parted = mask_of_bits<float, packet_size>(cut);
  PacketMask above[packet_vertices], below[packet_vertices];
  for (int k = 0; k < polygon.count; ++k) {
    line.value[k] = select(parted, line.value[k], broadcast<Float16>(1e30f));
    above[k] = lt(line.near, line.value[k]);
    below[k] = le(line.value[k], line.near);
  }
  PacketVertex last_above{polygon.x[0], polygon.y[0], line.value[0]};
  PacketVertex first_below = last_above, last_below = last_above, first_above = last_above;
  PacketMask left = above[0] & below[0], twice = left;  // nowhere
  for (int k = 0; k < polygon.count; ++k) {
    const int j = polygon.before(k);
    const PacketMask leaves = above[j] & below[k], returns = below[j] & above[k];
    twice = twice | (left & leaves);
    left = left | leaves;
    last_above.take(leaves, polygon, line, j), first_below.take(leaves, polygon, line, k);
    last_below.take(returns, polygon, line, j), first_above.take(returns, polygon, line, k);
  }
  if (any(twice)) return false;
  const PacketPoint2 leaving = crossing_of(last_above, first_below);
  const PacketPoint2 returning = crossing_of(first_above, last_below);
  replace_run(polygon, above, below, parted, leaving, returning, positive);
  replace_run(polygon, below, above, parted, returning, leaving, negative);
  return true;
}

/// Takes vertices out while each lane of `lanes` has one that is repeated.
SIMD_INLINE void compact(PacketPolygon& p, std::uint32_t lanes) {
  while (p.count > 3) {
    PacketMask repeated[packet_vertices];
    for (int k = 0; k < p.count; ++k)
      repeated[k] = eq(p.x[k], p.x[p.behind(k)]) & eq(p.y[k], p.y[p.behind(k)]);
    PacketMask some = repeated[0];
    for (int k = 1; k < p.count; ++k) some = some | repeated[k];
    if ((lanes & ~bits(some)) != 0) return;
    PacketMask moved = repeated[0];
    for (int k = 0; k + 1 < p.count; ++k) {
      if (k > 0) moved = moved | repeated[k];
      p.x[k] = select(moved, p.x[k + 1], p.x[k]);
      p.y[k] = select(moved, p.y[k + 1], p.y[k]);
    }
    --p.count;
  }
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
