#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "points/sample_sides.h"
#include "soft/groups/group_parts.h"

namespace tenebra::soft {

namespace {

constexpr std::uint32_t tile = 8;  // side in pixels
static_assert(tile * tile == largest_neighbourhood);

// A cache of data about triangles and the sides of their points, by the id's last bits.
class KnownTriangles {
public:
  /// That of a point.
  const LitTriangle& operator()(const Grouping& g, points::SideFinder& sides, std::uint32_t id,
                                std::uint32_t pixel) {
    LitTriangle& lit = known_[id % known_.size()];
    if (id != lit.receiver.triangle || (sides.differ() && sides.at(pixel) != lit.receiver.side))
      lit = lit_triangle(g.triangles, id, sides.at(pixel), g.light);
    return lit;
  }

private:
  std::array<LitTriangle, 64> known_;
};

// A square of the picture: point 8 y + x is its pixel (x, y).
class Tile {
public:
  Tile(const Grouping& grouping, GroupPart& part)
      : g_(grouping), part_(part), sides_(grouping.points, grouping.triangles), lanes_(part.lanes) {
    lanes_.resize(largest_neighbourhood);
    for (std::uint32_t i = 0; i < largest_neighbourhood; ++i) {
      lanes_.column[i] = static_cast<float>(i % tile);
      lanes_.row[i] = static_cast<float>(i / tile);
    }
  }

  void group(std::uint32_t left, std::uint32_t top) {
    load(left, top);
    if (const std::uint64_t active = find_receivers(); active != 0) append_split(active);
  }

private:
  struct Seen {
    LitTriangle triangle;
    std::uint64_t points = 0;
  };

  void load(std::uint32_t left, std::uint32_t top);
  std::uint64_t find_receivers();
  std::uint64_t on_side(std::uint64_t points, int side);
  void append_split(std::uint64_t set);
  void append_group(std::uint64_t set, const math::Box<double>& box);
  std::uint32_t pixel(std::uint32_t k) const { return first_ + k / tile * width() + k % tile; }
  std::uint32_t width() const { return static_cast<std::uint32_t>(g_.points.width); }

  const Grouping& g_;
  GroupPart& part_;
  points::SideFinder sides_;
  KnownTriangles known_;
  const LitTriangle free_ = lit_free_points();
  PointLanes& lanes_;
  std::uint32_t first_ = 0;  // its first pixel
  std::array<std::uint32_t, largest_neighbourhood> ids_{};
  std::array<Seen, largest_neighbourhood> seen_;  // ascending
  std::size_t seen_count_ = 0;
};

void Tile::load(std::uint32_t left, std::uint32_t top) {
  const auto height = static_cast<std::uint32_t>(g_.points.height);
  first_ = top * width() + left;
  for (std::uint32_t y = 0; y < tile; ++y) {
    const std::uint32_t from = first_ + y * width();
    if (left + tile <= width() && top + y < height) {
      g_.kernels.put_eight(&g_.points.positions[from], lanes_, tile * y);
      std::copy_n(&g_.points.triangles[from], tile, &ids_[tile * y]);
      continue;
    }
    for (std::uint32_t x = 0; x < tile; ++x) {
      const bool inside = left + x < width() && top + y < height;
      ids_[tile * y + x] = inside ? g_.points.triangles[from + x] : no_triangle;
      if (inside) lanes_.put(tile * y + x, g_.points.positions[from + x]);
    }
  }
}

// Those of `points` that are on this side of their triangle.
std::uint64_t Tile::on_side(std::uint64_t points, int side) {
  std::uint64_t here = 0;
  for (; points != 0; points &= points - 1) {
    const auto k = static_cast<std::uint32_t>(std::countr_zero(points));
    if (sides_.at(pixel(k)) == side) here |= std::uint64_t{1} << k;
  }
  return here;
}

// Fills seen_; returns the active points.
std::uint64_t Tile::find_receivers() {
  seen_count_ = 0;
  std::uint64_t active = 0;
  for (std::uint64_t rest = g_.kernels.in_front(lanes_, g_.light, 0); rest != 0;) {
    const std::uint32_t id = ids_[static_cast<std::size_t>(std::countr_zero(rest))];
    std::uint64_t here = rest & g_.kernels.equal(ids_.data(), id);
    if (id >= g_.triangles.triangles.size() && id != free_point) {
      rest &= ~here;
      continue;
    }
    const auto first = static_cast<std::uint32_t>(std::countr_zero(here));
    const LitTriangle& triangle = id == free_point ? free_ : known_(g_, sides_, id, pixel(first));
    if (sides_.differ() && id != free_point) here = on_side(here, triangle.receiver.side);
    rest &= ~here;
    if (!triangle.light_above) continue;
    active |= here;
    std::size_t place = seen_count_++;
    for (; place > 0 && seen_[place - 1].triangle.receiver.triangle > id; --place)
      seen_[place] = seen_[place - 1];
    seen_[place] = {triangle, here};
  }
  return active;
}

// Splits where five slices in a row, of sixteen across the longest side, are empty: rows of pixels evenly
// spaced along it leave at most two, so this is a gap in depth.
constexpr int slices_of_a_gap = 5;

// The fifth empty slice of the first gap, or 0.
int gap_of(std::uint32_t taken) {
  int run = 0;
  for (int k = 0; k < Slices::count; ++k) {
    run = (taken >> k & 1) != 0 ? 0 : run + 1;
    if (run == slices_of_a_gap) return k;
  }
  return 0;
}

void Tile::append_split(std::uint64_t set) {
  const math::Box<double> box = g_.kernels.box(lanes_, bytes_of(set));
  const int axis = box.longest_side();
  const Slices slices{axis, box.low[axis], Slices::count / (box.high[axis] - box.low[axis])};
  const int gap = std::isfinite(slices.scale) ? gap_of(g_.kernels.taken(lanes_, bytes_of(set), slices)) : 0;
  if (gap == 0) {
    append_group(set, box);
    return;
  }
  const std::uint64_t below = g_.kernels.below(lanes_, slices, gap);
  append_split(set & below);
  append_split(set & ~below);
}

// Places of a tile's points along a Z curve, so that any range of them lies together.
constexpr auto z_curve = [] {
  std::array<std::uint8_t, largest_neighbourhood> places{};
  for (std::uint32_t z = 0; z < places.size(); ++z) {
    const std::uint32_t x = (z & 1) | (z >> 1 & 2) | (z >> 2 & 4),
                        y = (z >> 1 & 1) | (z >> 2 & 2) | (z >> 3 & 4);
    places[z] = static_cast<std::uint8_t>(tile * y + x);
  }
  return places;
}();

void Tile::append_group(std::uint64_t set, const math::Box<double>& box) {
  PointGroup group;
  group.first = part_.next;
  group.count = static_cast<std::uint32_t>(std::popcount(set));
  group.first_receiver = static_cast<std::uint32_t>(part_.receivers.size());
  group.low = box.low, group.high = box.high;
  group.cell = g_.kernels.fitted_cell(lanes_, bytes_of(set), box, g_.light);
  for (const std::uint8_t k : z_curve)
    if ((set >> k & 1) != 0) g_.out.pixels[part_.next++] = pixel(k);
  for (std::size_t i = 0; i < seen_count_; ++i) {
    const Seen& seen = seen_[i];
    if ((seen.points & set) == 0) continue;
    if (seen.triangle.receiver.triangle == free_point) {
      append_free_receivers(g_, group, part_.receivers);
      continue;
    }
    const double lowest =
        g_.kernels.lowest(lanes_, bytes_of(seen.points & set), seen.triangle.receiver.m, g_.light);
    part_.receivers.push_back(receiver_of(seen.triangle, lowest, group.cell, g_.light));
  }
  group.receiver_count = static_cast<std::uint32_t>(part_.receivers.size()) - group.first_receiver;
  part_.groups.push_back(group);
}

}  // namespace

// Rows of tiles run in parallel; each has room for all of its pixels.
std::span<GroupPart> group_tiles(const Grouping& g, std::vector<GroupPart>& parts) {
  const auto width = static_cast<std::uint32_t>(g.points.width);
  const std::size_t rows = (static_cast<std::size_t>(g.points.height) + tile - 1) / tile;
  if (parts.size() < rows) parts.resize(rows);
  parallel::parallel_tasks(static_cast<int>(rows), [&](int row) {
    GroupPart& part = parts[static_cast<std::size_t>(row)];
    const std::uint32_t top = static_cast<std::uint32_t>(row) * tile;
    part.begin(top * width);
    Tile here(g, part);
    for (std::uint32_t left = 0; left < width; left += tile) here.group(left, top);
  });
  return std::span(parts).first(rows);
}

}  // namespace tenebra::soft
