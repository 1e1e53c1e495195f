#include "stage/cutout/piece.h"

#include <algorithm>
#include <array>
#include <optional>

#include "stage/cutout/piece_ring.h"

namespace tenebra::stage {
namespace {

/// Where a segment of the outline enters or leaves the ring.
struct Event {
  Spot spot;
  int side;
  bool enters;
  std::size_t ring_index = 0;  ///< the ring's side on which it lies
  double key = 0;              ///< along it
  std::size_t partner = 0;     ///< of one that leaves: the event at which the region's border comes back
};

/// The part of a segment within the ring. Events are indices, or -1 where its end lies inside.
struct Stretch {
  std::uint32_t from, to;  ///< points of the outline
  int entry, exit;
  glm::dvec2 start;  ///< the segment's first point
};

class PieceCutter {
public:
  PieceCutter(const PlaneTriangle& triangle, const Outline& outline, const Leaf& leaf, const Tile& tile)
      : triangle_(triangle), outline_(outline), leaf_(leaf), tile_(tile), bounds_(place_leaf(leaf, tile)) {}

  PieceKind run(std::vector<std::vector<Spot>>& loops) {
    if (!overlaps()) return PieceKind::nothing;
    ring_ = cut_ring(triangle_, bounds_);
    if (ring_.empty()) return PieceKind::nothing;
    for (const std::uint32_t segment : leaf_.segments) add_stretch(segment);
    std::sort(by_start_.begin(), by_start_.end());
    used_.assign(stretches_.size(), false);
    const std::size_t first = loops.size();
    if (!events_.empty()) {
      add_leaf_corners();
      join_events();
      follow_events(loops);
    }
    follow_loops(loops);
    if (!walked_ && surrounds(loops, first)) {
      const bool whole = loops.size() == first;
      if (events_.empty()) add_leaf_corners();
      loops.push_back(ring_spots());
      if (whole) return PieceKind::whole;
    }
    return loops.size() == first ? PieceKind::nothing : PieceKind::cut;
  }

private:
  void add_leaf_corners() { ring_ = with_leaf_corners(ring_, triangle_, bounds_, leaf_, tile_); }

  bool overlaps() const {
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::minmax(
          {triangle_.corners()[0][axis], triangle_.corners()[1][axis], triangle_.corners()[2][axis]});
      if (high < bounds_.low[axis] || low > bounds_.high[axis]) return false;
    }
    return true;
  }

  glm::dvec2 place(std::uint32_t point) const { return tile_.offset + tile_.sign * outline_.points[point]; }

  /// A point of the outline, and which sides it lies beyond: the same answer for all segments that meet in
  /// it, and for the triangle or leaf beyond the side the opposite one.
  struct End {
    std::uint32_t point;
    glm::dvec2 at;
    std::array<double, 3> edge;
    unsigned beyond = 0;
  };
  End make_end(std::uint32_t point) const {
    End end{point, place(point), {}, 0};
    for (int e = 0; e < 3; ++e) {
      end.edge[static_cast<std::size_t>(e)] = triangle_.side(e, end.at);
      if (!triangle_.inside(e, end.edge[static_cast<std::size_t>(e)])) end.beyond |= 1u << e;
    }
    for (int s = leaf_side; s < side_count; ++s) {
      const double at = end.at[bounds_.axis(s)];
      if (bounds_.is_low(s) ? at < bounds_.line(s) : at >= bounds_.line(s)) end.beyond |= 1u << s;
    }
    return end;
  }

  double share(int side, const End& a, const End& b) const {
    const auto e = static_cast<std::size_t>(side);
    if (side < leaf_side) return a.edge[e] / (a.edge[e] - b.edge[e]);
    const int axis = bounds_.axis(side);
    return (bounds_.line(side) - a.at[axis]) / (b.at[axis] - a.at[axis]);
  }

  void add_stretch(std::uint32_t segment) {
    const bool reversed = tile_.sign.x * tile_.sign.y < 0;
    const std::uint32_t from = reversed ? outline_.next[segment] : segment;
    const std::uint32_t to = reversed ? segment : outline_.next[segment];
    if (misses(place(from), place(to))) return;
    const End a = make_end(from), b = make_end(to);
    if ((a.beyond & b.beyond) != 0) return;
    double enter = 0, leave = 1;
    int entry_side = -1, exit_side = -1;
    for (int s = 0; s < side_count; ++s) {
      const bool a_beyond = (a.beyond >> s & 1u) != 0, b_beyond = (b.beyond >> s & 1u) != 0;
      if (a_beyond == b_beyond) continue;
      const double at = share(s, a, b);
      if (a_beyond && (entry_side < 0 || at > enter)) enter = at, entry_side = s;
      if (b_beyond && (exit_side < 0 || at < leave)) leave = at, exit_side = s;
    }
    if (entry_side >= 0 && exit_side >= 0 && !(enter < leave)) return;
    Stretch stretch{from, to, -1, -1, a.at};
    if (entry_side >= 0) stretch.entry = add_event(entry_side, a, b, enter, true);
    if (exit_side >= 0) stretch.exit = add_event(exit_side, a, b, leave, false);
    if (stretch.entry < 0) by_start_.emplace_back(from, stretches_.size());
    stretches_.push_back(stretch);
  }

  bool misses(glm::dvec2 a, glm::dvec2 b) const {
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::minmax(
          {triangle_.corners()[0][axis], triangle_.corners()[1][axis], triangle_.corners()[2][axis]});
      if (std::max(a[axis], b[axis]) < low || std::min(a[axis], b[axis]) > high) return true;
    }
    return false;
  }

  int add_event(int side, const End& a, const End& b, double at, bool enters) {
    Event event{{}, side, enters};
    if (side < leaf_side) {
      const auto e = static_cast<std::size_t>(side);
      event.spot = triangle_.edge_spot(side, a.at, b.at, a.edge[e], b.edge[e]);
    } else {
      glm::dvec2 place = a.at + at * (b.at - a.at);
      place[bounds_.axis(side)] = bounds_.line(side);
      event.spot = triangle_.spot(place);
    }
    events_.push_back(event);
    return static_cast<int>(events_.size()) - 1;
  }

  /// Events in their order around the ring.
  void place_event(Event& event) const {
    double nearest = 0;
    bool found = false;
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const glm::dvec2 from = ring_[i].spot.at, way = ring_[(i + 1) % ring_.size()].spot.at - from;
      const double length = glm::dot(way, way);
      const double key = length > 0 ? glm::dot(event.spot.at - from, way) / length : 0.0;
      const glm::dvec2 off = event.spot.at - (from + way * std::clamp(key, 0.0, 1.0));
      double distance = glm::dot(off, off);
      if (ring_[i].side != event.side) distance += 1e30;  // only if rounding left nothing of its side
      if (found && distance >= nearest) continue;
      nearest = distance, found = true;
      event.ring_index = i, event.key = key;
    }
    if (event.spot == ring_[(event.ring_index + 1) % ring_.size()].spot)
      event.ring_index = (event.ring_index + 1) % ring_.size();
    if (event.spot == ring_[event.ring_index].spot) event.key = 0;
  }

  /// Each event that leaves is joined to the next that enters, as brackets are: where rounding has put two
  /// that leave beside each other, two that enter follow. In one place those that leave come first, so that
  /// a line that only touches the ring is joined to itself.
  void join_events() {
    for (Event& event : events_) place_event(event);
    std::vector<std::size_t> order(events_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Event &p = events_[a], &q = events_[b];
      if (p.ring_index != q.ring_index) return p.ring_index < q.ring_index;
      return p.key != q.key ? p.key < q.key : p.enters < q.enters;
    });
    rank_.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) rank_[order[i]] = i;
    std::vector<std::size_t> open;
    std::vector<bool> joined(events_.size(), false);
    for (std::size_t i = 0; i < 2 * order.size(); ++i) {
      const std::size_t e = order[i % order.size()];
      if (joined[e]) continue;
      if (!events_[e].enters) {
        if (i < order.size()) open.push_back(e);
      } else if (!open.empty()) {
        events_[open.back()].partner = e;
        joined[open.back()] = joined[e] = true;
        open.pop_back();
      }
    }
  }

  std::optional<std::size_t> stretch_from(std::uint32_t point) const {
    const auto at = std::lower_bound(by_start_.begin(), by_start_.end(), std::pair(point, std::size_t{0}));
    if (at == by_start_.end() || at->first != point) return std::nullopt;
    return at->second;
  }

  /// Follows the outline from a stretch on; the event at which it leaves, or -1 where it closes.
  int follow(std::size_t stretch, std::vector<Spot>& loop) {
    for (;;) {
      used_[stretch] = true;
      const Stretch& s = stretches_[stretch];
      add_spot(loop,
               s.entry >= 0 ? events_[static_cast<std::size_t>(s.entry)].spot : triangle_.spot(s.start));
      if (s.exit >= 0) {
        add_spot(loop, events_[static_cast<std::size_t>(s.exit)].spot);
        return s.exit;
      }
      const auto next = stretch_from(s.to);
      if (!next || used_[*next]) return -1;
      stretch = *next;
    }
  }

  void follow_events(std::vector<std::vector<Spot>>& loops) {
    std::vector<std::size_t> entered(events_.size(), 0);
    for (std::size_t i = 0; i < stretches_.size(); ++i)
      if (stretches_[i].entry >= 0) entered[static_cast<std::size_t>(stretches_[i].entry)] = i;
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      if (stretches_[i].entry < 0 || used_[i]) continue;
      std::vector<Spot> loop;
      for (std::size_t at = i; !used_[at];) {
        const int exit = follow(at, loop);
        if (exit < 0) break;
        const std::size_t partner = events_[static_cast<std::size_t>(exit)].partner;
        walk_ring(static_cast<std::size_t>(exit), partner, loop);
        at = entered[partner];
      }
      finish(loop, loops);
    }
  }

  void walk_ring(std::size_t exit, std::size_t entry, std::vector<Spot>& loop) {
    const Event &from = events_[exit], &to = events_[entry];
    if (from.spot == to.spot) return;
    walked_ = true;
    if (from.ring_index == to.ring_index && rank_[exit] < rank_[entry]) return;
    std::size_t i = from.ring_index;
    do {
      i = (i + 1) % ring_.size();
      add_spot(loop, ring_[i].spot);
    } while (i != to.ring_index);
  }

  void follow_loops(std::vector<std::vector<Spot>>& loops) {
    for (std::size_t i = 0; i < stretches_.size(); ++i) {
      if (used_[i]) continue;
      std::vector<Spot> loop;
      follow(i, loop);
      finish(loop, loops);
    }
  }

  static void add_spot(std::vector<Spot>& loop, const Spot& spot) {
    if (loop.empty() || !(loop.back() == spot)) loop.push_back(spot);
  }
  static void finish(std::vector<Spot>& loop, std::vector<std::vector<Spot>>& loops) {
    while (loop.size() > 1 && loop.back() == loop.front()) loop.pop_back();
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  }

  std::vector<Spot> ring_spots() const {
    std::vector<Spot> spots;
    for (const RingPoint& point : ring_) spots.push_back(point.spot);
    return spots;
  }

  /// Where nothing crosses the ring: whether it lies in the region. A place in the middle is asked, less what
  /// the closed loops within the ring make of it; beside the very middle, where regular pictures have lines.
  bool surrounds(const std::vector<std::vector<Spot>>& loops, std::size_t first) const {
    glm::dvec2 middle(0.0);
    double weights = 0, weight = 1;
    for (const RingPoint& point : ring_) {
      middle += weight * point.spot.at;
      weights += weight;
      weight += 0.137;
    }
    middle /= weights;
    bool inside = is_inside(outline_, leaf_, tile_.sign * (middle - tile_.offset));
    for (std::size_t l = first; l < loops.size(); ++l) {
      for (std::size_t i = 0; i < loops[l].size(); ++i) {
        const glm::dvec2 a = loops[l][i].at, b = loops[l][(i + 1) % loops[l].size()].at;
        if ((a.y > middle.y) == (b.y > middle.y)) continue;
        inside ^= middle.x < a.x + (middle.y - a.y) * ((b.x - a.x) / (b.y - a.y));
      }
    }
    return inside;
  }

  const PlaneTriangle& triangle_;
  const Outline& outline_;
  const Leaf& leaf_;
  const Tile& tile_;
  const Rectangle bounds_;
  Ring ring_;
  std::vector<Stretch> stretches_;
  std::vector<std::pair<std::uint32_t, std::size_t>> by_start_;  ///< stretches that begin inside, by point
  std::vector<Event> events_;
  std::vector<std::size_t> rank_;  ///< of an event, in the order around the ring
  std::vector<bool> used_;
  bool walked_ = false;  ///< a part of the ring bounds the region
};

}  // namespace

PieceKind cut_piece(const PlaneTriangle& triangle, const Outline& outline, const Leaf& leaf, const Tile& tile,
                    std::vector<std::vector<Spot>>& loops) {
  return PieceCutter(triangle, outline, leaf, tile).run(loops);
}

}  // namespace tenebra::stage
