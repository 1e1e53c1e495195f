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
  return broadcast<Pack<T, 16>>(on_line<T> + slack) * (abs(u) + abs(v));
}

/// The edges that rays meet, from below (least v) to above, without gaps, one array per quantity.
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
  SIMD_INLINE void append(Mask<T, 16> chosen, const SilhouetteLanes<T>& edges, T slack) {
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
    const Lanes near = broadcast<Lanes>(2 * on_line<T> + slack);
    const Lanes bottom = broadcast<Lanes>(least_v) - near, top = broadcast<Lanes>(greatest_v) + near;
    count = 0;
    make_room(from.count);
    for (std::size_t i = 0; i < from.count; i += 16) {
      const auto chosen = lanes_below<T>(from.count - i) & le(load<Lanes>(&from.low[i]), top) &
                          le(bottom, load<Lanes>(&from.high[i]));
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
  const Lanes zero = broadcast<Lanes>(0), near = broadcast<Lanes>(on_line<T> + slack), over = at_v + near,
              under = at_v - near;
  Lanes sum = zero, doubt = zero;  // in registers: not yet in what is returned
  for (std::size_t i = 0; i < around.count; ++i) {
    const Lanes value = broadcast<Lanes>(around.u[i]) * at_u + broadcast<Lanes>(around.v[i]) * at_v +
                        broadcast<Lanes>(around.w[i]);
    const Lanes low = broadcast<Lanes>(around.low[i]), high = broadcast<Lanes>(around.high[i]),
                turns = broadcast<Lanes>(around.winding[i]);
    const auto other = ne(number, broadcast<Lanes>(around.number[i]));
    const auto met = other & le(low, at_v) & lt(at_v, high) & lt(zero, value);
    const auto near_it =
        other & le(low, over) & le(under, high) & lt(abs(value), broadcast<Lanes>(around.margin[i]));
    sum = select(met, sum + turns, sum);
    doubt = select(near_it, doubt + abs(turns), doubt);
  }
  return {sum, doubt};
}

/// The winding around one place; `doubtful` if rounding might change it.
template <class T>
HWY_NOINLINE T winding_around(const RayEdges<T>& around, T slack, T at_u, T at_v, bool& doubtful) {
  using Lanes = Pack<T, 16>;
  const Lanes zero = broadcast<Lanes>(T(0)), u = broadcast<Lanes>(at_u), v = broadcast<Lanes>(at_v),
              near = broadcast<Lanes>(on_line<T> + slack);
  Lanes sum = zero;
  std::uint32_t doubt = 0;
  for (std::size_t i = 0; i < around.count; i += 16) {
    const Lanes value =
        load<Lanes>(&around.u[i]) * u + load<Lanes>(&around.v[i]) * v + load<Lanes>(&around.w[i]);
    const Lanes low = load<Lanes>(&around.low[i]), high = load<Lanes>(&around.high[i]);
    const auto there = lanes_below<T>(around.count - i);
    const auto met = there & le(low, v) & lt(v, high) & lt(zero, value);
    sum = sum + select(met, load<Lanes>(&around.winding[i]), zero);
    doubt |=
        bits(there & le(low, v + near) & le(v - near, high) & lt(abs(value), load<Lanes>(&around.margin[i])));
  }
  doubtful = doubt != 0;
  return reduce_add(sum);  // of whole numbers: exact in any order
}

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
