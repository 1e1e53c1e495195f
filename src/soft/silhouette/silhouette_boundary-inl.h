// The boundary of what a silhouette leaves of a part of the light, without cutting the part: the segments of
// the silhouette's edges and of the part's sides that have a winding of zero on one side only. Windings are
// counted at one place of every edge, and change where others cross it. Included once per target.
//
// All decisions are of signs that rounding cannot change, or the boundary is not given and the part is to be
// cut. Two edges meet in one and the same place for both: the boundary is closed but for the rounding of
// sums.
#if defined(TENEBRA_SOFT_SILHOUETTE_BOUNDARY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_SOFT_SILHOUETTE_BOUNDARY_INL_H_
#undef TENEBRA_SOFT_SILHOUETTE_BOUNDARY_INL_H_
#else
#define TENEBRA_SOFT_SILHOUETTE_BOUNDARY_INL_H_
#endif

#include "soft/polygon/irradiance-inl.h"
#include "soft/silhouette/edge_segments-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::soft::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

template <class T>
class SilhouetteBoundary {
public:
  /// Finds out about the edges from place `first` on, on a convex part of the light. `around` and `edges`
  /// must stay where they are.
  HWY_NOINLINE void look_at(const RayEdges<T>& around, const SilhouetteEdges<T>& edges, std::size_t first,
                            T slack, const LightPolygon<T>& part) {
    edges_ = &edges;
    first_ = first;
    count_ = edges.count - first;
    slack_ = slack;
    around_ = &around;
    if (around.count > many_rays) {
      rays_.take(around, reduce_min(part.y), reduce_max(part.y), slack);
      around_ = &rays_;
    }
    segments_.find(edges, first, slack, part);
    blocks_.assign(segments_.blocks.size(), {});
    least_.resize(16 * blocks_.size());
    links_.clear();
    last_link_.assign(16 * blocks_.size(), 0);
    for (std::size_t b = 0; b < blocks_.size(); ++b) count_windings(b);
    for (std::size_t b = 0; b < blocks_.size(); ++b) find_crossings(b);
  }

  /// Bits of the edges of block b that may have light beside them: only along these the part need be cut.
  std::uint32_t kept(std::size_t b) const {
    const std::uint32_t dark = lt_bits(broadcast<Lanes>(0), load<Lanes>(&least_[16 * b])) & ~blocks_[b].level;
    return segments_.blocks[b].there & ~(dark & ~segments_.blocks[b].unsure);
  }

  /// Adds the boundary to `to`, counter-clockwise; false, and nothing added, where rounding might decide.
  HWY_NOINLINE bool append_to(LightEdges& to) {
    bool doubtful = false;
    const T winding = winding_around(*around_, slack_, segments_.begin_u(), segments_.begin_v(), doubtful);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      doubtful |= (kept(b) & (blocks_[b].doubtful | segments_.blocks[b].unsure)) != 0;
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
  static constexpr std::size_t many_rays = 64;  ///< edges; to leave out some of fewer gains nothing
  struct Block {
    T right[16];                 ///< windings to the right of the middles of segments
    std::uint32_t level = 0;     ///< bits of the edges without a right side: a ray runs along them
    std::uint32_t doubtful = 0;  ///< those about which rounding might decide
    std::uint32_t crossed = 0;   ///< those that others cross on the part
  };
  /// Another edge that crosses an edge, and the number of the link before it, or 0.
  struct Link {
    std::uint32_t other, before;
  };

  void count_windings(std::size_t b) {
    const SilhouetteLanes<T> e = edges_->lanes_from(first_ + 16 * b);
    const Lanes half = broadcast<Lanes>(T(0.5));
    const Lanes u = (load<Lanes>(&segments_.from_u[16 * b]) + load<Lanes>(&segments_.to_u[16 * b])) * half;
    const Lanes v = (load<Lanes>(&segments_.from_v[16 * b]) + load<Lanes>(&segments_.to_v[16 * b])) * half;
    const Windings<T> beside = windings_right_of(*around_, slack_, e.number, u, v);
    store(beside.winding, blocks_[b].right);
    store(beside.winding + min(e.winding, broadcast<Lanes>(0)) - beside.doubt, &least_[16 * b]);
    blocks_[b].level = ~bits(le(e.from_v, v) & lt(v, e.to_v));
    blocks_[b].doubtful = lt_bits(broadcast<Lanes>(0), beside.doubt) | blocks_[b].level;
  }

  /// Crossings of the edges of block b with later ones, of the same block and of those behind it.
  HWY_NOINLINE void find_crossings(std::size_t b) {
    const SilhouetteEdges<T>& its = *edges_;
    const EdgeSegments<T>& on = segments_;
    const SilhouetteLanes<T> e = its.lanes_from(first_ + 16 * b);
    const Lanes from_u = load<Lanes>(&on.from_u[16 * b]), from_v = load<Lanes>(&on.from_v[16 * b]);
    const Lanes to_u = load<Lanes>(&on.to_u[16 * b]), to_v = load<Lanes>(&on.to_v[16 * b]);
    const Lanes margin = load<Lanes>(&on.margin[16 * b]), near = broadcast<Lanes>(on_line<T> + slack_);
    const Lanes low_u = min(from_u, to_u) - near, high_u = max(from_u, to_u) + near;
    const Lanes low_v = from_v - near, high_v = to_v + near;
    for (std::size_t i = 16 * b + 1; i < count_; ++i) {
      const std::size_t k = first_ + i;
      const Lanes u = broadcast<Lanes>(its.u[k]), v = broadcast<Lanes>(its.v[k]),
                  w = broadcast<Lanes>(its.w[k]), its_margin = broadcast<Lanes>(on.margin[i]);
      const Lanes u0 = broadcast<Lanes>(on.from_u[i]), v0 = broadcast<Lanes>(on.from_v[i]),
                  u1 = broadcast<Lanes>(on.to_u[i]), v1 = broadcast<Lanes>(on.to_v[i]);
      const Lanes a = u * from_u + v * from_v + w, c = u * to_u + v * to_v + w;
      const Lanes f = e.u * u0 + e.v * v0 + e.w, g = e.u * u1 + e.v * v1 + e.w;
      const auto maybe = maybe_parted(a, c, its_margin) & maybe_parted(f, g, margin);
      const std::size_t lanes = i - 16 * b;
      const std::uint32_t before = lanes < 16 ? (1u << lanes) - 1 : 0xffffu;
      std::uint32_t met = bits(maybe) & before & on.blocks[b].there;
      if (met == 0 || (on.blocks[i / 16].there >> (i % 16) & 1) == 0) continue;
      met &= ~shares_corner(e, k) &
             bits(le(low_u, max(u0, u1)) & le(min(u0, u1), high_u) & le(low_v, v1) & le(v0, high_v));
      if (met != 0) link(b, i, met, met & ~bits(parted(a, c, its_margin) & parted(f, g, margin)));
    }
  }
  /// Edges that share a corner do not cross.
  SIMD_INLINE std::uint32_t shares_corner(const SilhouetteLanes<T>& e, std::size_t k) const {
    const auto at = [&](Lanes u, Lanes v) {
      return (eq(u, broadcast<Lanes>(edges_->from_u[k])) & eq(v, broadcast<Lanes>(edges_->from_v[k]))) |
             (eq(u, broadcast<Lanes>(edges_->to_u[k])) & eq(v, broadcast<Lanes>(edges_->to_v[k])));
    };
    return bits(at(e.from_u, e.from_v) | at(e.to_u, e.to_v));
  }
  /// Edge i and the edges `met` of block b cross, or may where `doubtful`: then the winding beside either is
  /// less, somewhere, by the other's turns at most.
  void link(std::size_t b, std::size_t i, std::uint32_t met, std::uint32_t doubtful) {
    const std::uint32_t bit = 1u << (i % 16);
    blocks_[b].crossed |= met, blocks_[b].doubtful |= doubtful;
    blocks_[i / 16].crossed |= bit, blocks_[i / 16].doubtful |= doubtful != 0 ? bit : 0;
    for (; met != 0; met &= met - 1) {
      const std::size_t other = 16 * b + static_cast<std::size_t>(std::countr_zero(met));
      link(i, other), link(other, i);
    }
  }
  void link(std::size_t i, std::size_t other) {
    least_[i] -= std::abs(edges_->winding[first_ + other]);
    links_.push_back({static_cast<std::uint32_t>(other), last_link_[i]});
    last_link_[i] = static_cast<std::uint32_t>(links_.size());
  }

  static void push(const Place& from, const Place& to, LightEdges& edges) {
    edges.reserve(1);
    edges.u0[edges.count] = from.x, edges.v0[edges.count] = from.y;
    edges.u1[edges.count] = to.x, edges.v1[edges.count] = to.y;
    ++edges.count;
  }

  /// `winding` around the place where the walk along the sides begins.
  void append_sides(T winding, LightEdges& edges) {
    auto next = segments_.side_changes.begin();
    for (int k = 0; k < segments_.sides(); ++k) {
      Place at = segments_.vertex(k);
      for (; next != segments_.side_changes.end() && next->share <= k + 1; ++next) {
        if (winding == T(0)) push(at, next->at, edges);
        winding += next->change;
        at = next->at;
      }
      if (winding == T(0)) push(at, segments_.vertex(k + 1), edges);
    }
  }

  void append_edges(std::size_t b, LightEdges& edges) {
    const EdgeSegments<T>& on = segments_;
    const Lanes zero = broadcast<Lanes>(0), right = load<Lanes>(blocks_[b].right);
    const auto left_is_lit = eq(right + load<Lanes>(&edges_->winding[first_ + 16 * b]), zero);
    const std::uint32_t lit = kept(b) & ~blocks_[b].crossed & bits(left_is_lit | eq(right, zero));
    const Lanes from_u = load<Lanes>(&on.from_u[16 * b]), from_v = load<Lanes>(&on.from_v[16 * b]);
    const Lanes to_u = load<Lanes>(&on.to_u[16 * b]), to_v = load<Lanes>(&on.to_v[16 * b]);
    edges.reserve(16);
    const auto append = [&](Lanes where_left, Lanes where_right, std::vector<double>& values) {
      T packed[16];
      compress(mask_of_bits<T, 16>(lit), select(left_is_lit, where_left, where_right), packed);
      store(load_widened<Pack<double, 16>>(packed), &values[edges.count]);
    };
    append(from_u, to_u, edges.u0), append(from_v, to_v, edges.v0);
    append(to_u, from_u, edges.u1), append(to_v, from_v, edges.v1);
    edges.count += static_cast<std::size_t>(std::popcount(lit));
    for (std::uint32_t left = kept(b) & blocks_[b].crossed; left != 0; left &= left - 1)
      append_crossed(16 * b + static_cast<std::size_t>(std::countr_zero(left)), edges);
  }

  /// The lit segments of an edge that others cross.
  HWY_NOINLINE void append_crossed(std::size_t i, LightEdges& edges) {
    changes_.clear();
    for (std::uint32_t k = last_link_[i]; k != 0; k = links_[k - 1].before)
      changes_.push_back(crossing(i, links_[k - 1].other));
    sort_along(changes_);
    const T turns = edges_->winding[first_ + i];
    T right = blocks_[i / 16].right[i % 16];  // in the middle
    for (const WindingChange<T>& c : changes_)
      if (c.share < 0.5) right -= c.change;
    Place at = segments_.from(i);
    const auto append = [&](const Place& next) {
      if (right + turns == T(0)) push(at, next, edges);
      if (right == T(0)) push(next, at, edges);
      at = next;
    };
    for (const WindingChange<T>& c : changes_) {
      append(c.at);
      right += c.change;
    }
    append(segments_.to(i));
  }

  /// Where edge k crosses edge i, and how that changes i's winding. The place is found the same way for both.
  WindingChange<T> crossing(std::size_t i, std::size_t k) const {
    const auto cross = [](const Place& a, const Place& b) { return a.x * b.y - a.y * b.x; };
    const auto way = [&](std::size_t edge) { return segments_.to(edge) - segments_.from(edge); };
    const std::size_t low = std::min(i, k), high = std::max(i, k);
    const double share =
        cross(way(high), segments_.from(low) - segments_.from(high)) / cross(way(low), way(high));
    const Place at = segments_.from(low) + std::clamp(share, 0.0, 1.0) * way(low), along = way(i);
    const T turns = edges_->winding[first_ + k];
    return {glm::dot(at - segments_.from(i), along) / glm::dot(along, along), at,
            cross(way(k), along) > 0 ? turns : -turns};
  }

  /// Whether the edges from place `first` on, as vectors, add up to nothing, as those of closed lines do.
  static bool is_closed(const LightEdges& edges, std::size_t first) {
    Place sum(0.0);
    for (std::size_t i = first; i < edges.count; ++i)
      sum += Place(edges.u1[i] - edges.u0[i], edges.v1[i] - edges.v0[i]);
    return std::abs(sum.x) + std::abs(sum.y) < 0x1p-40 * static_cast<double>(edges.count - first + 1);
  }

  const RayEdges<T>* around_ = nullptr;
  RayEdges<T> rays_;  ///< those at the height of the part
  const SilhouetteEdges<T>* edges_ = nullptr;
  std::size_t first_ = 0, count_ = 0;  ///< the edges at hand
  T slack_ = 0;
  EdgeSegments<T> segments_;
  std::vector<Block> blocks_;
  std::vector<T> least_;  ///< the least windings beside the edges that rounding and crossings allow
  std::vector<Link> links_;
  std::vector<std::uint32_t> last_link_;  ///< of every edge, or 0
  std::vector<WindingChange<T>> changes_;
};

}  // namespace tenebra::soft::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
