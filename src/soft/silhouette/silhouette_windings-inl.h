// How often a silhouette winds around places of the light: by the edges that a ray towards +u crosses, and
// how much of that rounding might change. Included once per target.
#if defined(TENEBRA_SOFT_SILHOUETTE_WINDINGS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SILHOUETTE_WINDINGS_INL_H_
#undef TENEBRA_SOFT_SILHOUETTE_WINDINGS_INL_H_
#else
#define TENEBRA_SOFT_SILHOUETTE_WINDINGS_INL_H_
#endif

#include <utility>

#include "soft/polygon/light_polygon-inl.h"
#include "soft/silhouette/silhouette_edges-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// Nearer to an edge than this, in the measure of its line, rounding might decide on which side a place on
/// the light is. `slack`: what rounding the corners can amount to, units of the light.
template <class T>
SIMD_INLINE Pack<T, 16> doubt_beside(Pack<T, 16> u, Pack<T, 16> v, T slack) {
  return splat<Pack<T, 16>>(on_line<T> + slack) * (absolute(u) + absolute(v));
}

/// The edges that rays meet, from below (least v) to above, without gaps, one array a quantity.
template <class T>
struct RayEdges {
  using Lanes = Pack<T, 16>;
  std::vector<T> u, v, w, low, high, winding, number, margin;
  std::size_t count = 0;

  /// Room for `more` edges and a full register behind them.
  void make_room(std::size_t more) {
    const std::size_t needed = count + more + 16;
    if (u.size() >= needed) return;
    for (auto* values : {&u, &v, &w, &low, &high, &winding, &number, &margin}) values->resize(2 * needed);
  }
  /// Appends the edges where `chosen`; there is room.
  SIMD_INLINE void append(Truth<T, 16> chosen, const SilhouetteLanes<T>& edges, T slack) {
    compress(chosen, edges.u, &u[count]);
    compress(chosen, edges.v, &v[count]);
    compress(chosen, edges.w, &w[count]);
    compress(chosen, edges.from_v, &low[count]);
    compress(chosen, edges.to_v, &high[count]);
    compress(chosen, edges.winding, &winding[count]);
    compress(chosen, edges.number, &number[count]);
    count += compress(chosen, doubt_beside(edges.u, edges.v, slack), &margin[count]);
  }
  /// Takes those of `from` that rays from places between the two heights may meet.
  HWY_NOINLINE void take(const RayEdges& from, T least_v, T greatest_v, T slack) {
    const Lanes near = splat<Lanes>(2 * on_line<T> + slack);
    const Lanes bottom = splat<Lanes>(least_v) - near, top = splat<Lanes>(greatest_v) + near;
    count = 0;
    make_room(from.count);
    for (std::size_t i = 0; i < from.count; i += 16) {
      const auto chosen = lanes_below<T>(from.count - i) & not_above(load<Lanes>(&from.low[i]), top) &
                          not_above(bottom, load<Lanes>(&from.high[i]));
      for (const auto& [to, values] : {std::pair(&u, &from.u), std::pair(&v, &from.v), std::pair(&w, &from.w),
                                       std::pair(&low, &from.low), std::pair(&high, &from.high),
                                       std::pair(&winding, &from.winding), std::pair(&number, &from.number)})
        compress(chosen, load<Lanes>(&(*values)[i]), &(*to)[count]);
      count += compress(chosen, load<Lanes>(&from.margin[i]), &margin[count]);
    }
  }
};

/// Windings of places, and by how much rounding might change them.
template <class T>
struct Windings {
  Pack<T, 16> winding, doubt;
};

/// Windings just to the right of places on the edges of these numbers: the ray begins on the edge.
template <class T>
HWY_NOINLINE Windings<T> windings_right_of(const RayEdges<T>& around, T slack, Pack<T, 16> number,
                                           Pack<T, 16> at_u, Pack<T, 16> at_v) {
  using Lanes = Pack<T, 16>;
  const auto num = [](T value) { return splat<Lanes>(value); };
  const Lanes zero = num(0), near = num(on_line<T> + slack), over = at_v + near, under = at_v - near;
  Lanes sum = zero, doubt = zero;  // in registers: not yet in what is returned
  for (std::size_t i = 0; i < around.count; ++i) {
    const Lanes value = num(around.u[i]) * at_u + num(around.v[i]) * at_v + num(around.w[i]);
    const Lanes low = num(around.low[i]), high = num(around.high[i]), turns = num(around.winding[i]);
    const auto other = unequal(number, num(around.number[i]));
    const auto met = other & not_above(low, at_v) & less(at_v, high) & less(zero, value);
    const auto near_it =
        other & not_above(low, over) & not_above(under, high) & less(absolute(value), num(around.margin[i]));
    sum = choose(met, sum + turns, sum);
    doubt = choose(near_it, doubt + absolute(turns), doubt);
  }
  return {sum, doubt};
}

/// The winding around one place; `doubtful` if rounding might change it.
template <class T>
HWY_NOINLINE T winding_around(const RayEdges<T>& around, T slack, T at_u, T at_v, bool& doubtful) {
  using Lanes = Pack<T, 16>;
  const Lanes zero = splat<Lanes>(T(0)), u = splat<Lanes>(at_u), v = splat<Lanes>(at_v),
              near = splat<Lanes>(on_line<T> + slack);
  Lanes sum = zero;
  std::uint32_t doubt = 0;
  for (std::size_t i = 0; i < around.count; i += 16) {
    const Lanes value =
        load<Lanes>(&around.u[i]) * u + load<Lanes>(&around.v[i]) * v + load<Lanes>(&around.w[i]);
    const Lanes low = load<Lanes>(&around.low[i]), high = load<Lanes>(&around.high[i]);
    const auto there = lanes_below<T>(around.count - i);
    const auto met = there & not_above(low, v) & less(v, high) & less(zero, value);
    sum = sum + choose(met, load<Lanes>(&around.winding[i]), zero);
    doubt |= bits(there & not_above(low, v + near) & not_above(v - near, high) &
                  less(absolute(value), load<Lanes>(&around.margin[i])));
  }
  doubtful = doubt != 0;
  return total(sum);  // of whole numbers: exact in any order
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
