#include "tint/hard_tint.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"
#include "shadow/tiles/distant_face.h"
#include "tint/tint_kernels.h"

namespace tenebra::tint {
namespace {

using glm::dvec3;

/// Data that the tiles of a light share.
struct Frame {
  const VisiblePoints& points;
  const points::PointTiles& tiles;
  const Panes& panes;
  const PaneTree& tree;
  LazyPlanes& planes;
  const ShadowMask& mask;
  CrossingFrame crossing;
  points::TilePixels pixels;
  RaysCrossing rays_crossing;
};

/// A triangle that rays of a tile cross.
struct Crossed {
  std::uint32_t number, lanes;
};

/// Parts of a block of four by four: of tiles in a square, or of samples in a tile.
constexpr std::uint32_t quarter(int i) {
  return 0x33u << (8 * (i / 2) + 2 * (i % 2));
}

// Fewer triangles than this are tested, more are sought again for each part of the samples: a test of sixteen
// rays takes as long as one or two of eight boxes.
constexpr int few_for_tiles = 16, few_for_samples = 64;

/// Work of one range of squares.
class Worker {
public:
  explicit Worker(const Frame& frame) : f_(frame) {}

  void take_square(const points::PointSquare& square);

  TintMask found;
  TintStats stats;

private:
  trees::BoxShaft shaft_to_light(const math::Box<double>& box) const;
  trees::BoxShaft shaft_of(const points::PointSquare& square, std::uint32_t tiles) const;
  trees::BoxShaft shaft_of_lanes(std::uint32_t lanes) const;
  int seek(const trees::BoxShaft& shaft);
  std::uint32_t lit_lanes(std::uint32_t tile, std::uint32_t lanes) const;
  void take_tiles(const points::PointSquare& square, std::uint32_t tiles);
  void take_tile(std::uint32_t tile, std::uint32_t lanes);
  void take_lanes(std::uint32_t lanes);
  void test(std::uint32_t lanes);
  void load(std::uint32_t tile, std::uint32_t lanes);
  void multiply(std::uint32_t tile);
  glm::vec3 product(int lane);

  const Frame& f_;
  std::uint32_t lit_[16] = {};  ///< lanes of the square's tiles that ask
  std::vector<trees::BlockTriangles> near_;
  std::vector<Crossed> crossed_;
  std::vector<float> factors_[3];
  SampleTile tile_{};
  shadow::TrianglePlanes room_{};
};

/// Of a box from a point, at most: along the axis on which it is farthest.
double least_distance(const math::Box<double>& box, const dvec3& p) {
  const dvec3 d = glm::max(box.low - p, p - box.high);
  return std::max({d.x, d.y, d.z});
}

/// From points in a box to the light.
trees::BoxShaft Worker::shaft_to_light(const math::Box<double>& box) const {
  const shadow::RaySource& source = f_.crossing.source;
  const dvec3 light(source.light);
  if (!source.directional && !source.distant) return trees::shaft_between(box, {light, light});
  // Towards the light until all triangles are passed.
  const math::Box<double>& all = f_.tree.box();
  const dvec3 way = glm::max(glm::abs(all.high - box.low), glm::abs(box.high - all.low));
  const double length = 1.0000001 * std::sqrt(glm::dot(way, way));
  if (source.directional)
    return trees::shaft_between(box, {box.low - source.travel * length, box.high - source.travel * length});
  const double share = length / least_distance(box, light);
  if (!(share < 1)) return trees::shaft_between(box, {light, light});
  return trees::shaft_between(box,
                              {box.low + share * (light - box.low), box.high + share * (light - box.high)});
}

/// From tiles of a square. Their boxes are relative to its base, and a point's q is rounded.
trees::BoxShaft Worker::shaft_of(const points::PointSquare& square, std::uint32_t tiles) const {
  math::Box<double> box;
  for (; tiles != 0; tiles &= tiles - 1) {
    const int i = std::countr_zero(tiles);
    box.add({dvec3(square.low[0][i], square.low[1][i], square.low[2][i]),
             dvec3(square.high[0][i], square.high[1][i], square.high[2][i])});
  }
  const dvec3 base(square.base.at[0], square.base.at[1], square.base.at[2]);
  const dvec3 most = glm::abs(base) + double{square.base.radius};
  const double rounding = 0x1p-22 * square.base.radius + 0x1p-50 * std::max({most.x, most.y, most.z});
  return shaft_to_light({base + box.low - rounding, base + box.high + rounding});
}

/// From samples of the tile that is loaded.
trees::BoxShaft Worker::shaft_of_lanes(std::uint32_t lanes) const {
  math::Box<double> box;
  for (; lanes != 0; lanes &= lanes - 1) box.add(tile_.points[std::countr_zero(lanes)]);
  return shaft_to_light(box);
}

/// Fills near_; returns the number of its triangles.
int Worker::seek(const trees::BoxShaft& shaft) {
  near_.clear();
  f_.tree.find(shaft, near_);
  int triangles = 0;
  for (const trees::BlockTriangles& some : near_) triangles += std::popcount(some.lanes);
  return triangles;
}

std::uint32_t Worker::lit_lanes(std::uint32_t tile, std::uint32_t lanes) const {
  std::uint32_t lit = 0;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    lit |= static_cast<std::uint32_t>(f_.mask[f_.pixels(tile, lane)] != 0) << lane;
  }
  return lit;
}

void Worker::take_square(const points::PointSquare& square) {
  std::uint32_t asking = 0;
  for (std::uint32_t left = square.filled; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    lit_[i] = lit_lanes(square.first_tile + static_cast<std::uint32_t>(i), square.lanes[i]);
    asking |= static_cast<std::uint32_t>(lit_[i] != 0) << i;
  }
  if (asking == 0 || !f_.tree.meets(shaft_of(square, asking))) return;
  for (int i = 0; i < 4; ++i)
    if ((asking & quarter(i)) != 0) take_tiles(square, asking & quarter(i));
}

void Worker::take_tiles(const points::PointSquare& square, std::uint32_t tiles) {
  const trees::BoxShaft around = shaft_of(square, tiles);
  const int triangles = seek(around);
  if (triangles == 0) return;
  for (const std::uint32_t all = tiles; tiles != 0; tiles &= tiles - 1) {
    const int i = std::countr_zero(tiles);
    const std::uint32_t tile = square.first_tile + static_cast<std::uint32_t>(i), alone = 1u << i;
    if (triangles > few_for_tiles && all != alone && seek(shaft_of(square, alone)) == 0) continue;
    take_tile(tile, lit_[i]);
  }
}

/// With the triangles of near_.
void Worker::take_tile(std::uint32_t tile, std::uint32_t lanes) {
  crossed_.clear();
  load(tile, lanes);
  int triangles = 0;
  for (const trees::BlockTriangles& some : near_) triangles += std::popcount(some.lanes);
  if (triangles <= few_for_samples) {
    test(lanes);
  } else {
    for (int i = 0; i < 4; ++i)
      if (const std::uint32_t part = lanes & quarter(i); part != 0) take_lanes(part);
  }
  if (!crossed_.empty()) multiply(tile);
}

/// Up to four samples, those of near_ or fewer: each by itself where that many may be before them.
void Worker::take_lanes(std::uint32_t lanes) {
  if (seek(shaft_of_lanes(lanes)) <= few_for_samples) return test(lanes);
  for (; lanes != 0; lanes &= lanes - 1) {
    const std::uint32_t alone = lanes & -lanes;
    seek(shaft_of_lanes(alone));
    test(alone);
  }
}

/// Adds to crossed_ what rays of `lanes` cross of near_.
void Worker::test(std::uint32_t lanes) {
  for (const trees::BlockTriangles& some : near_) {
    for (std::uint32_t met = some.lanes; met != 0; met &= met - 1) {
      const std::uint32_t number = f_.tree.number(some.block, std::countr_zero(met));
      const shadow::TrianglePlanes& planes = f_.planes.of(number, f_.crossing, room_);
      if (planes.side == 0) continue;
      ++stats.tests;
      LanesFound found_lanes = f_.rays_crossing(planes, tile_);
      found_lanes.sure &= lanes, found_lanes.open &= lanes;
      const std::uint32_t crossing = lanes_crossing(f_.crossing, planes, tile_, found_lanes, stats.exact);
      stats.crossings += static_cast<std::uint64_t>(std::popcount(crossing));
      if (crossing != 0) crossed_.push_back({number, crossing});
    }
  }
}

/// Lanes that do not ask hold a place all the same: the light's.
void Worker::load(std::uint32_t tile, std::uint32_t lanes) {
  std::uint32_t own = no_triangle;
  double tau = 0;
  for (int lane = 0; lane < tile_samples; ++lane) {
    const bool asks = (lanes >> lane & 1u) != 0;
    const std::size_t pixel = asks ? f_.pixels(tile, lane) : 0;
    const dvec3 point = asks ? f_.points.positions[pixel] : f_.crossing.source.origin;
    if (asks && (f_.points.triangles[pixel] != own || own == free_point)) {
      own = f_.points.triangles[pixel];
      tau = f_.crossing.contact == ContactRule::triangle_ids
                ? points::own_tolerance(f_.crossing.triangles, own, point)
                : 0.0;
    }
    const dvec3 p = point - f_.crossing.source.origin;
    tile_.points[lane] = point;
    tile_.own[lane] = own;
    tile_.tau[lane] = tau;
    tile_.x[lane] = p.x, tile_.y[lane] = p.y, tile_.z[lane] = p.z;
    tile_.size[lane] = std::sqrt(glm::dot(p, p));
  }
}

/// In the order of the factors' size: whatever the order in which they were found.
glm::vec3 Worker::product(int lane) {
  for (std::vector<float>& factors : factors_) factors.clear();
  for (const Crossed& c : crossed_) {
    if ((c.lanes >> lane & 1u) == 0) continue;
    glm::vec3 passed = f_.panes.constant(c.number);
    if (f_.panes.varies(c.number)) {
      const shadow::RaySource& source = f_.crossing.source;
      const points::Corners corners = points::corners_of(f_.crossing.triangles, f_.panes.ids()[c.number]);
      const dvec3& from = tile_.points[lane];
      passed = f_.panes.transmittance(
          c.number,
          weights_where(corners.v, from, source.directional ? -source.travel : dvec3(source.light) - from));
    }
    for (int k = 0; k < 3; ++k) factors_[k].push_back(passed[k]);
  }
  glm::vec3 result(1.0f);
  for (int k = 0; k < 3; ++k) {
    std::sort(factors_[k].begin(), factors_[k].end());
    for (const float factor : factors_[k]) result[k] *= factor;
  }
  return result;
}

void Worker::multiply(std::uint32_t tile) {
  std::uint32_t lanes = 0;
  for (const Crossed& c : crossed_) lanes |= c.lanes;
  // One pane of one colour before all of them.
  const bool plain = crossed_.size() == 1 && !f_.panes.varies(crossed_[0].number);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const glm::vec3 factor = plain ? f_.panes.constant(crossed_[0].number) : product(lane);
    if (factor == glm::vec3(1.0f)) continue;
    found.pixels.push_back(static_cast<std::uint32_t>(f_.pixels(tile, lane)));
    found.factors.push_back(factor);
  }
}

shadow::TrianglePlanes planes_seen(std::uint32_t id, const CrossingFrame& frame) {
  const points::Corners c = points::corners_of(frame.triangles, id);
  const int side = shadow::light_side(c.v, frame.source);
  if (side == 0) return {};
  const double tau = frame.contact == ContactRule::triangle_ids ? points::rounding_tolerance(c.v) : 0.0;
  return shadow::planes_of(c.v, id, side, frame.source, tau);
}

}  // namespace

void LazyPlanes::reset(std::span<const std::uint32_t> ids) {
  ids_ = ids;
  planes_.resize(ids.size());
  made_.reset(ids.size());
}

const shadow::TrianglePlanes& LazyPlanes::of(std::uint32_t number, const CrossingFrame& frame,
                                             shadow::TrianglePlanes& room) {
  if (made_.ready(number)) return planes_[number];
  room = planes_seen(ids_[number], frame);
  if (made_.claim(number)) {
    planes_[number] = room;
    made_.publish(number);
  }
  return room;
}

bool HardTint::trace(const VisiblePoints& points, const points::PointTiles& tiles,
                     const TriangleView& triangles, const Panes& panes, const PaneTree& tree,
                     const ShadowLight& light, const ShadowMask& mask, const TintConfig& config,
                     TintMask& out, TintStats& stats, const StopFlag* stop) {
  shadow::RaySource source = shadow::ray_source(light);
  if (const auto face = shadow::distant_face(light, tiles); face && !light.directional)
    source = shadow::distant_source(source, *face);
  planes_.reset(panes.ids());
  const Frame frame{points,
                    tiles,
                    panes,
                    tree,
                    planes_,
                    mask,
                    {triangles, source, config.contact},
                    points::TilePixels(points.width, points.height),
                    rays_crossing(config.simd)};
  std::vector<Worker> workers(tiles.patches.size(), Worker(frame));
  parallel::parallel_in_order(static_cast<int>(workers.size()), [&](int i) {
    Worker& worker = workers[static_cast<std::size_t>(i)];
    for (const points::PointSquare& square : tiles.patches[static_cast<std::size_t>(i)].squares) {
      if (stop_requested(stop)) return;
      worker.take_square(square);
    }
  });
  if (stop_requested(stop)) return false;
  for (const Worker& worker : workers) {
    out.pixels.insert(out.pixels.end(), worker.found.pixels.begin(), worker.found.pixels.end());
    out.factors.insert(out.factors.end(), worker.found.factors.begin(), worker.found.factors.end());
    stats.tests += worker.stats.tests;
    stats.crossings += worker.stats.crossings;
    stats.exact += worker.stats.exact;
  }
  return true;
}

}  // namespace tenebra::tint
