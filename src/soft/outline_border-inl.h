// The border of what an outline leaves of a part of the light, without cutting the part: the stretches of the
// outline's edges and of the part's own border that have a winding of zero on one side only. Windings are
// counted at one place of every edge, and change where others cross it. Included once per target.
//
// All decisions are of signs that rounding cannot change, or the solver says so and the part is to be cut.
// Two edges meet in one and the same place for both: the border found is closed, to the last bit but for the
// rounding of sums.
#if defined(TENEBRA_SOFT_OUTLINE_BORDER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_OUTLINE_BORDER_INL_H_
#undef TENEBRA_SOFT_OUTLINE_BORDER_INL_H_
#else
#define TENEBRA_SOFT_OUTLINE_BORDER_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "soft/irradiance-inl.h"
#include "soft/outline_windings-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::HWY_NAMESPACE {

template <class T>
class OutlineBorder {
public:
  /// Finds out about the edges from place `first` on, on a convex part of the light. They stay where they
  /// are.
  HWY_NOINLINE void look_at(const RayEdges<T>& around, const OutlineEdges<T>& edges, std::size_t first,
                            T slack, const LightPolygon<T>& light) {
    around_ = &around;
    if (around.count > 64) {  // exp
      rays_.count = 0;
      rays_.make_room(around.count);
      const Lanes low = num(least(light.y)), high = num(greatest(light.y));
      for (std::size_t i = 0; i < around.count; i += 16) rays_.append_from(around, i, low, high, slack);
      around_ = &rays_;
    }
    edges_ = &edges;
    first_ = first;
    count_ = edges.count - first;
    slack_ = slack;
    take_up(light);
    for (std::size_t b = 0; b < blocks_.size(); ++b) clip(b);
    for (std::size_t b = 0; b < blocks_.size(); ++b) classify(b);
  }

  /// Bits of the edges of block b that may have light beside them: only along these the part need be cut.
  std::uint32_t kept(std::size_t b) const { return blocks_[b].kept; }

  /// Adds the border to `to`, counter-clockwise; false, and nothing added, where rounding might decide.
  HWY_NOINLINE bool append_to(LightEdges& to) {
    bool doubtful = false;
    const T winding = winding_around(*around_, slack_, inner_x_[0], inner_y_[0], doubtful);
    for (const Block& block : blocks_) doubtful |= block.doubtful != 0;
    if (doubtful) return false;
    const std::size_t before = to.count;
    append_sides(winding, to);
    for (std::size_t b = 0; b < blocks_.size(); ++b) append_edges(b, to);
    if (is_closed(to, before)) return true;
    to.count = before;
    return false;
  }

private:
  using Lanes = Pack<T, 16>;
  using Place = glm::dvec2;
  /// Sixteen edges: where they begin and end on the part, and the windings to their right there.
  struct Block {
    T right[16];
    std::uint32_t there = 0;     ///< bits of those with a stretch on the part
    std::uint32_t unsure = 0;    ///< rounding might decide where it begins or ends
    std::uint32_t kept = 0;      ///< that may have light beside them
    std::uint32_t doubtful = 0;  ///< of these, the ones about which rounding might decide
    std::uint32_t crossed = 0;   ///< by others on the part
  };
  /// Where the winding beside a stretch changes.
  struct Crossing {
    double share;  ///< of the way along the stretch; of sides: behind their number
    Place at;
    T change;
  };
  static HWY_INLINE Lanes num(T value) { return splat<Lanes>(value); }

  void take_up(const LightPolygon<T>& light) {
    store(light.x, x_);
    store(light.y, y_);
    sides_ = light.count;
    x_[sides_] = x_[0], y_[sides_] = y_[0];
    T u = 0, v = 0;
    for (int k = 0; k < sides_; ++k) u += x_[k], v += y_[k];
    u /= static_cast<T>(sides_), v /= static_cast<T>(sides_);
    const T shrink = 32 * (on_line<T> + slack_);
    for (int k = 0; k <= sides_; ++k) {
      inner_x_[k] = x_[k] - shrink * (x_[k] - u);
      inner_y_[k] = y_[k] - shrink * (y_[k] - v);
    }
    blocks_.assign((count_ + 15) / 16, {});
    crosses_.assign(blocks_.size() * count_, 0);
    side_crossings_.clear();
    const std::size_t room = 16 * blocks_.size();
    if (from_u_.size() >= room) return;
    for (auto* values : {&from_u_, &from_v_, &to_u_, &to_v_, &margin_}) values->resize(2 * room);
  }

  /// Positive where line or side pass between the ends of the other, as far as rounding cannot decide: of the
  /// values of either's ends the lesser is below and the greater above by more than `margin`.
  static HWY_INLINE Truth<T, 16> parted(Lanes a, Lanes b, Lanes margin) {
    return less(min(a, b), num(0) - margin) & less(margin, max(a, b));
  }
  static HWY_INLINE Truth<T, 16> maybe_parted(Lanes a, Lanes b, Lanes margin) {
    return less(min(a, b), margin) & less(num(0) - margin, max(a, b));
  }

  /// Finds the stretches of a block's edges on the part, and notes where they cross its sides.
  HWY_NOINLINE void clip(std::size_t b) {
    const OutlineLanes<T> e = edges_->lanes_from(first_ + 16 * b);
    const Lanes zero = num(0), one = num(1), margin = doubt_beside(e.u, e.v, slack_);
    const Lanes far_u = max(absolute(e.from_u), absolute(e.to_u)) + one,
                far_v = max(absolute(e.from_v), absolute(e.to_v)) + one;
    const std::uint32_t lanes = bits(lanes_below<T>(count_ - 16 * b));
    Lanes from_u = e.from_u, from_v = e.from_v, to_u = e.to_u, to_v = e.to_v, met = zero;
    std::uint32_t unsure = 0, entering = 0, leaving = 0;
    Lanes here = e.u * num(inner_x_[0]) + e.v * num(inner_y_[0]) + e.w;
    for (int k = 0; k < sides_; ++k) {
      const T px = inner_x_[k], py = inner_y_[k], du = inner_x_[k + 1] - px, dv = inner_y_[k + 1] - py;
      const Lanes next = e.u * num(inner_x_[k + 1]) + e.v * num(inner_y_[k + 1]) + e.w;
      const auto left_of = [&](Lanes u, Lanes v) {
        return num(du) * (v - num(py)) - num(dv) * (u - num(px));
      };
      const Lanes f = left_of(e.from_u, e.from_v), g = left_of(e.to_u, e.to_v);
      const Lanes reach = num(on_line<T> + slack_) * (num(std::abs(dv)) * far_u + num(std::abs(du)) * far_v);
      const std::uint32_t crosses = bits(parted(here, next, margin) & parted(f, g, reach)) & lanes;
      unsure |= bits(maybe_parted(here, next, margin) & maybe_parted(f, g, reach)) & lanes & ~crosses;
      // A ray from `from` towards +u leaves the part through the sides on its right, which rise.
      met = choose(not_above(num(py), e.from_v) & less(e.from_v, num(inner_y_[k + 1])) & less(zero, f),
                   met + one, met);
      met = choose(not_above(num(inner_y_[k + 1]), e.from_v) & less(e.from_v, num(py)) & less(f, zero),
                   met + one, met);
      if (crosses != 0) {
        const std::uint32_t in = crosses & less_bits(f, zero), out = crosses & ~in;
        const Lanes outer = e.u * num(x_[k]) + e.v * num(y_[k]) + e.w,
                    outer_next = e.u * num(x_[k + 1]) + e.v * num(y_[k + 1]) + e.w;
        const Lanes share = min(max(outer / (outer - outer_next), zero), one);
        const Lanes u = num(x_[k]) + share * num(x_[k + 1] - x_[k]),
                    v = num(y_[k]) + share * num(y_[k + 1] - y_[k]);
        const auto enters = truth_of<T, 16>(in), leaves = truth_of<T, 16>(out);
        from_u = choose(enters, u, from_u), from_v = choose(enters, v, from_v);
        to_u = choose(leaves, u, to_u), to_v = choose(leaves, v, to_v);
        entering |= in, leaving |= out;
        note(crosses, k, share, u, v, choose(less(here, next), e.winding, zero - e.winding));
      }
      here = next;
    }
    store(from_u, &from_u_[16 * b]), store(from_v, &from_v_[16 * b]);
    store(to_u, &to_u_[16 * b]), store(to_v, &to_v_[16 * b]);
    store(margin, &margin_[16 * b]);
    const std::uint32_t inside = bits(equal(met, one)) & lanes;
    blocks_[b].there = inside | entering | leaving | unsure;
    blocks_[b].unsure = unsure;
  }

  void note(std::uint32_t lanes, int side, Lanes share, Lanes u, Lanes v, Lanes change) {
    T s[16], x[16], y[16], c[16];
    store(share, s), store(u, x), store(v, y), store(change, c);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int k = std::countr_zero(lanes);
      side_crossings_.push_back({side + static_cast<double>(s[k]), {x[k], y[k]}, c[k]});
    }
  }

  /// Counts windings in the middle of a block's stretches and finds what crosses them.
  HWY_NOINLINE void classify(std::size_t b) {
    Block& block = blocks_[b];
    const OutlineLanes<T> e = edges_->lanes_from(first_ + 16 * b);
    const Lanes zero = num(0), half = num(T(0.5));
    const Lanes from_u = load<Lanes>(&from_u_[16 * b]), from_v = load<Lanes>(&from_v_[16 * b]);
    const Lanes to_u = load<Lanes>(&to_u_[16 * b]), to_v = load<Lanes>(&to_v_[16 * b]);
    const Lanes mu = (from_u + to_u) * half, mv = (from_v + to_v) * half;
    const Windings<T> beside = windings_right_of(*around_, slack_, e.number, mu, mv);
    store(beside.winding, block.right);
    Lanes lost = zero;
    std::uint32_t doubt = less_bits(zero, beside.doubt) | block.unsure |
                          ~bits(not_above(e.from_v, mv) & less(mv, e.to_v));  // level: neither side is right
    const std::uint32_t level = block.unsure | ~bits(not_above(e.from_v, mv) & less(mv, e.to_v));
    doubt |= cross(b, e, from_u, from_v, to_u, to_v, lost);
    const Lanes least_beside = beside.winding + min(e.winding, zero) - beside.doubt - lost;
    block.kept = block.there & (level | ~less_bits(zero, least_beside));
    block.doubtful = block.kept & doubt;
  }

  /// Notes the edges that cross those of a block on the part. `lost`: what they can take from the winding
  /// beside an edge, at most. Bits of those about which rounding might decide.
  HWY_INLINE std::uint32_t cross(std::size_t b, const OutlineLanes<T>& e, Lanes from_u, Lanes from_v,
                                 Lanes to_u, Lanes to_v, Lanes& lost) {
    const OutlineEdges<T>& its = *edges_;
    const Lanes margin = load<Lanes>(&margin_[16 * b]), near = num(on_line<T> + slack_);
    const Lanes low_u = min(from_u, to_u) - near, high_u = max(from_u, to_u) + near;
    const Lanes low_v = from_v - near, high_v = to_v + near;
    std::uint32_t doubt = 0, crossed = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t k = first_ + i;
      const Lanes u = num(its.u[k]), v = num(its.v[k]), w = num(its.w[k]), its_margin = num(margin_[i]);
      const Lanes u0 = num(from_u_[i]), v0 = num(from_v_[i]), u1 = num(to_u_[i]), v1 = num(to_v_[i]);
      const Lanes a = u * from_u + v * from_v + w, c = u * to_u + v * to_v + w;
      const Lanes f = e.u * u0 + e.v * v0 + e.w, g = e.u * u1 + e.v * v1 + e.w;
      const auto maybe = maybe_parted(a, c, its_margin) & maybe_parted(f, g, margin) &
                         not_above(low_u, max(u0, u1)) & not_above(min(u0, u1), high_u) &
                         not_above(low_v, v1) & not_above(v0, high_v);
      if (!any(maybe)) continue;
      const std::uint32_t met = bits(maybe) & ~shares_corner(e, k) & blocks_[b].there;
      if (met == 0 || (blocks_[i / 16].there >> (i % 16) & 1) == 0) continue;
      lost = choose(truth_of<T, 16>(met), lost + absolute(num(its.winding[k])), lost);
      doubt |= met & ~bits(parted(a, c, its_margin) & parted(f, g, margin));
      crosses_[b * count_ + i] = met;
      crossed |= met;
    }
    blocks_[b].crossed = crossed;
    return doubt;
  }
  /// Edges that share a corner, as an edge does with itself, do not cross.
  HWY_INLINE std::uint32_t shares_corner(const OutlineLanes<T>& e, std::size_t k) const {
    const auto at = [&](Lanes u, Lanes v) {
      return (equal(u, num(edges_->from_u[k])) & equal(v, num(edges_->from_v[k]))) |
             (equal(u, num(edges_->to_u[k])) & equal(v, num(edges_->to_v[k])));
    };
    return bits(at(e.from_u, e.from_v) | at(e.to_u, e.to_v));
  }

  Place from(std::size_t i) const { return {from_u_[i], from_v_[i]}; }
  Place to(std::size_t i) const { return {to_u_[i], to_v_[i]}; }

  static void push(const Place& from, const Place& to, LightEdges& edges) {
    edges.reserve(1);
    edges.u0[edges.count] = from.x, edges.v0[edges.count] = from.y;
    edges.u1[edges.count] = to.x, edges.v1[edges.count] = to.y;
    ++edges.count;
  }
  static void sort(std::vector<Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.share < b.share; });
  }

  /// `winding` around the part's first vertex.
  void append_sides(T winding, LightEdges& edges) {
    sort(side_crossings_);
    std::size_t next = 0;
    for (int k = 0; k < sides_; ++k) {
      Place at{x_[k], y_[k]};
      for (; next < side_crossings_.size() && side_crossings_[next].share <= k + 1; ++next) {
        if (winding == T(0)) push(at, side_crossings_[next].at, edges);
        winding += side_crossings_[next].change;
        at = side_crossings_[next].at;
      }
      if (winding == T(0)) push(at, {x_[k + 1], y_[k + 1]}, edges);
    }
  }

  void append_edges(std::size_t b, LightEdges& edges) {
    const Block& block = blocks_[b];
    const Lanes zero = num(0), right = load<Lanes>(block.right);
    const auto left_is_lit = equal(right + load<Lanes>(&edges_->winding[first_ + 16 * b]), zero);
    const auto right_is_lit = equal(right, zero);
    const std::uint32_t lit = block.kept & ~block.crossed & bits(left_is_lit | right_is_lit);
    const Lanes from_u = load<Lanes>(&from_u_[16 * b]), from_v = load<Lanes>(&from_v_[16 * b]);
    const Lanes to_u = load<Lanes>(&to_u_[16 * b]), to_v = load<Lanes>(&to_v_[16 * b]);
    edges.reserve(16);
    const auto append = [&](Lanes where_left, Lanes where_right, std::vector<double>& values) {
      T packed[16];
      compress(truth_of<T, 16>(lit), choose(left_is_lit, where_left, where_right), packed);
      store(load_widened<Pack<double, 16>>(packed), &values[edges.count]);
    };
    append(from_u, to_u, edges.u0), append(from_v, to_v, edges.v0);
    append(to_u, from_u, edges.u1), append(to_v, from_v, edges.v1);
    edges.count += static_cast<std::size_t>(std::popcount(lit));
    for (std::uint32_t left = block.kept & block.crossed; left != 0; left &= left - 1)
      append_crossed(16 * b + static_cast<std::size_t>(std::countr_zero(left)), edges);
  }

  /// The lit stretches of an edge that others cross.
  HWY_NOINLINE void append_crossed(std::size_t i, LightEdges& edges) {
    crossings_.clear();
    for (std::size_t k = 0; k < count_; ++k)
      if ((crosses_[i / 16 * count_ + k] >> (i % 16) & 1) != 0) crossings_.push_back(crossing(i, k));
    sort(crossings_);
    const T turns = edges_->winding[first_ + i];
    T right = blocks_[i / 16].right[i % 16];  // in the middle
    for (const Crossing& c : crossings_)
      if (c.share < 0.5) right -= c.change;
    Place at = from(i);
    const auto append = [&](const Place& next) {
      if (right + turns == T(0)) push(at, next, edges);
      if (right == T(0)) push(next, at, edges);
      at = next;
    };
    for (const Crossing& c : crossings_) {
      append(c.at);
      right += c.change;
    }
    append(to(i));
  }

  /// Of edge i by edge k. The place is found the same way for both.
  Crossing crossing(std::size_t i, std::size_t k) const {
    const auto cross = [](const Place& a, const Place& b) { return a.x * b.y - a.y * b.x; };
    const std::size_t low = std::min(i, k), high = std::max(i, k);
    const Place way = to(low) - from(low), line = to(high) - from(high);
    const double t = cross(line, from(low) - from(high)) / cross(way, line);
    const Place at = from(low) + std::clamp(t, 0.0, 1.0) * way, along = to(i) - from(i);
    const bool to_left = cross(to(k) - from(k), along) > 0;
    const T turns = edges_->winding[first_ + k];
    return {glm::dot(at - from(i), along) / glm::dot(along, along), at, to_left ? turns : -turns};
  }

  /// Whether the edges from place `first` on run out of every place as often as into it.
  static bool is_closed(const LightEdges& edges, std::size_t first) {
    Place sum(0.0);
    for (std::size_t i = first; i < edges.count; ++i)
      sum += Place(edges.u1[i] - edges.u0[i], edges.v1[i] - edges.v0[i]);
    return std::abs(sum.x) + std::abs(sum.y) < 0x1p-40 * static_cast<double>(edges.count - first + 1);
  }

  const RayEdges<T>* around_ = nullptr;
  RayEdges<T> rays_;
  const OutlineEdges<T>* edges_ = nullptr;
  std::size_t first_ = 0, count_ = 0;  ///< the edges at hand
  T slack_ = 0;
  T x_[polygon_capacity + 1], y_[polygon_capacity + 1];  ///< the part; its first vertex again
  T inner_x_[polygon_capacity + 1], inner_y_[polygon_capacity + 1];
  int sides_ = 0;
  std::vector<Block> blocks_;
  std::vector<T> from_u_, from_v_, to_u_, to_v_;  ///< stretches of the edges on the part
  std::vector<T> margin_;                         ///< doubt_beside them
  std::vector<std::uint32_t> crosses_;  ///< block and edge: bits of those of the block that it crosses
  std::vector<Crossing> side_crossings_, crossings_;
};

}  // namespace tenebra::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
