// The segments of a silhouette's edges on a convex part of the light, and where they cross its sides.
// Included once per target.
#if defined(TENEBRA_SOFT_EDGE_STRETCHES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_EDGE_STRETCHES_INL_H_
#undef TENEBRA_SOFT_EDGE_STRETCHES_INL_H_
#else
#define TENEBRA_SOFT_EDGE_STRETCHES_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "soft/silhouette/silhouette_windings-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Whether two ends lie on different sides of a line, by their values, and rounding cannot change that; and
/// whether they may.
template <class T>
SIMD_INLINE Mask<T, 16> parted(Pack<T, 16> a, Pack<T, 16> b, Pack<T, 16> margin) {
  return lt(min(a, b), broadcast<Pack<T, 16>>(T(0)) - margin) & lt(margin, max(a, b));
}
template <class T>
SIMD_INLINE Mask<T, 16> maybe_parted(Pack<T, 16> a, Pack<T, 16> b, Pack<T, 16> margin) {
  return lt(min(a, b), margin) & lt(broadcast<Pack<T, 16>>(T(0)) - margin, max(a, b));
}

/// Where the winding changes along an edge or a side.
template <class T>
struct WindingChange {
  double share;  ///< of the way along it, 0 to 1; along sides, that plus the side's number
  glm::dvec2 at;
  T change;
};
template <class T>
void sort_along(std::vector<WindingChange<T>>& changes) {
  std::sort(changes.begin(), changes.end(),
            [](const WindingChange<T>& a, const WindingChange<T>& b) { return a.share < b.share; });
}

/// Decisions are about the part without a seam along its sides that is wider than rounding, if the part is
/// wider than a sixteenth: edges that run along a side, as where something next to the silhouette has been
/// cut out, leave nothing undecided. Places are on the part's own sides.
template <class T>
class EdgeSegments {
public:
  using Lanes = Pack<T, 16>;

  std::vector<T> from_u, from_v, to_u, to_v;  ///< their ends
  std::vector<T> margin;                      ///< doubt_beside the edges
  /// Bits of a block of sixteen: edges with a segment; and those where rounding might decide where it ends.
  struct Block {
    std::uint32_t there = 0, unsure = 0;
  };
  std::vector<Block> blocks;
  std::vector<WindingChange<T>> side_changes;  ///< in order along the sides, counter-clockwise

  /// Finds the segments of the edges from place `first` on.
  HWY_NOINLINE void find(const SilhouetteEdges<T>& edges, std::size_t first, T slack,
                         const LightPolygon<T>& part) {
    take_up(part, slack);
    blocks.assign((edges.count - first + 15) / 16, {});
    side_changes.clear();
    if (const std::size_t room = 16 * blocks.size(); from_u.size() < room)
      for (auto* values : {&from_u, &from_v, &to_u, &to_v, &margin}) values->resize(2 * room);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const std::size_t i = first + 16 * b;
      clip(edges.lanes_from(i), bits(lanes_below<T>(edges.count - i)), b);
    }
    sort_along(side_changes);
  }

  int sides() const { return sides_; }
  glm::dvec2 vertex(int k) const { return {u_[k], v_[k]}; }
  /// The place where the walk along the sides begins.
  T begin_u() const { return inner_u_[0]; }
  T begin_v() const { return inner_v_[0]; }

  glm::dvec2 from(std::size_t i) const { return {from_u[i], from_v[i]}; }
  glm::dvec2 to(std::size_t i) const { return {to_u[i], to_v[i]}; }

private:
  void take_up(const LightPolygon<T>& part, T slack) {
    near_ = on_line<T> + slack;
    store(part.x, u_);
    store(part.y, v_);
    sides_ = part.count;
    u_[sides_] = u_[0], v_[sides_] = v_[0];
    T u = 0, v = 0;
    for (int k = 0; k < sides_; ++k) {
      u += u_[k];
      v += v_[k];
    }
    const T seam = 32 * near_;  // of the way to the middle
    for (int k = 0; k <= sides_; ++k) {
      inner_u_[k] = u_[k] - seam * (u_[k] - u / static_cast<T>(sides_));
      inner_v_[k] = v_[k] - seam * (v_[k] - v / static_cast<T>(sides_));
    }
  }

  HWY_NOINLINE void clip(const SilhouetteLanes<T>& e, std::uint32_t lanes, std::size_t b) {
    const Lanes zero = broadcast<Lanes>(0), one = broadcast<Lanes>(1),
                beside = doubt_beside(e.u, e.v, near_ - on_line<T>);
    const Lanes far_u = max(abs(e.from_u), abs(e.to_u)) + one, far_v = max(abs(e.from_v), abs(e.to_v)) + one;
    SilhouetteLanes<T> s = e;
    Lanes left = zero;  // sides that a ray from the lower end towards +u crosses: one from inside
    std::uint32_t unsure = 0, met = 0;
    Lanes here = value_at(e, inner_u_[0], inner_v_[0]);
    for (int k = 0; k < sides_; ++k) {
      const T u = inner_u_[k], v = inner_v_[k], next_v = inner_v_[k + 1], du = inner_u_[k + 1] - u,
              dv = next_v - v;
      const auto inside_of = [&](Lanes pu, Lanes pv) {
        return broadcast<Lanes>(du) * (pv - broadcast<Lanes>(v)) -
               broadcast<Lanes>(dv) * (pu - broadcast<Lanes>(u));
      };
      const Lanes next = value_at(e, inner_u_[k + 1], next_v);
      const Lanes f = inside_of(e.from_u, e.from_v), g = inside_of(e.to_u, e.to_v);
      const Lanes reach = broadcast<Lanes>(near_) *
                          (broadcast<Lanes>(std::abs(dv)) * far_u + broadcast<Lanes>(std::abs(du)) * far_v);
      const std::uint32_t crosses = lanes & bits(parted(here, next, beside) & parted(f, g, reach));
      unsure |= lanes & ~crosses & bits(maybe_parted(here, next, beside) & maybe_parted(f, g, reach));
      const auto rises =
          le(broadcast<Lanes>(v), e.from_v) & lt(e.from_v, broadcast<Lanes>(next_v)) & lt(zero, f);
      const auto falls =
          le(broadcast<Lanes>(next_v), e.from_v) & lt(e.from_v, broadcast<Lanes>(v)) & lt(f, zero);
      left = select(rises | falls, left + one, left);
      if (crosses != 0) end_at_side(k, e, crosses, crosses & lt_bits(f, zero), s);
      met |= crosses;
      here = next;
    }
    store(s.from_u, &from_u[16 * b]), store(s.from_v, &from_v[16 * b]);
    store(s.to_u, &to_u[16 * b]), store(s.to_v, &to_v[16 * b]);
    store(beside, &margin[16 * b]);
    blocks[b] = {(lanes & bits(eq(left, one))) | met | unsure, unsure};
  }

  static SIMD_INLINE Lanes value_at(const SilhouetteLanes<T>& e, T u, T v) {
    return e.u * broadcast<Lanes>(u) + e.v * broadcast<Lanes>(v) + e.w;
  }

  /// Lets the segments `crosses` begin (`enters`) or end at side k.
  SIMD_INLINE void end_at_side(int k, const SilhouetteLanes<T>& e, std::uint32_t crosses,
                               std::uint32_t enters, SilhouetteLanes<T>& segments) {
    const Lanes zero = broadcast<Lanes>(0), here = value_at(e, u_[k], v_[k]),
                next = value_at(e, u_[k + 1], v_[k + 1]);
    const Lanes share = min(max(here / (here - next), zero), broadcast<Lanes>(1));
    const Lanes u = broadcast<Lanes>(u_[k]) + share * broadcast<Lanes>(u_[k + 1] - u_[k]),
                v = broadcast<Lanes>(v_[k]) + share * broadcast<Lanes>(v_[k + 1] - v_[k]);
    const auto begins = mask_of_bits<T, 16>(enters), ends = mask_of_bits<T, 16>(crosses & ~enters);
    segments.from_u = select(begins, u, segments.from_u),
    segments.from_v = select(begins, v, segments.from_v);
    segments.to_u = select(ends, u, segments.to_u), segments.to_v = select(ends, v, segments.to_v);
    // Counter-clockwise, the side leads to the left of an edge that leaves the part.
    T shares[16], us[16], vs[16], changes[16];
    store(share, shares), store(u, us), store(v, vs);
    store(select(begins, zero - e.winding, e.winding), changes);
    for (; crosses != 0; crosses &= crosses - 1) {
      const int i = std::countr_zero(crosses);
      side_changes.push_back({k + static_cast<double>(shares[i]), {us[i], vs[i]}, changes[i]});
    }
  }

  T near_ = 0;  ///< what rounding can amount to, units of the light
  int sides_ = 0;
  T u_[polygon_capacity + 1], v_[polygon_capacity + 1];  ///< the part; its first vertex again
  T inner_u_[polygon_capacity + 1], inner_v_[polygon_capacity + 1];
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
