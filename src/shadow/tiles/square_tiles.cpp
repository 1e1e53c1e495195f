#include "shadow/tiles/square_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>

#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;

// A square is a node as it stands if it is at most this many times as wide as its tiles are on the mean: 4
// for a flat patch, with room for perspective and curvature.
constexpr float coherent_extent = 8;
constexpr float shortest_ray = 1e-15f, longest_ray = 1e15f;

std::uint8_t face_of(const dvec3& p) {
  const double x = std::abs(p.x), y = std::abs(p.y), z = std::abs(p.z), largest = std::max({x, y, z});
  const int axis = largest <= x ? 0 : largest <= y ? 1 : 2;
  return static_cast<std::uint8_t>(2 * axis + (p[axis] < 0 ? 1 : 0));
}

/// About the middle of a tile's points.
dvec3 middle_of(const TilePoints& p) {
  return 0.5 * dvec3(p.x[0], p.y[0], p.z[0]) + 0.5 * dvec3(p.x[15], p.y[15], p.z[15]);
}

}  // namespace

/// What is known of the triangles that pixels nearby lie on.
struct SquareSorter::Receivers {
  struct Known {
    std::uint32_t id = no_triangle;
    float tau = 0;
    bool facing = false;
  };
  std::array<Known, 4096> known;
};

/// The sixteen tiles of a square.
struct SquareSorter::Square {
  TilePoints points[square_tiles];
  FaceBox boxes[square_tiles];
  std::uint32_t present = 0;  ///< bits of tiles with rays
  std::uint32_t gaps = 0;     ///< bits of tiles with a gap
};

/// Curve keys, worked out sixteen at a time.
struct SquareSorter::Keys {
  Keys(const RayKernels& k, std::vector<std::uint32_t>& to) : kernels(k), out(to) {}
  const RayKernels& kernels;
  std::vector<std::uint32_t>& out;
  float x[16] = {}, y[16] = {}, z[16] = {};
  std::uint8_t faces[16] = {};
  int size = 0;

  void add(const dvec3& p, std::uint8_t face) {
    x[size] = static_cast<float>(p.x), y[size] = static_cast<float>(p.y), z[size] = static_cast<float>(p.z);
    faces[size] = face;
    if (++size == 16) flush();
  }
  void flush() {
    std::uint32_t keys[16];
    kernels.direction_keys(x, y, z, keys);
    for (int i = 0; i < size; ++i)
      out.push_back((keys[i] & 0x0fffffffu) | static_cast<std::uint32_t>(faces[i]) << 28);
    size = 0;
  }
};

SquareSorter::SquareSorter(const VisiblePoints& points, const ViewRays& view, const TriangleView& triangles,
                           const ShadowLight& light, const RaySource& source, const HardShadowConfig& config)
    : points_(points),
      view_(view),
      triangles_(triangles),
      light_(light),
      source_(source),
      use_tau_(config.contact == ContactRule::triangle_ids),
      bounded_(light.range_m > 0 || light.spot_cos_outer > -1),
      kernels_(tile_kernels(config.simd)),
      ray_kernels_(ray_kernels(config.simd)) {}

/// Rays of a tile before they are loaded.
struct SquareSorter::Lanes {
  std::uint32_t bits = 0;
  float tau = 0;
  std::uint32_t own = no_triangle;  ///< that all of them start on
  std::uint64_t owners = 0;
};

std::size_t SquareSorter::pixel_at(std::uint32_t x, std::uint32_t y, int lane) const {
  return (y + static_cast<std::size_t>(lane / 4)) * static_cast<std::size_t>(points_.width) + x +
         static_cast<std::size_t>(lane % 4);
}

/// Whether triangle `id` faces light and eye; its rounding tolerance, rounded up.
bool SquareSorter::faces(std::uint32_t id, Receivers& receivers, float& tau) const {
  Receivers::Known& known = receivers.known[id % receivers.known.size()];
  if (known.id != id) {
    const Corners c = corners_of(triangles_, id);
    const int side = light_side(c.v, source_);
    known = {id, 0, side != 0 && eye_side(c.v, view_) == -side};
    if (use_tau_) known.tau = std::nextafter(static_cast<float>(rounding_tolerance(c.v)), INFINITY);
  }
  tau = known.tau;
  return known.facing;
}

/// The triangle that all sixteen pixels see; no_triangle: several or none, or pixels outside of the picture.
std::uint32_t SquareSorter::same_triangle(std::uint32_t x, std::uint32_t y) const {
  const auto width = static_cast<std::uint32_t>(points_.width);
  if (x + tile_side > width || y + tile_side > static_cast<std::uint32_t>(points_.height)) return no_triangle;
  const std::uint32_t* const ids = &points_.triangles[pixel_at(x, y, 0)];
  std::uint32_t different = 0;
  for (std::size_t row = 0; row < tile_side; ++row) {
    for (std::size_t column = 0; column < tile_side; ++column)
      different |= ids[row * width + column] ^ ids[0];
  }
  return different == 0 ? ids[0] : no_triangle;
}

SquareSorter::Lanes SquareSorter::active_lanes(std::uint32_t x, std::uint32_t y, Receivers& receivers) const {
  Lanes lanes;
  const std::uint32_t same = same_triangle(x, y);
  if (same < triangles_.triangles.size()) {
    if (faces(same, receivers, lanes.tau)) lanes = {0xffffu, lanes.tau, same, 1ull << (same % 64)};
    return lanes;
  }
  const auto width = static_cast<std::uint32_t>(points_.width),
             height = static_cast<std::uint32_t>(points_.height);
  for (std::uint32_t row = 0; row < tile_side && y + row < height; ++row) {
    for (std::uint32_t column = 0; column < tile_side && x + column < width; ++column) {
      const int lane = static_cast<int>(4 * row + column);
      const std::uint32_t id = points_.triangles[pixel_at(x, y, lane)];
      float tau = 0;
      if (id >= triangles_.triangles.size() || !faces(id, receivers, tau)) continue;
      lanes.own = lanes.bits == 0 || lanes.own == id ? id : no_triangle;
      lanes.tau = std::max(lanes.tau, tau);
      lanes.owners |= 1ull << (id % 64);
      lanes.bits |= 1u << lane;
    }
  }
  return lanes;
}

std::uint32_t SquareSorter::in_reach_lanes(std::uint32_t x, std::uint32_t y, std::uint32_t lanes) const {
  std::uint32_t reached = lanes;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (!in_reach(points_.positions[pixel_at(x, y, lane)] - source_.origin, light_)) reached &= ~(1u << lane);
  }
  return reached;
}

/// Without the lanes whose point is the light itself, which are noted.
std::uint32_t SquareSorter::off_the_light(std::uint32_t x, std::uint32_t y, std::uint32_t lanes,
                                          ForestScratch::Row& out) const {
  std::uint32_t off = lanes;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    if (points_.positions[pixel_at(x, y, lane)] != source_.origin) continue;
    off &= ~(1u << lane);
    out.at_light.push_back(static_cast<std::uint32_t>(pixel_at(x, y, lane)));
  }
  return off;
}

/// Asks for the points of a square that is read soon: the rows of a picture are too far apart for the
/// processor to guess.
void SquareSorter::fetch_square(std::uint32_t x, std::uint32_t y) const {
  const auto height = static_cast<std::uint32_t>(points_.height);
  for (std::uint32_t row = y; row < std::min(y + square_side, height); ++row) {
    const std::size_t first = pixel_at(x, row, 0);
    const auto* const at = reinterpret_cast<const char*>(points_.positions.data() + first);
    for (std::size_t line = 0; line < square_side * sizeof(dvec3); line += 64) __builtin_prefetch(at + line);
    __builtin_prefetch(points_.triangles.data() + first);
  }
}

void SquareSorter::read_square(std::uint32_t x, std::uint32_t y, RayTile* tiles, Receivers& receivers,
                               Square& square, ForestScratch::Row& out) const {
  square.present = square.gaps = 0;
  for (int t = 0; t < square_tiles; ++t) {
    const std::uint32_t tile_x = x + static_cast<std::uint32_t>(t) % 4 * tile_side,
                        tile_y = y + static_cast<std::uint32_t>(t) / 4 * tile_side;
    RayTile& tile = tiles[t];
    tile.live = tile.rays = tile.tests = 0;
    Lanes lanes = active_lanes(tile_x, tile_y, receivers);
    if (bounded_) lanes.bits = in_reach_lanes(tile_x, tile_y, lanes.bits);
    if (lanes.bits == 0) continue;
    const TileRows rows(points_, tile_x, tile_y);
    TilePoints& points = square.points[t];
    kernels_.project(rows, source_.origin, lanes.bits, points);
    if (!(points.nearest > 0)) {
      lanes.bits = off_the_light(tile_x, tile_y, lanes.bits, out);
      if (lanes.bits == 0) continue;
      kernels_.project(rows, source_.origin, lanes.bits, points);
    }
    tile.pixel = static_cast<std::uint32_t>(pixel_at(tile_x, tile_y, 0));
    tile.live = tile.rays = lanes.bits;
    tile.loaded = false;
    tile.tau = lanes.tau;
    out.tau = std::max(out.tau, lanes.tau);
    tile.own = lanes.own;
    tile.owners = lanes.owners;
    square.present |= 1u << t;
    out.rays += static_cast<std::uint64_t>(std::popcount(lanes.bits));
    out.in_range &= points.farthest < longest_ray && points.nearest > shortest_ray;
    if (lanes.own == no_triangle && kernels_.beyond_gap(points, lanes.bits) != 0) square.gaps |= 1u << t;
  }
}

bool SquareSorter::make_node(const RayTile* tiles, std::uint32_t first_tile, Square& square, Keys& keys,
                             ForestScratch::Row& out) const {
  if (square.gaps != 0) return false;
  dvec3 centre(0.0);
  for (std::uint32_t left = square.present; left != 0; left &= left - 1)
    centre += middle_of(square.points[std::countr_zero(left)]);
  const std::uint8_t face = face_of(centre);
  RayNode node;
  float u = 0, v = 0;
  for (std::uint32_t left = square.present; left != 0; left &= left - 1) {
    const int t = std::countr_zero(left);
    if (!kernels_.bound(square.points[t], face, square.boxes[t])) return false;
    u += square.boxes[t].u1 - square.boxes[t].u0, v += square.boxes[t].v1 - square.boxes[t].v0;
    node.set_box(t, square.boxes[t]);
    node.child[t] = first_tile + static_cast<std::uint32_t>(t);
    node.own[t] = tiles[t].own;
  }
  node.live = node.filled = square.present;
  const FaceBox all = bounds_of(node);
  const float scale = coherent_extent / static_cast<float>(std::popcount(square.present));
  if (all.u1 - all.u0 > u * scale || all.v1 - all.v0 > v * scale) return false;
  out.nodes.push_back(node);
  out.node_faces.push_back(face);
  keys.add(centre, face);
  return true;
}

// Splits the tile at gaps, and into single rays where it is off its face. The first part to be done keeps
// the tile's place.
void SquareSorter::loosen_tile(std::uint32_t x, std::uint32_t y, std::uint32_t number,
                               std::vector<RayTile>& tiles, Keys& keys, ForestScratch::Row& out) const {
  RayTile tile = tiles[number];
  const TileRows rows(points_, x, y);
  TilePoints points;
  std::uint32_t parts[tile_rays], size = 0, place = number;
  parts[size++] = tile.rays;
  while (size > 0) {
    const std::uint32_t lanes = parts[--size];
    kernels_.project(rows, source_.origin, lanes, points);
    const std::uint8_t face = face_of(middle_of(points));
    FaceBox box{};
    std::uint32_t beyond = kernels_.beyond_gap(points, lanes);
    if (beyond == 0 && !kernels_.bound(points, face, box)) beyond = lanes & (lanes - 1);
    if (beyond != 0) {
      parts[size++] = beyond;
      parts[size++] = lanes & ~beyond;
      continue;
    }
    tile.live = tile.rays = lanes;
    if (place == number) {
      tiles[number] = tile;
    } else {
      out.split.push_back(tile);
    }
    out.loose.push_back({place, tile.own, face, box});
    keys.add(middle_of(points), face);
    place = static_cast<std::uint32_t>(tiles.size() + out.split.size());
  }
}

void SquareSorter::sort_row(std::uint32_t row, std::vector<RayTile>& tiles, ForestScratch::Row& out) const {
  out.split.clear(), out.nodes.clear(), out.node_faces.clear(), out.node_keys.clear();
  out.loose.clear(), out.loose_keys.clear(), out.at_light.clear();
  out.rays = 0;
  out.tau = 0;
  out.in_range = true;
  const SquareGrid grid(points_.width, points_.height);
  const auto receivers = std::make_unique<Receivers>();
  const auto square = std::make_unique<Square>();
  Keys node_keys(ray_kernels_, out.node_keys), loose_keys(ray_kernels_, out.loose_keys);
  const std::uint32_t y = row * square_side;
  for (std::uint32_t column = 0; column < grid.columns; ++column) {
    const std::uint32_t x = column * square_side, first = (row * grid.columns + column) * square_tiles;
    if (column + 1 < grid.columns) fetch_square(x + square_side, y);
    read_square(x, y, &tiles[first], *receivers, *square, out);
    if (square->present == 0 || make_node(&tiles[first], first, *square, node_keys, out)) continue;
    for (std::uint32_t left = square->present; left != 0; left &= left - 1) {
      const auto t = static_cast<std::uint32_t>(std::countr_zero(left));
      loosen_tile(x + t % 4 * tile_side, y + t / 4 * tile_side, first + t, tiles, loose_keys, out);
    }
  }
  node_keys.flush();
  loose_keys.flush();
}

}  // namespace tenebra
