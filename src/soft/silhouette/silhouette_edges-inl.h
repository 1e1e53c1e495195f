// Edges of a silhouette as a point sees them on the light's plane. Included once per target.
#if defined(TENEBRA_SOFT_SILHOUETTE_EDGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SILHOUETTE_EDGES_INL_H_
#undef TENEBRA_SOFT_SILHOUETTE_EDGES_INL_H_
#else
#define TENEBRA_SOFT_SILHOUETTE_EDGES_INL_H_
#endif

#include <algorithm>
#include <vector>

#include "soft/polygon/light_polygon-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// An edge in each lane.
template <class T>
struct SilhouetteLanes {
  Pack<T, 16> u, v, w, from_u, from_v, to_u, to_v, winding, number;
};

/// Edges without gaps, one array per quantity.
template <class T>
struct SilhouetteEdges {
  std::vector<T> u, v, w, from_u, from_v, to_u, to_v, winding, number;
  std::size_t count = 0;

  /// Room for `more` edges and a full register behind them.
  void make_room(std::size_t more) {
    const std::size_t needed = count + more + 16;
    if (u.size() >= needed) return;
    for (auto* values : {&u, &v, &w, &from_u, &from_v, &to_u, &to_v, &winding, &number})
      values->resize(2 * needed);
  }
  void copy(std::size_t first, std::size_t last) {
    make_room(last - first);
    for (auto* values : {&u, &v, &w, &from_u, &from_v, &to_u, &to_v, &winding, &number})
      std::copy(&(*values)[first], &(*values)[last], &(*values)[count]);
    count += last - first;
  }
  void drop(std::size_t place) {
    --count;
    for (auto* values : {&u, &v, &w, &from_u, &from_v, &to_u, &to_v, &winding, &number})
      (*values)[place] = (*values)[count];
  }
  /// Appends the edges where `chosen`; there is room.
  SIMD_INLINE void append(Mask<T, 16> chosen, const SilhouetteLanes<T>& edges) {
    compress(chosen, edges.u, &u[count]);
    compress(chosen, edges.v, &v[count]);
    compress(chosen, edges.w, &w[count]);
    compress(chosen, edges.from_u, &from_u[count]);
    compress(chosen, edges.from_v, &from_v[count]);
    compress(chosen, edges.to_u, &to_u[count]);
    compress(chosen, edges.winding, &winding[count]);
    compress(chosen, edges.number, &number[count]);
    count += compress(chosen, edges.to_v, &to_v[count]);
  }
  /// Sixteen from place i on.
  SIMD_INLINE SilhouetteLanes<T> lanes_from(std::size_t i) const {
    return {load<Pack<T, 16>>(&u[i]),      load<Pack<T, 16>>(&v[i]),       load<Pack<T, 16>>(&w[i]),
            load<Pack<T, 16>>(&from_u[i]), load<Pack<T, 16>>(&from_v[i]),  load<Pack<T, 16>>(&to_u[i]),
            load<Pack<T, 16>>(&to_v[i]),   load<Pack<T, 16>>(&winding[i]), load<Pack<T, 16>>(&number[i])};
  }
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
