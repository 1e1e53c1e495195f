#include "tint/hard_tint.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/parallel.h"
#include "points/contact_rule.h"
#include "points/triangle_corners.h"

namespace tenebra::tint {
namespace {

using glm::dvec3;

/// What the tiles of a light share.
struct Frame {
  const VisiblePoints& points;
  const points::PointTiles& tiles;
  const Surfaces& surfaces;
  const TriangleTree& tree;
  const std::vector<shadow::TrianglePlanes>& planes;
  const ShadowMask& mask;
  CrossingFrame crossing;
  points::TilePixels pixels;
};

/// A triangle that rays of a tile cross.
struct Crossed {
  std::uint32_t number, lanes;
};

/// Work of one range of squares.
class Worker {
public:
  explicit Worker(const Frame& frame) : f_(frame) {}

  void take_square(const points::PointSquare& square);

  TintMask found;
  TintStats stats;

private:
  Shaft shaft_of(const points::PointSquare& square, const glm::dvec3& low, const glm::dvec3& high) const;
  std::uint32_t lit_lanes(std::uint32_t tile, std::uint32_t lanes) const;
  void take_tile(std::uint32_t tile, std::uint32_t lanes, const Shaft& shaft);
  void load(std::uint32_t tile, std::uint32_t lanes);
  void multiply(std::uint32_t tile);
  glm::vec3 product(int lane);

  const Frame& f_;
  std::vector<TriangleTree::Found> near_;
  std::vector<Crossed> crossed_;
  std::vector<float> factors_[3];
  SampleTile tile_;
};

/// From points in a box, relative to the square's base, to the light. A point's q is rounded.
Shaft Worker::shaft_of(const points::PointSquare& square, const dvec3& low, const dvec3& high) const {
  const dvec3 base(square.base.at[0], square.base.at[1], square.base.at[2]);
  const dvec3 most = glm::abs(base) + double{square.base.radius};
  const double rounding = 0x1p-22 * square.base.radius + 0x1p-50 * std::max({most.x, most.y, most.z});
  const Box box{base + low - rounding, base + high + rounding};
  const shadow::RaySource& source = f_.crossing.source;
  if (!source.directional) return shaft_between(box, {dvec3(source.light), dvec3(source.light)});
  // Towards the light until all triangles are passed.
  const Box& all = f_.tree.box();
  const dvec3 way = glm::max(glm::abs(all.high - box.low), glm::abs(box.high - all.low));
  const dvec3 far = -source.travel * (1.0000001 * std::sqrt(glm::dot(way, way)));
  return shaft_between(box, {box.low + far, box.high + far});
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
  const auto corner = [](const float(&at)[3][16], int i) { return dvec3(at[0][i], at[1][i], at[2][i]); };
  dvec3 low(INFINITY), high(-INFINITY);
  std::uint32_t lit[16] = {}, any_lit = 0;
  for (std::uint32_t left = square.filled; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    lit[i] = lit_lanes(square.first_tile + static_cast<std::uint32_t>(i), square.lanes[i]);
    if (lit[i] == 0) continue;
    any_lit |= 1u << i;
    low = glm::min(low, corner(square.low, i)), high = glm::max(high, corner(square.high, i));
  }
  if (any_lit == 0) return;
  near_.clear();
  f_.tree.find(shaft_of(square, low, high), near_);
  if (near_.empty()) return;
  for (; any_lit != 0; any_lit &= any_lit - 1) {
    const int i = std::countr_zero(any_lit);
    take_tile(square.first_tile + static_cast<std::uint32_t>(i), lit[i],
              shaft_of(square, corner(square.low, i), corner(square.high, i)));
  }
}

void Worker::take_tile(std::uint32_t tile, std::uint32_t lanes, const Shaft& shaft) {
  crossed_.clear();
  bool loaded = false;
  for (const TriangleTree::Found& leaf : near_) {
    for (std::uint32_t met = f_.tree.narrowed(leaf, shaft); met != 0; met &= met - 1) {
      const std::uint32_t number = f_.tree.number(leaf.leaf, std::countr_zero(met));
      if (f_.planes[number].side == 0) continue;
      if (!loaded) load(tile, lanes);
      loaded = true;
      ++stats.tests;
      const std::uint32_t crossing = lanes_crossing(f_.crossing, f_.planes[number], tile_, stats.exact);
      stats.crossings += static_cast<std::uint64_t>(std::popcount(crossing));
      if (crossing != 0) crossed_.push_back({number, crossing});
    }
  }
  if (!crossed_.empty()) multiply(tile);
}

/// Lanes that do not ask hold a place all the same: the light's.
void Worker::load(std::uint32_t tile, std::uint32_t lanes) {
  tile_.lanes = lanes;
  std::uint32_t own = no_triangle;
  double tau = 0;
  for (int lane = 0; lane < tile_samples; ++lane) {
    const bool asks = (lanes >> lane & 1u) != 0;
    const std::size_t pixel = asks ? f_.pixels(tile, lane) : 0;
    const dvec3 point = asks ? f_.points.positions[pixel] : f_.crossing.source.origin;
    if (asks && f_.points.triangles[pixel] != own) {
      own = f_.points.triangles[pixel];
      tau = f_.crossing.contact == ContactRule::triangle_ids
                ? points::rounding_tolerance(points::corners_of(f_.crossing.triangles, own).v)
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
    glm::vec3 passed = f_.surfaces.constant(c.number);
    if (f_.surfaces.varies(c.number)) {
      const shadow::RaySource& source = f_.crossing.source;
      const points::Corners corners = points::corners_of(f_.crossing.triangles, f_.planes[c.number].triangle);
      const dvec3& from = tile_.points[lane];
      passed = f_.surfaces.transmittance(
          c.number,
          weights_where(corners.v, from, source.directional ? -source.travel : source.origin - from));
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
  const bool plain = crossed_.size() == 1 && !f_.surfaces.varies(crossed_[0].number);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const glm::vec3 factor = plain ? f_.surfaces.constant(crossed_[0].number) : product(lane);
    if (factor == glm::vec3(1.0f)) continue;
    found.pixels.push_back(static_cast<std::uint32_t>(f_.pixels(tile, lane)));
    found.factors.push_back(factor);
  }
}

void set_up_planes(const Surfaces& surfaces, const TriangleView& triangles, const shadow::RaySource& source,
                   ContactRule contact, std::vector<shadow::TrianglePlanes>& out) {
  out.resize(surfaces.ids().size());
  parallel::parallel_ranges(out.size(), 512, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t id = surfaces.ids()[i];
      const points::Corners c = points::corners_of(triangles, id);
      const int side = shadow::light_side(c.v, source);
      out[i] = {};
      if (side == 0) continue;
      const double tau = contact == ContactRule::triangle_ids ? points::rounding_tolerance(c.v) : 0.0;
      out[i] = shadow::planes_of(c.v, id, side, source, tau);
    }
  });
}

}  // namespace

void HardTint::trace(const VisiblePoints& points, const points::PointTiles& tiles,
                     const TriangleView& triangles, const Surfaces& surfaces, const TriangleTree& tree,
                     const ShadowLight& light, const ShadowMask& mask, ContactRule contact, TintMask& out,
                     TintStats& stats) {
  const shadow::RaySource source = shadow::ray_source(light);
  set_up_planes(surfaces, triangles, source, contact, planes_);
  const Frame frame{points,
                    tiles,
                    surfaces,
                    tree,
                    planes_,
                    mask,
                    {triangles, source, contact},
                    points::TilePixels(points.width, points.height)};
  std::vector<Worker> workers(tiles.patches.size(), Worker(frame));
  parallel::parallel_in_order(static_cast<int>(workers.size()), [&](int i) {
    Worker& worker = workers[static_cast<std::size_t>(i)];
    for (const points::PointSquare& square : tiles.patches[static_cast<std::size_t>(i)].squares)
      worker.take_square(square);
  });
  for (const Worker& worker : workers) {
    out.pixels.insert(out.pixels.end(), worker.found.pixels.begin(), worker.found.pixels.end());
    out.factors.insert(out.factors.end(), worker.found.factors.begin(), worker.found.factors.end());
    stats.tests += worker.stats.tests;
    stats.crossings += worker.stats.crossings;
    stats.exact += worker.stats.exact;
  }
}

}  // namespace tenebra::tint
