#include "soft/point_groups.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "parallel/parallel.h"
#include "soft/group_tree.h"
#include "soft/point_lanes.h"

namespace tenebra {

namespace {

constexpr std::uint32_t tile = 8;  // pixels a side
static_assert(tile * tile == largest_neighbourhood);

// What all groups of a frame are made from.
struct Grouping {
  const VisiblePoints& points;
  const ViewRays& view;
  const TriangleView& triangles;
  const LightShape light;
  const PointKernels kernels;
  PointGroups& out;
};

// Groups of a part of the picture; its points go where the caller says.
struct Part {
  std::vector<PointGroup> groups;
  std::vector<Receiver> receivers;
  std::uint32_t next = 0;  // place of the next point in PointGroups
};

// What is known of triangles, by the id's last bits.
class KnownTriangles {
public:
  const LitTriangle& operator()(const Grouping& g, std::uint32_t id) {
    LitTriangle& lit = known_[id % known_.size()];
    if (id != lit.receiver.triangle) lit = lit_triangle(g.triangles, id, g.view, g.light);
    return lit;
  }

private:
  std::array<LitTriangle, 64> known_;
};

// A set of 64 points, eight a byte.
std::array<std::uint8_t, 8> bytes_of(std::uint64_t set) {
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>(set >> (8 * i));
  return bytes;
}

// A square of the picture: point 8 y + x is its pixel (x, y).
class Tile {
public:
  Tile(const Grouping& grouping, Part& part) : g_(grouping), part_(part) {
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
  void append_split(std::uint64_t set);
  void append_group(std::uint64_t set, const PointBox& box);
  std::uint32_t pixel(std::uint32_t k) const { return first_ + k / tile * width() + k % tile; }
  std::uint32_t width() const { return static_cast<std::uint32_t>(g_.points.width); }

  const Grouping& g_;
  Part& part_;
  KnownTriangles known_;
  PointLanes lanes_;
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

// Fills seen_; returns the active points.
std::uint64_t Tile::find_receivers() {
  seen_count_ = 0;
  std::uint64_t active = 0;
  for (std::uint64_t rest = g_.kernels.in_front(lanes_, g_.light, 0); rest != 0;) {
    const std::uint32_t id = ids_[static_cast<std::size_t>(std::countr_zero(rest))];
    const std::uint64_t here = rest & g_.kernels.equal(ids_.data(), id);
    rest &= ~here;
    if (id >= g_.triangles.triangles.size()) continue;
    const LitTriangle& triangle = known_(g_, id);
    if (!triangle.light_above) continue;
    active |= here;
    std::size_t place = seen_count_++;
    for (; place > 0 && seen_[place - 1].triangle.receiver.triangle > id; --place)
      seen_[place] = seen_[place - 1];
    seen_[place] = {triangle, here};
  }
  return active;
}

// Splits where five of sixteen slices across the longest side are empty: rows of pixels evenly spaced along
// it leave at most two, so this is a gap in depth.
constexpr int slices_of_a_gap = 5;

// The last slice of the first gap, or 0.
int gap_of(std::uint32_t taken) {
  int run = 0;
  for (int k = 0; k < Slices::count; ++k) {
    run = (taken >> k & 1) != 0 ? 0 : run + 1;
    if (run == slices_of_a_gap) return k;
  }
  return 0;
}

void Tile::append_split(std::uint64_t set) {
  const PointBox box = g_.kernels.box(lanes_, bytes_of(set));
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

void Tile::append_group(std::uint64_t set, const PointBox& box) {
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
    const double lowest =
        g_.kernels.lowest(lanes_, bytes_of(seen.points & set), seen.triangle.receiver.m, g_.light);
    part_.receivers.push_back(receiver_of(seen.triangle, lowest, group.cell, g_.light));
  }
  group.receiver_count = static_cast<std::uint32_t>(part_.receivers.size()) - group.first_receiver;
  part_.groups.push_back(group);
}

// Pixels by triangle, each triangle's in row order (counting sort): those of triangle k end at ends[k].
struct PixelsByTriangle {
  std::vector<std::uint32_t> pixels, ends;
};
PixelsByTriangle pixels_by_triangle(const VisiblePoints& points, std::size_t triangle_count) {
  PixelsByTriangle by;
  by.ends.assign(triangle_count + 1, 0);
  for (const std::uint32_t id : points.triangles)
    if (id < triangle_count) ++by.ends[id + 1];
  std::partial_sum(by.ends.begin(), by.ends.end(), by.ends.begin());
  by.pixels.resize(by.ends.back());
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    const std::uint32_t id = points.triangles[i];
    if (id < triangle_count) by.pixels[by.ends[id]++] = static_cast<std::uint32_t>(i);
  }
  return by;
}

// Takes over the groups of all parts, in the order of the tree.
void join(std::span<Part> parts, PointGroups& out) {
  std::size_t groups = 0, receivers = 0;
  for (const Part& part : parts) groups += part.groups.size(), receivers += part.receivers.size();
  std::vector<GroupKey> keys;
  keys.reserve(groups);
  out.receivers.reserve(receivers);
  for (Part& part : parts) {
    const auto first_receiver = static_cast<std::uint32_t>(out.receivers.size());
    for (PointGroup& group : part.groups) {
      group.first_receiver += first_receiver;
      keys.push_back({glm::vec3(0.5 * (group.low + group.high)), &group});
    }
    out.receivers.insert(out.receivers.end(), part.receivers.begin(), part.receivers.end());
  }
  build_group_tree(keys, out);
}

// The active ones of a triangle's pixels, as one group.
void append_triangle(const Grouping& g, std::span<const std::uint32_t> pixels, const LitTriangle& triangle,
                     PointLanes& lanes, Part& part) {
  const std::size_t packs = (pixels.size() + 63) / 64 * 8;
  lanes.resize(8 * packs);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    lanes.put(i, g.points.positions[pixels[i]]);
    lanes.column[i] = static_cast<float>(pixels[i] % static_cast<std::uint32_t>(g.points.width));
    lanes.row[i] = static_cast<float>(pixels[i] / static_cast<std::uint32_t>(g.points.width));
  }
  std::vector<std::uint8_t> set;
  PointGroup group;
  group.first = part.next;
  for (std::size_t first = 0; first < pixels.size(); first += 64) {
    const std::size_t there = std::min<std::size_t>(64, pixels.size() - first);
    const std::uint64_t active =
        g.kernels.in_front(lanes, g.light, first) & (~std::uint64_t{0} >> (64 - there));
    for (const std::uint8_t byte : bytes_of(active)) set.push_back(byte);
    for (std::size_t k = 0; k < there; ++k)
      if ((active >> k & 1) != 0) g.out.pixels[part.next++] = pixels[first + k];
  }
  group.count = part.next - group.first;
  if (group.count == 0) return;
  const PointBox box = g.kernels.box(lanes, set);
  group.low = box.low, group.high = box.high;
  group.cell = g.kernels.fitted_cell(lanes, set, box, g.light);
  group.first_receiver = static_cast<std::uint32_t>(part.receivers.size());
  group.receiver_count = 1;
  const double lowest = g.kernels.lowest(lanes, set, triangle.receiver.m, g.light);
  part.receivers.push_back(receiver_of(triangle, lowest, group.cell, g.light));
  part.groups.push_back(group);
}

void group_by_triangle(const Grouping& g) {
  const PixelsByTriangle by = pixels_by_triangle(g.points, g.triangles.triangles.size());
  Part part;
  PointLanes lanes;
  std::uint32_t first = 0;
  for (std::uint32_t id = 0; id < g.triangles.triangles.size(); ++id) {
    const std::span<const std::uint32_t> pixels(by.pixels.data() + first, by.ends[id] - first);
    first = by.ends[id];
    if (pixels.empty()) continue;
    const LitTriangle triangle = lit_triangle(g.triangles, id, g.view, g.light);
    if (triangle.light_above) append_triangle(g, pixels, triangle, lanes, part);
  }
  join({&part, 1}, g.out);
}

// Rows of tiles run in parallel; each has room for all of its pixels.
void group_tiles(const Grouping& g) {
  const auto width = static_cast<std::uint32_t>(g.points.width);
  std::vector<Part> parts((static_cast<std::size_t>(g.points.height) + tile - 1) / tile);
  parallel_tasks(static_cast<int>(parts.size()), [&](int row) {
    Part& part = parts[static_cast<std::size_t>(row)];
    const std::uint32_t top = static_cast<std::uint32_t>(row) * tile;
    part.next = top * width;
    Tile here(g, part);
    for (std::uint32_t left = 0; left < width; left += tile) here.group(left, top);
  });
  join(parts, g.out);
}

}  // namespace

void group_points(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                  const AreaLight& light, SoftGrouping grouping, PointGroups& out, SimdLevel simd) {
  const FloatEnvironment ieee;
  out.width = points.width;
  out.receivers.clear();
  out.pixels.resize(points.triangles.size());
  const Grouping g{points, view, triangles, LightShape(light), point_kernels(simd), out};
  if (grouping == SoftGrouping::triangle) {
    group_by_triangle(g);
  } else {
    group_tiles(g);
  }
}

}  // namespace tenebra
