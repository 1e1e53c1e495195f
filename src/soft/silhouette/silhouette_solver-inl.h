// The visible part of the light from the silhouette of meshes: its boundary (silhouette_boundary-inl.h), for
// parts with many edges strip by strip. Where rounding might decide, or a horizon is to cut what is found,
// the light is cut along the edges that cross it, and a part that no edge crosses any more is visible if the
// silhouette winds around it zero times. Included once per target.
#if defined(TENEBRA_SOFT_SILHOUETTE_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SILHOUETTE_SOLVER_INL_H_
#undef TENEBRA_SOFT_SILHOUETTE_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_SILHOUETTE_SOLVER_INL_H_
#endif

#include <algorithm>
#include <utility>
#include <vector>

#include "soft/occluders/occluder_blocks-inl.h"
#include "soft/polygon/light_fragments-inl.h"
#include "soft/silhouette/group_silhouette.h"
#include "soft/silhouette/silhouette_boundary-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class SilhouetteSolver {
public:
  void reset(const GroupSilhouette& silhouette) {
    silhouette_ = &silhouette;
    moving_.resize((silhouette.edges.size() + 15) / 16);
    at_point_.resize(moving_.size());
    for (std::size_t i = 0; i < 16 * moving_.size(); ++i) fill(i);
  }

  /// The next queries are about this point.
  HWY_NOINLINE void move_to(const GroupPoint& at) {
    slack_ = static_cast<T>(0x1p-32 * (4 + 2 * std::abs(at.in_light.y)));
    for (std::size_t b = 0; b < moving_.size(); ++b) move_block(at, b);
    add_sometimes(at);
    around_.count = crossing_.count = 0;
    around_.make_room(at_point_.size() * 16);
    crossing_.make_room(at_point_.size() * 16);
    for (std::size_t b = 0; b < at_point_.size(); ++b) gather(at_point_[b], static_cast<T>(16 * b));
    crossing_light_ = crossing_.count;
  }

  /// Finds the part of `light` (convex, within |u|, |v| <= 1) visible from the point: adds its boundary to
  /// `boundary`, counter-clockwise; or, where rounding might decide, or if `boundary` is null, convex parts
  /// to `out`.
  HWY_NOINLINE void query(const LightPolygon<T>& light, LightEdges* boundary, FragmentList<T>& out) {
    const std::size_t first = crossing_light_;
    crossing_.make_room(first);
    keep_crossing(0, first, light, {0, 0, 1}, T(1), first);
    find(light, first, boundary, out);
  }

private:
  using Lanes = Pack<T, 16>;
  static constexpr std::size_t several =
      4;  ///< edges; cutting along fewer is quicker than looking for their boundary
  static constexpr std::size_t many =
      64;  ///< edges; the time for a boundary grows with the square of their number
  struct MovingBlock {
    double from[3][16], to[3][16];  ///< coordinate, edge
    double winding[16];
  };
  /// Sixteen edges at the point: their lines, ends, and windings.
  struct Block {
    T u[16], v[16], w[16], from_u[16], from_v[16], to_u[16], to_v[16], winding[16];
  };
  void fill(std::size_t i) {
    MovingBlock& block = moving_[i / 16];
    const std::size_t k = i % 16;
    const SilhouetteEdge none{glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1), 0};
    const SilhouetteEdge& edge = i < silhouette_->edges.size() ? silhouette_->edges[i] : none;
    for (int c = 0; c < 3; ++c) {
      block.from[c][k] = edge.from[c];
      block.to[c][k] = edge.to[c];
    }
    block.winding[k] = edge.winding;
  }

  /// u and v where the line from the point along `way` meets the light's plane.
  static SIMD_INLINE void project(const GroupPoint& at, const Pack3<Wide>& way, T* u, T* v) {
    const Wide t = wide(at.reach) / way.z;
    store_narrowed(wide(at.in_light.x) + way.x * t, u);
    store_narrowed(wide(at.in_light.y) + way.y * t, v);
  }

  /// Lines are positive to the left of the way from `from` to `to`.
  SIMD_INLINE void move_block(const GroupPoint& at, std::size_t b) {
    const MovingBlock& block = moving_[b];
    Block& to = at_point_[b];
    const Wide x = wide(at.in_axes.x), y = wide(at.in_axes.y), z = wide(at.in_axes.z);
    const auto way = [&](const double(&end)[3][16]) {
      return Pack3<Wide>{load<Wide>(end[0]) - x, load<Wide>(end[1]) - y, load<Wide>(end[2]) - z};
    };
    const Pack3<Wide> a = way(block.from), b_way = way(block.to);
    const Pack3<Wide> n = cross(a, b_way - a);
    store_narrowed(n.x, to.u);
    store_narrowed(n.y, to.v);
    store_narrowed(n.z * wide(at.reach) - n.x * wide(at.in_light.x) - n.y * wide(at.in_light.y), to.w);
    project(at, a, to.from_u, to.from_v);
    project(at, b_way, to.to_u, to.to_v);
    store_narrowed(load<Wide>(block.winding), to.winding);
  }

  void add_sometimes(const GroupPoint& at) {
    signs_.clear();
    for (const SometimesBlocker& blocker : silhouette_->sometimes) {
      const bool itself = blocker.triangle == at.receiver;
      signs_.push_back(itself ? 0 : blocking_sign(blocker.plane, at.from_centre, at.receiver_tau));
    }
    for (const SilhouetteUse& use : silhouette_->uses) {
      at_point_[use.edge / 16].winding[use.edge % 16] += static_cast<T>(signs_[use.blocker] * use.winding);
    }
  }

  /// Adds the block's edges to those around the light that count, and to those that may cross the square
  /// around it; all turned to rise in v.
  SIMD_INLINE void gather(const Block& block, T first) {
    const Lanes zero = broadcast<Lanes>(T(0)), one = broadcast<Lanes>(T(1)), minus = broadcast<Lanes>(T(-1));
    const Lanes u = load<Lanes>(block.u), v = load<Lanes>(block.v), w = load<Lanes>(block.w);
    const Lanes u0 = load<Lanes>(block.from_u), u1 = load<Lanes>(block.to_u);
    const Lanes v0 = load<Lanes>(block.from_v), v1 = load<Lanes>(block.to_v);
    const Lanes winding = load<Lanes>(block.winding);
    const auto counts =
        lt(zero, abs(winding)) & lt(minus, max(u0, u1)) & lt(min(v0, v1), one) & lt(minus, max(v0, v1));
    if (!any(counts)) return;
    const auto falls = lt(v1, v0);
    const auto turned = [&](Lanes value) { return select(falls, zero - value, value); };
    const SilhouetteLanes<T> edges{turned(u),
                                   turned(v),
                                   turned(w),
                                   select(falls, u1, u0),
                                   min(v0, v1),
                                   select(falls, u0, u1),
                                   max(v0, v1),
                                   turned(winding),
                                   counted_lanes<T>() + broadcast<Lanes>(first)};
    around_.append(counts, edges, slack_);
    crossing_.append(counts & lt(min(u0, u1), one) & lt(abs(w), abs(u) + abs(v)), edges);
  }

  /// Solves a part that the crossing edges from `first` on may cross; forgets those.
  void find(const LightPolygon<T>& part, std::size_t first, LightEdges* boundary, FragmentList<T>& out) {
    const std::size_t count = crossing_.count - first;
    if (boundary != nullptr && count > many && reduce_max(part.y) - reduce_min(part.y) > T(1) / 16)
      return find_in_halves(part, first, boundary, out);
    if (count >= (boundary != nullptr ? 1 : several) && count <= many) {
      boundary_.look_at(around_, crossing_, first, slack_, part);
      if (boundary != nullptr && boundary_.append_to(*boundary)) {
        crossing_.count = first;
        return;
      }
      keep_bounding(first);
    }
    branch(part, first, out);
  }

  /// In two strips, one above the other: a ray towards +u then meets fewer edges, and each edge fewer others.
  void find_in_halves(const LightPolygon<T>& part, std::size_t first, LightEdges* boundary,
                      FragmentList<T>& out) {
    const LightLine<T> line{0, 1, (reduce_max(part.y) + reduce_min(part.y)) / -2};
    const LineValues<T> values = evaluate(part, line);
    LightPolygon<T> above, below;
    split(part, values, above, below);
    const std::size_t last = crossing_.count;
    crossing_.make_room(last - first);
    keep_crossing(first, last, above, line, T(1), last);
    find(above, last, boundary, out);
    keep_crossing(first, last, below, line, T(-1), first);
    find(below, first, boundary, out);
  }

  /// Forgets the crossing edges from `first` on without light beside them.
  void keep_bounding(std::size_t first) {
    const std::size_t last = std::exchange(crossing_.count, first);
    for (std::size_t i = first; i < last; i += 16)
      crossing_.append(mask_of_bits<T, 16>(boundary_.kept((i - first) / 16)), crossing_.lanes_from(i));
  }

  /// Cuts `part` along the crossing edges from `first` on, and forgets those.
  void solve(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    LightPolygon<T> rest = part;
    while (crossing_.count > first) {
      const std::size_t middle = first + (crossing_.count - first) / 2;
      const LightLine<T> line{crossing_.u[middle], crossing_.v[middle], crossing_.w[middle]};
      crossing_.drop(middle);
      const LineValues<T> values = evaluate(rest, line);
      if (values.positive == 0 || values.negative == 0) continue;
      LightPolygon<T> left;
      split(rest, values, left, rest);
      const std::size_t last = crossing_.count;
      crossing_.make_room(last - first);
      keep_crossing(first, last, left, line, T(1), last);
      branch(left, last, out);
      keep_crossing(first, last, rest, line, T(-1), first);
      if (rest.count > fragment_capacity) return branch(rest, first, out);
    }
    if (winding_of(rest) == T(0)) out.push(rest);
  }

  /// Solves a polygon of any size.
  void branch(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    if (part.count <= fragment_capacity) return solve(part, first, out);
    solve_halves(part, first, out);
  }
  HWY_NOINLINE void solve_halves(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    LightPolygon<T> low, high;
    halve(part, low, high);
    const std::size_t last = crossing_.count;
    crossing_.copy(first, last);
    solve(low, last, out);
    solve(high, first, out);
  }

  /// Writes those of the crossing edges [first, last) that may cross `part`, which lies on the side `sign` of
  /// `line`, to `to` (first or last), and forgets what lies behind.
  HWY_NOINLINE void keep_crossing(std::size_t first, std::size_t last, const LightPolygon<T>& part,
                                  const LightLine<T>& line, T sign, std::size_t to) {
    const T low_u = reduce_min(part.x), high_u = reduce_max(part.x), low_v = reduce_min(part.y),
            high_v = reduce_max(part.y);
    const Lanes cu = broadcast<Lanes>((low_u + high_u) / 2), cv = broadcast<Lanes>((low_v + high_v) / 2);
    const Lanes hu = broadcast<Lanes>((high_u - low_u) / 2), hv = broadcast<Lanes>((high_v - low_v) / 2);
    const Lanes lu = broadcast<Lanes>(sign * line.u), lv = broadcast<Lanes>(sign * line.v),
                lw = broadcast<Lanes>(sign * line.w);
    const auto beyond = [&](Lanes u, Lanes v) {
      const Lanes a = lu * u, b = lv * v;
      return lt(broadcast<Lanes>(on_line<T>) * (abs(a) + abs(b) + abs(lw)), a + b + lw);
    };
    crossing_.count = to;
    for (std::size_t i = first; i < last; i += 16) {
      const SilhouetteLanes<T> e = crossing_.lanes_from(i);
      const auto meets = lanes_below<T>(last - i) & le(min(e.from_u, e.to_u), broadcast<Lanes>(high_u)) &
                         le(broadcast<Lanes>(low_u), max(e.from_u, e.to_u)) &
                         le(min(e.from_v, e.to_v), broadcast<Lanes>(high_v)) &
                         le(broadcast<Lanes>(low_v), max(e.from_v, e.to_v));
      const auto crosses = le(abs(e.u * cu + e.v * cv + e.w), abs(e.u) * hu + abs(e.v) * hv);
      crossing_.append(meets & crosses & (beyond(e.from_u, e.from_v) | beyond(e.to_u, e.to_v)), e);
    }
  }

  /// How many triangles cover a part of the light that no edge crosses. Rounding can decide only if an edge
  /// is within rounding of the part's middle, and so only if the part is no wider than that.
  T winding_of(const LightPolygon<T>& part) const {
    T x[polygon_capacity], y[polygon_capacity];
    store(part.x, x);
    store(part.y, y);
    T u = 0, v = 0;
    for (int k = 0; k < part.count; ++k) {
      u += x[k];
      v += y[k];
    }
    const T count = static_cast<T>(part.count);
    bool doubtful = false;
    return winding_around(around_, slack_, u / count, v / count, doubtful);
  }

  const GroupSilhouette* silhouette_ = nullptr;
  std::vector<MovingBlock> moving_;
  std::vector<Block> at_point_;
  RayEdges<T> around_;           ///< edges that a ray from the light towards +u may cross
  SilhouetteEdges<T> crossing_;  ///< edges that may cross the light; behind them, those of the parts at hand
  std::size_t crossing_light_ = 0;
  SilhouetteBoundary<T> boundary_;
  std::vector<int> signs_;  ///< one for each SometimesBlocker
  T slack_ = 0;             ///< what rounding the corners can amount to, units of the light
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
