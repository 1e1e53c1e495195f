// Which edges of an outline need no cut: those with shadow on both sides all along. Included once per target.
#if defined(TENEBRA_SOFT_INNER_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_INNER_EDGES_INL_H_
#undef TENEBRA_SOFT_INNER_EDGES_INL_H_
#else
#define TENEBRA_SOFT_INNER_EDGES_INL_H_
#endif

#include "soft/light_polygon-inl.h"
#include "soft/outline_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

/// The part of edges on the light.
template <class T>
struct LightSegments {
  using Lanes = Pack<T, 16>;
  Lanes u0, v0, u1, v1;
  Truth<T, 16> there;
};

template <class T>
HWY_INLINE LightSegments<T> clipped_to_light(const OutlineLanes<T>& e) {
  using Lanes = Pack<T, 16>;
  const Lanes zero = splat<Lanes>(T(0)), one = splat<Lanes>(T(1));
  const Lanes du = e.to_u - e.from_u, dv = e.to_v - e.from_v;
  Lanes low = zero, high = one;
  const auto clip = [&](Lanes from, Lanes along) {  // to from + t along <= 1
    const Lanes t = (one - from) / choose(equal(along, zero), one, along);
    high = choose(less(zero, along), min(high, t), high);
    low = choose(less(along, zero), max(low, t), low);
  };
  clip(e.from_u, du), clip(zero - e.from_u, zero - du), clip(e.from_v, dv), clip(zero - e.from_v, zero - dv);
  // Ends that are not clipped stay as they are: others may share them.
  const auto at = [&](Lanes t, Lanes from, Lanes along, Lanes to) {
    return choose(less(zero, t), choose(less(t, one), from + t * along, to), from);
  };
  return {at(low, e.from_u, du, e.to_u), at(low, e.from_v, dv, e.to_v), at(high, e.from_u, du, e.to_u),
          at(high, e.from_v, dv, e.to_v), less(low, high)};
}

/// Windings just to the right of places on edges, which the ray towards +u begins on; bits of those that
/// are sure.
template <class T>
HWY_NOINLINE std::uint32_t windings_right_of(const OutlineEdges<T>& around, T slack, const OutlineLanes<T>& e,
                                             Pack<T, 16> mu, Pack<T, 16> mv, Pack<T, 16>& winding) {
  using Lanes = Pack<T, 16>;
  const auto num = [](T value) { return splat<Lanes>(value); };
  const Lanes zero = num(0);
  winding = zero;
  Lanes doubt = zero;
  for (std::size_t i = 0; i < around.count; ++i) {
    const T u = around.u[i], v = around.v[i];
    const Lanes value = num(u) * mu + num(v) * mv + num(around.w[i]);
    const Lanes from = num(around.from_v[i]), to = num(around.to_v[i]), turns = num(around.winding[i]);
    const auto rises = not_above(from, mv) & less(mv, to), falls = not_above(to, mv) & less(mv, from);
    const Lanes gained = choose(rises & less(zero, value), turns, zero),
                lost = choose(falls & less(value, zero), turns, zero);
    const auto itself = equal(e.number, num(around.number[i]));
    const auto size = [](T a) { return HWY_MAX(a, -a); };
    const T margin = on_line<T> * (size(u) + size(v)) + slack * size(v);
    winding = choose(itself, winding, winding + gained - lost);
    doubt =
        choose(itself, doubt, choose((rises | falls) & less(absolute(value), num(margin)), num(1), doubt));
  }
  const auto level = not_above(max(e.from_v, e.to_v), mv) | less(mv, min(e.from_v, e.to_v));
  return ~(less_bits(zero, doubt) | bits(level));
}

/// What the crossing edges can take from the winding on the way along edges from the middle of their part
/// on the light to its ends, at most. An edge that shares a corner, as it does itself, does not count:
/// should it run along the way for a while, then where it ends, another one leaves it there and counts.
template <class T>
HWY_NOINLINE Pack<T, 16> lost_along(const OutlineEdges<T>& crossing, const OutlineLanes<T>& e,
                                    const LightSegments<T>& on) {
  using Lanes = Pack<T, 16>;
  const auto num = [](T value) { return splat<Lanes>(value); };
  const Lanes zero = num(0), near = num(4 * on_line<T>);
  Lanes lost = zero;
  for (std::size_t i = 0; i < crossing.count; ++i) {
    const T u = crossing.u[i], v = crossing.v[i], turns = crossing.winding[i];
    const auto size = [](T a) { return HWY_MAX(a, -a); };
    const Lanes margin = num(8 * on_line<T> * (size(u) + size(v)));
    const Lanes a = num(u) * on.u0 + num(v) * on.v0 + num(crossing.w[i]);
    const Lanes b = num(u) * on.u1 + num(v) * on.v1 + num(crossing.w[i]);
    const Lanes fu = num(crossing.from_u[i]), fv = num(crossing.from_v[i]);
    const Lanes tu = num(crossing.to_u[i]), tv = num(crossing.to_v[i]);
    const Lanes from = e.u * fu + e.v * fv + e.w, to = e.u * tu + e.v * tv + e.w;
    const Lanes reach = near * (absolute(e.u) * max(absolute(fu), absolute(tu)) +
                                absolute(e.v) * max(absolute(fv), absolute(tv)) + absolute(e.w));
    const auto same = [](Lanes u0, Lanes v0, Lanes u1, Lanes v1) { return equal(u0, u1) & equal(v0, v1); };
    const auto shared = same(e.from_u, e.from_v, fu, fv) | same(e.from_u, e.from_v, tu, tv) |
                        same(e.to_u, e.to_v, fu, fv) | same(e.to_u, e.to_v, tu, tv);
    const auto apart = less(margin, min(a, b)) | less(max(a, b), zero - margin) | less(reach, min(from, to)) |
                       less(max(from, to), zero - reach) | shared;
    // It takes from the side that it winds around: the left one for positive turns.
    const Lanes middle = a + b, twice = margin + margin;
    const auto loses = turns > 0 ? less(zero - twice, middle) : less(middle, twice);
    lost = lost + choose(apart, zero, choose(loses, num(size(turns)), zero));
  }
  return lost;
}

/// Bits of the edges where the lesser winding beside their middle, less what others can take from it on the
/// way to the ends, is above zero, and of those that do not reach the light. 0 where rounding might decide.
template <class T>
std::uint32_t inner_edges(const OutlineEdges<T>& around, const OutlineEdges<T>& crossing, T slack,
                          const OutlineLanes<T>& e) {
  using Lanes = Pack<T, 16>;
  const Lanes zero = splat<Lanes>(T(0)), half = splat<Lanes>(T(0.5));
  const LightSegments<T> on = clipped_to_light(e);
  const std::uint32_t beyond = ~bits(on.there);
  const Lanes mu = (on.u0 + on.u1) * half, mv = (on.v0 + on.v1) * half;
  Lanes right = zero;
  const std::uint32_t sure = windings_right_of(around, slack, e, mu, mv, right);
  const Lanes left = right + choose(less(e.from_v, e.to_v), e.winding, zero - e.winding);
  const Lanes lesser = min(left, right);
  const std::uint32_t dark = sure & less_bits(zero, lesser);
  return dark == 0 ? beyond : beyond | (dark & less_bits(lost_along(crossing, e, on), lesser));
}

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
