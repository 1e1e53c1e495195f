// The visible part of the light from the outline of meshes: it is cut along the edges that cross it, and a
// part that no edge crosses any more is visible if the outline winds around it zero times. Included once per
// target.
#if defined(TENEBRA_SOFT_OUTLINE_SOLVER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_OUTLINE_SOLVER_INL_H_
#undef TENEBRA_SOFT_OUTLINE_SOLVER_INL_H_
#else
#define TENEBRA_SOFT_OUTLINE_SOLVER_INL_H_
#endif

#include <algorithm>
#include <vector>

#include "soft/clip_candidates-inl.h"
#include "soft/group_outline.h"
#include "soft/light_fragments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

template <class T>
class OutlineSolver {
public:
  void reset(const GroupOutline& outline) {
    outline_ = &outline;
    moving_.resize((outline.edges.size() + 15) / 16);
    at_point_.resize(moving_.size());
    for (std::size_t i = 0; i < 16 * moving_.size(); ++i) fill(i);
  }

  /// The next queries are about this point.
  HWY_NOINLINE void move_to(const GroupPoint& at) {
    for (std::size_t b = 0; b < moving_.size(); ++b) move_block(at, b);
    add_sometimes(at);
    segments_.clear();
    for (std::size_t b = 0; b < moving_.size(); ++b) find_segments(at_point_[b]);
    slack_ = static_cast<T>(0x1p-32 * (4 + 2 * std::abs(at.in_light.y)));
  }

  /// Appends the parts of `light` (convex, within |u|, |v| <= 1) visible from the point to `out`.
  HWY_NOINLINE void query(const LightPolygon<T>& light, FragmentList<T>& out) {
    list_.clear();
    for (std::uint32_t i = 0; i < segments_.size(); ++i) list_.push_back(i);
    solve(light, 0, out);
  }

private:
  using Wide = Pack<double, 16>;
  using Lanes = Pack<T, 16>;
  struct MovingBlock {
    double c[4][3][16];  ///< power of the point, coefficient, edge
    double from[3][16], to[3][16];
    double winding[16];
  };
  struct Block {
    T u[16], v[16], w[16], from_u[16], from_v[16], to_u[16], to_v[16], winding[16];
  };
  /// An edge that may cross the light.
  struct Segment {
    LightLine<T> line;
    T from_u, from_v, to_u, to_v;
  };

  void fill(std::size_t i) {
    MovingBlock& block = moving_[i / 16];
    const std::size_t k = i % 16;
    const OutlineEdge none{{{glm::dvec3(0, 0, 1)}}, glm::dvec3(0, 0, 1), glm::dvec3(0, 0, 1), 0};
    const OutlineEdge& edge = i < outline_->edges.size() ? outline_->edges[i] : none;
    for (int c = 0; c < 3; ++c) {
      for (int power = 0; power < 4; ++power) block.c[power][c][k] = edge.line.c[power][c];
      block.from[c][k] = edge.from[c];
      block.to[c][k] = edge.to[c];
    }
    block.winding[k] = edge.winding;
  }

  /// u and v where the line from the point through corners meets the light's plane.
  static HWY_INLINE void project(const GroupPoint& at, const double (*corner)[16], T* u, T* v) {
    const Wide pu = splat<Wide>(at.in_light.x), pv = splat<Wide>(at.in_light.y);
    const Wide t =
        splat<Wide>(at.light_height - at.in_light.z) / (load<Wide>(corner[2]) - splat<Wide>(at.in_light.z));
    store(narrowed<T>(pu + (load<Wide>(corner[0]) - pu) * t), u);
    store(narrowed<T>(pv + (load<Wide>(corner[1]) - pv) * t), v);
  }

  HWY_INLINE void move_block(const GroupPoint& at, std::size_t b) {
    const MovingBlock& from = moving_[b];
    Block& to = at_point_[b];
    const Wide x = splat<Wide>(at.from_centre.x), y = splat<Wide>(at.from_centre.y),
               z = splat<Wide>(at.from_centre.z);
    T* lines[3] = {to.u, to.v, to.w};
    for (int i = 0; i < 3; ++i) {
      store(narrowed<T>(load<Wide>(from.c[0][i]) + x * load<Wide>(from.c[1][i]) +
                        y * load<Wide>(from.c[2][i]) + z * load<Wide>(from.c[3][i])),
            lines[i]);
    }
    project(at, from.from, to.from_u, to.from_v);
    project(at, from.to, to.to_u, to.to_v);
    store(narrowed<T>(load<Wide>(from.winding)), to.winding);
  }

  void add_sometimes(const GroupPoint& at) {
    signs_.clear();
    for (const SometimesBlocker& blocker : outline_->sometimes) {
      const bool itself = blocker.triangle == at.receiver;
      signs_.push_back(itself ? 0 : blocking_sign(blocker.plane, at.from_centre, at.receiver_tau));
    }
    for (const OutlineUse& use : outline_->uses) {
      at_point_[use.edge / 16].winding[use.edge % 16] += static_cast<T>(signs_[use.blocker] * use.winding);
    }
  }

  /// The block's edges whose shadows may cross the square around the light.
  HWY_INLINE void find_segments(const Block& block) {
    const Lanes zero = splat<Lanes>(T(0)), one = splat<Lanes>(T(1)), minus = splat<Lanes>(T(-1));
    const Lanes u0 = load<Lanes>(block.from_u), u1 = load<Lanes>(block.to_u);
    const Lanes v0 = load<Lanes>(block.from_v), v1 = load<Lanes>(block.to_v);
    const Lanes radius = absolute(load<Lanes>(block.u)) + absolute(load<Lanes>(block.v));
    std::uint32_t meeting = less_bits(min(u0, u1), one) & less_bits(minus, max(u0, u1)) &
                            less_bits(min(v0, v1), one) & less_bits(minus, max(v0, v1)) &
                            less_bits(absolute(load<Lanes>(block.w)), radius) &
                            less_bits(zero, absolute(load<Lanes>(block.winding)));
    for (; meeting != 0; meeting &= meeting - 1) {
      const int k = std::countr_zero(meeting);
      segments_.push_back({{block.u[k], block.v[k], block.w[k]},
                           block.from_u[k],
                           block.from_v[k],
                           block.to_u[k],
                           block.to_v[k]});
    }
  }

  /// Cuts `part` along list_[first..), and forgets those.
  void solve(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    LightPolygon<T> rest = part;
    while (list_.size() > first) {
      const std::size_t middle = first + (list_.size() - first) / 2;
      const Segment segment = segments_[list_[middle]];
      list_[middle] = list_.back();
      list_.pop_back();
      const LineValues<T> values = evaluate(rest, segment.line);
      if (values.positive == 0 || values.negative == 0) continue;
      LightPolygon<T> left, right;
      split(rest, values, left, right);
      const std::size_t last = list_.size();
      reaching(first, last, left, segment.line, T(1));
      branch(left, last, out);
      rest = right;
      const std::size_t from = list_.size();
      reaching(first, last, right, segment.line, T(-1));
      list_.erase(list_.begin() + static_cast<std::ptrdiff_t>(first),
                  list_.begin() + static_cast<std::ptrdiff_t>(from));
      if (rest.count > fragment_capacity) {
        branch(rest, first, out);
        return;
      }
    }
    if (winding_around(rest) == T(0)) out.push(rest);
  }

  /// The same for a polygon of any size.
  void branch(const LightPolygon<T>& part, std::size_t first, FragmentList<T>& out) {
    if (part.count <= fragment_capacity) return solve(part, first, out);
    LightPolygon<T> low, high;
    halve(part, low, high);
    const std::size_t last = list_.size();
    for (std::size_t i = first; i < last; ++i) list_.push_back(list_[i]);
    solve(low, last, out);
    solve(high, first, out);
  }

  /// Appends those of list_[first..last) that may cross `part`, which lies on the side `sign` of `line`.
  HWY_NOINLINE void reaching(std::size_t first, std::size_t last, const LightPolygon<T>& part,
                             const LightLine<T>& line, T sign) {
    const T low_u = least(part.x), high_u = greatest(part.x), low_v = least(part.y),
            high_v = greatest(part.y);
    const T cu = (low_u + high_u) / 2, cv = (low_v + high_v) / 2, hu = high_u - cu, hv = high_v - cv;
    const auto size = [](T a) { return a < 0 ? -a : a; };
    for (std::size_t i = first; i < last; ++i) {
      const Segment& s = segments_[list_[i]];
      if (HWY_MIN(s.from_u, s.to_u) > high_u || HWY_MAX(s.from_u, s.to_u) < low_u ||
          HWY_MIN(s.from_v, s.to_v) > high_v || HWY_MAX(s.from_v, s.to_v) < low_v)
        continue;
      if (size(s.line.u * cu + s.line.v * cv + s.line.w) > size(s.line.u) * hu + size(s.line.v) * hv)
        continue;
      const auto beyond = [&](T u, T v) {
        return sign * (line.u * u + line.v * v + line.w) >
               on_line<T> * (size(line.u * u) + size(line.v * v) + size(line.w));
      };
      if (!beyond(s.from_u, s.from_v) && !beyond(s.to_u, s.to_v)) continue;
      list_.push_back(list_[i]);
    }
  }

  /// How many triangles cover a part of the light that no edge crosses.
  T winding_around(const LightPolygon<T>& part) {
    T x[polygon_capacity], y[polygon_capacity];
    store(part.x, x);
    store(part.y, y);
    T winding = 0;
    for (int attempt = 0; attempt < 3; ++attempt) {
      T u = 0, v = 0, total = 0;
      for (int k = 0; k < part.count; ++k) {
        const T weight = T(1) + T(k * attempt);
        u += weight * x[k];
        v += weight * y[k];
        total += weight;
      }
      if (find_winding(u / total, v / total, winding)) break;
    }
    return winding;
  }

  /// The winding number around (u, v): the edges that a ray from there towards +u crosses. False if that is
  /// too near to an edge to be sure.
  HWY_NOINLINE bool find_winding(T u, T v, T& winding) const {
    const Lanes zero = splat<Lanes>(T(0)), qu = splat<Lanes>(u), qv = splat<Lanes>(v);
    const Lanes near = splat<Lanes>(on_line<T>), slack = splat<Lanes>(slack_);
    Lanes sum = zero;
    std::uint32_t doubtful = 0;
    for (const Block& block : at_point_) {
      const Lanes lu = load<Lanes>(block.u), lv = load<Lanes>(block.v);
      const Lanes turns = load<Lanes>(block.winding);
      const Lanes value = lu * qu + lv * qv + load<Lanes>(block.w);
      const auto from_above = less(qv, load<Lanes>(block.from_v)),
                 to_above = less(qv, load<Lanes>(block.to_v));
      const Lanes up = choose(from_above, zero, choose(less(zero, value), turns, zero));
      const Lanes down = choose(from_above, choose(less(value, zero), zero - turns, zero), zero);
      sum = sum + choose(to_above, up, down);
      const Lanes margin = near * (absolute(lu) + absolute(lv)) + slack * absolute(lv);
      doubtful |= (bits(from_above) ^ bits(to_above)) & less_bits(absolute(value), margin) &
                  less_bits(zero, absolute(turns));
    }
    T lanes[16];
    store(sum, lanes);
    winding = 0;
    for (const T lane : lanes) winding += lane;
    return doubtful == 0;
  }

  const GroupOutline* outline_ = nullptr;
  std::vector<MovingBlock> moving_;
  std::vector<Block> at_point_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> list_;  ///< segments that cross the parts at hand, part after part
  std::vector<int> signs_;           ///< one a SometimesBlocker
  T slack_ = 0;                      ///< what rounding the corners can amount to, units of the light
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
