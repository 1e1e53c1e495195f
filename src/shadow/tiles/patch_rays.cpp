#include "shadow/tiles/patch_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "points/positions.h"
#include "points/triangle_corners.h"
#include "shadow/decision/lifted_points.h"
#include "simd/prefetch.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;

// Boxes with a larger share of a face are met by too many triangles: such squares are divided into tiles, and
// tiles into rays. Seen from a light nearby, neighbouring pixels may lie in all directions; from a distant
// light, far apart only where the picture's pixels are wide.
constexpr float widest_square = 1.0f / 2304, widest_tile = widest_square / 64;
constexpr float widest_distant_square = 1.0f / 256, widest_distant_tile = widest_distant_square / 4;
constexpr std::ptrdiff_t squares_ahead = 4;  // squares: about as long as memory takes

std::uint8_t cube_face_of(const dvec3& p) {
  const double x = std::abs(p.x), y = std::abs(p.y), z = std::abs(p.z), largest = std::max({x, y, z});
  const int axis = largest <= x ? 0 : largest <= y ? 1 : 2;
  return static_cast<std::uint8_t>(2 * axis + (p[axis] < 0 ? 1 : 0));
}

/// Box of a single point on its own face of the cube, with the margins of TileKernels::project.
FaceBox box_of(const dvec3& p, std::uint8_t face) {
  const int axis = face / 2;
  const double z = std::abs(p[axis]);
  constexpr float u = 0x1p-24f;
  const auto pu = static_cast<float>(p[(axis + 1) % 3] / z), pv = static_cast<float>(p[(axis + 2) % 3] / z);
  const auto w = static_cast<float>(1 / z);
  return {pu - 32 * u, pu + 32 * u, pv - 32 * u, pv + 32 * u, w * (1 - 16 * u), w * (1 + 16 * u)};
}

/// The triangle that the points of some lanes lie on; no_triangle: several.
std::uint32_t own_of(const points::PointTile& tile, std::uint32_t lanes) {
  const std::uint32_t first = tile.id[std::countr_zero(lanes)];
  for (std::uint32_t left = lanes; left != 0; left &= left - 1)
    if (tile.id[std::countr_zero(left)] != first) return no_triangle;
  return first;
}

}  // namespace

/// Curve keys, worked out sixteen at a time.
struct PatchRays::Keys {
  Keys(DirectionKeys kernel, const DistantFace* face, std::vector<std::uint32_t>& to)
      : direction_keys(kernel), distant(face), out(to) {}
  DirectionKeys direction_keys;
  const DistantFace* distant;
  std::vector<std::uint32_t>& out;
  float x[16] = {}, y[16] = {}, z[16] = {};
  std::uint8_t faces[16] = {};
  int size = 0;

  void add(const dvec3& from_origin, std::uint8_t face) {
    dvec3 p = from_origin;
    if (distant != nullptr) {  // as a direction through the cube's +Z face
      const dvec3 at = distant->place(p);
      p = {at.x * static_cast<double>(distant->per_extent) / 2.5,
           at.y * static_cast<double>(distant->per_extent) / 2.5, 1};
    }
    x[size] = static_cast<float>(p.x), y[size] = static_cast<float>(p.y), z[size] = static_cast<float>(p.z);
    faces[size] = face;
    if (++size == 16) flush();
  }
  void flush() {
    std::uint32_t keys[16];
    direction_keys(x, y, z, keys);
    for (int i = 0; i < size; ++i)
      out.push_back((keys[i] & 0x0fffffffu) | static_cast<std::uint32_t>(faces[i]) << 28);
    size = 0;
  }
};

/// A square and where its rays go.
struct PatchRays::Work {
  Work(DirectionKeys keys, const DistantFace* distant, ForestScratch::Patch& to)
      : out(to), node_keys(keys, distant, to.node_keys), loose_keys(keys, distant, to.loose_keys) {}
  ForestScratch::Patch& out;
  Keys node_keys, loose_keys;
  const points::PointPatch* patch = nullptr;
  std::size_t mixed = 0;  ///< entries of PointPatch::mixed so far
  const points::PointSquare* square = nullptr;
  std::uint16_t rays[16] = {};
  std::uint32_t present = 0;  ///< bits of tiles with rays
  std::uint32_t gaps = 0;     ///< bits of those with a gap between rays
};

PatchRays::PatchRays(const VisiblePoints& points, const points::PointTiles& tiles,
                     const TriangleView& triangles, const ShadowLight& light, const RaySource& source,
                     const HardShadowConfig& config, const DistantFace* distant)
    : points_(points),
      tiles_(tiles),
      triangles_(triangles),
      light_(light),
      source_(source),
      distant_(distant),
      widest_square_(distant != nullptr ? widest_distant_square : widest_square),
      widest_tile_(distant != nullptr ? widest_distant_tile : widest_tile),
      facing_light_(facing_light(light)),
      pixels_(points.width, points.height),
      bounded_(!light.directional && (light.range_m > 0 || light.spot_cos_outer > -1)),
      smooth_(!triangles.normals.empty() && config.contact == ContactRule::triangle_ids),
      kernels_(tile_kernels(config.simd)),
      point_kernels_(points::point_tile_kernels(config.simd)),
      direction_keys_(direction_keys_kernel(config.simd)) {}

std::uint8_t PatchRays::face_of(const dvec3& p) const {
  return distant_ != nullptr ? distant_face_number : cube_face_of(p);
}

bool PatchRays::project(const points::PointSquare& square, std::uint32_t tiles, std::uint8_t face,
                        RayNode& node, FaceBox& all) const {
  return distant_ != nullptr ? kernels_.project_distant(square, tiles, *distant_, node, all)
                             : kernels_.project(square, tiles, source_.origin, face, node, all);
}

bool PatchRays::bound(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                      std::uint8_t face, FaceBox& box) const {
  if (distant_ == nullptr) return kernels_.bound(tile, base, lanes, source_.origin, face, box);
  kernels_.bound_distant(tile, base, lanes, *distant_, box);
  return true;
}

float PatchRays::area(const FaceBox& box) const {
  const float per_side = distant_ != nullptr ? distant_->per_extent / 2 : 1 / (2 * face_limit);
  return (box.u1 - box.u0) * per_side * ((box.v1 - box.v0) * per_side);
}

/// About the middle of a tile, relative to the origin.
dvec3 PatchRays::centre_of(const points::PointSquare& square, int tile) const {
  dvec3 centre;
  for (int k = 0; k < 3; ++k) {
    const double middle =
        0.5 * static_cast<double>(square.low[k][tile]) + 0.5 * static_cast<double>(square.high[k][tile]);
    centre[k] = static_cast<double>(square.base.at[k]) - source_.origin[k] + middle;
  }
  return centre;
}

dvec3 PatchRays::point_of(const points::PointSquare& square, const points::PointTile& tile, int lane) const {
  return dvec3(square.base.at[0], square.base.at[1], square.base.at[2]) - source_.origin +
         dvec3(tile.qx[lane], tile.qy[lane], tile.qz[lane]);
}

/// Finds the Faces of each receiver.
void PatchRays::find_facing(const points::PointPatch& patch, std::vector<std::uint8_t>& facing) const {
  facing.resize(patch.receivers.size() * 16);
  for (std::size_t b = 0; b < patch.receivers.size(); ++b) {
    const points::ReceiverBlock& block = patch.receivers[b];
    Facing found = kernels_.facing(block, facing_light_);
    for (std::uint32_t i = 0; i < 16; ++i) {
      const std::size_t number = b * 16 + i;
      if (block.id[i] == free_point && number < patch.receiver_count) {
        facing[number] = static_cast<std::uint8_t>(Faces::light);
        continue;
      }
      if (((found.open >> i) & 1u) != 0 && number < patch.receiver_count) {
        const int side = light_side(points::corners_of(triangles_, block.id[i]).v, source_);
        found.facing |= side == -block.side[i] ? 1u << i : 0u;
      }
      Faces faces = ((found.facing >> i) & 1u) != 0 ? Faces::light : Faces::away;
      if (smooth_ && faces == Faces::away && number < patch.receiver_count)
        faces = faces_beyond(triangles_, block.id[i], block.side[i], source_);
      facing[number] = static_cast<std::uint8_t>(faces);
    }
  }
}

/// Those of `lanes`, on several triangles, that face the light.
std::uint32_t PatchRays::facing_lanes(Work& work, std::uint32_t lanes, std::uint32_t tile) const {
  std::uint32_t faced = 0, beyond = 0;
  while (lanes != 0) {
    const points::ReceiverLanes& part = work.patch->mixed[work.mixed++];
    const auto faces = static_cast<Faces>(work.out.facing[part.receiver]);
    if (faces == Faces::light) faced |= part.lanes;
    if (faces == Faces::beyond) beyond |= part.lanes;
    lanes &= ~std::uint32_t{part.lanes};
  }
  return faced | lanes_beyond(beyond, tile);
}

/// Those of `lanes` that see past their triangles; of all of these the light is beyond (Faces::beyond).
std::uint32_t PatchRays::lanes_beyond(std::uint32_t lanes, std::uint32_t tile) const {
  if (lanes == 0) return 0;
  std::uint32_t past = 0;
  points::PositionFinder positions(points_, triangles_);
  points::SideFinder sides(points_, triangles_);
  std::optional<SeesPast> triangle;
  std::uint32_t id = no_triangle;
  int side = 0;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    const std::size_t pixel = pixels_(tile, lane);
    if (id != points_.triangles[pixel] || side != sides.at(pixel)) {
      id = points_.triangles[pixel], side = sides.at(pixel);
      triangle.emplace(triangles_, id, side, source_);
    }
    if (triangle->from(positions.at(pixel))) past |= 1u << lane;
  }
  return past;
}

/// How much of a square the light reaches.
Reach PatchRays::reach_of(const points::PointSquare& square) const {
  if (!bounded_) return Reach::all;
  const dvec3 base(square.base.at[0], square.base.at[1], square.base.at[2]);
  return reach_of_ball(base - dvec3(light_.position), square.base.reach(), light_);
}

std::uint32_t PatchRays::in_reach_lanes(const points::PointSquare& square, int t, std::uint32_t lanes) const {
  const dvec3 extent(square.high[0][t] - square.low[0][t], square.high[1][t] - square.low[1][t],
                     square.high[2][t] - square.low[2][t]);
  // Half of the diagonal, and what q is off, which the square's grain bounds.
  const double radius = 0.5 * glm::length(extent) + 0x1p-20 * double{square.base.grain};
  const dvec3 centre = centre_of(square, t) + (source_.origin - dvec3(light_.position));
  const Reach reach = reach_of_ball(centre, radius, light_);
  if (reach != Reach::some) return reach == Reach::all ? lanes : 0;
  const std::uint32_t tile = square.first_tile + static_cast<std::uint32_t>(t);
  std::uint32_t reached = lanes;
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const int lane = std::countr_zero(left);
    const dvec3 p = visible_position(points_, triangles_, pixels_(tile, lane)) - dvec3(light_.position);
    if (!in_reach(p, light_)) reached &= ~(1u << lane);
  }
  return reached;
}

/// Prefetches the points of tiles with gaps, which are looked at more closely.
void PatchRays::prefetch_gaps(const points::PointSquare& square) const {
  for (std::uint32_t left = square.gaps; left != 0; left &= left - 1)
    simd::prefetch_all(tiles_.tiles[square.first_tile + static_cast<std::uint32_t>(std::countr_zero(left))]);
}

void PatchRays::find_lanes(const points::PointSquare& square, Work& work) const {
  work.square = &square;
  work.present = work.gaps = 0;
  const Reach reach = reach_of(square);
  for (std::uint32_t left = square.filled; left != 0; left &= left - 1) {
    const int t = std::countr_zero(left);
    const std::uint32_t number = square.first_tile + static_cast<std::uint32_t>(t);
    std::uint32_t lanes = square.lanes[t];
    if (square.receiver[t] == points::several_receivers) {
      lanes = facing_lanes(work, lanes, number);
    } else if (const auto faces = static_cast<Faces>(work.out.facing[square.receiver[t]]);
               faces != Faces::light) {
      lanes = faces == Faces::beyond ? lanes_beyond(lanes, number) : 0;
    }
    if (reach == Reach::none) lanes = 0;
    if (reach == Reach::some && lanes != 0) lanes = in_reach_lanes(square, t, lanes);
    work.rays[t] = static_cast<std::uint16_t>(lanes);
    if (lanes == 0) continue;
    work.present |= 1u << t;
    work.out.rays += lanes == 0xffffu ? 16u : static_cast<std::uint64_t>(std::popcount(lanes));
    // Points that are left out may leave a gap.
    const bool fewer = square.receiver[t] == points::several_receivers && lanes != square.lanes[t];
    const bool gap =
        fewer ? point_kernels_.beyond_gap(tiles_.tiles[number], lanes) != 0 : ((square.gaps >> t) & 1u) != 0;
    if (gap) work.gaps |= 1u << t;
  }
}

/// Gives the square's tiles to the next node, whose boxes are already there.
void PatchRays::add_node(Work& work, std::uint8_t face) const {
  const points::PointSquare& square = *work.square;
  RayNode& node = work.out.nodes[work.out.count++];
  node.live = node.filled = node.wide = work.present;  // boxes along the axes: shrunk where that pays
  for (std::uint32_t i = 0; i < 16; ++i) node.child[i] = square.first_tile + i;
  std::copy(std::begin(square.own), std::end(square.own), node.own);
  std::copy(std::begin(work.rays), std::end(work.rays), node.rays);
  std::copy(std::begin(work.rays), std::end(work.rays), node.all_rays);
  node.tau = square.tau;
  node.tests = 0;
  work.node_keys.add(centre_of(square, std::countr_zero(work.present)), face);
}

void PatchRays::add_ray(Work& work, int tile, int lane) const {
  const std::uint32_t number = work.square->first_tile + static_cast<std::uint32_t>(tile);
  const std::size_t pixel = pixels_(number, lane);
  if (distant_ != nullptr) {
    const points::PointTile& from = tiles_.tiles[number];
    FaceBox box{};
    bound(from, work.square->base, 1u << lane, distant_face_number, box);
    work.out.loose.push_back(
        {number, work.square->own[tile], static_cast<std::uint16_t>(1u << lane), work.square->tau, box});
    return work.loose_keys.add(point_of(*work.square, from, lane), distant_face_number);
  }
  const dvec3 p = visible_position(points_, triangles_, pixel) - source_.origin;
  const double size = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (size == 0) {
    work.out.at_light.push_back(static_cast<std::uint32_t>(pixel));
    --work.out.rays;
    return;
  }
  work.out.in_range &= size > shortest_ray && size < longest_ray;
  const std::uint8_t face = face_of(p);
  work.out.loose.push_back({number, work.square->own[tile], static_cast<std::uint16_t>(1u << lane),
                            work.square->tau, box_of(p, face)});
  work.loose_keys.add(p, face);
}

/// Splits a tile at its gaps, and into single rays where it is off its face or wide.
void PatchRays::add_parts(Work& work, int tile) const {
  const points::PointSquare& square = *work.square;
  const std::uint32_t number = square.first_tile + static_cast<std::uint32_t>(tile);
  const points::PointTile& points = tiles_.tiles[number];
  std::uint32_t parts[points::tile_points], size = 0;
  parts[size++] = work.rays[tile];
  while (size > 0) {
    const std::uint32_t lanes = parts[--size];
    const std::uint32_t beyond =
        ((work.gaps >> tile) & 1u) != 0 ? point_kernels_.beyond_gap(points, lanes) : 0;
    if (beyond != 0) {
      parts[size++] = beyond;
      parts[size++] = lanes & ~beyond;
      continue;
    }
    const dvec3 centre = 0.5 * (point_of(square, points, std::countr_zero(lanes)) +
                                point_of(square, points, 31 - std::countl_zero(lanes)));
    const std::uint8_t face = face_of(centre);
    FaceBox box{};
    if (bound(points, square.base, lanes, face, box) && area(box) <= widest_tile_) {
      const bool one = square.receiver[tile] != points::several_receivers;
      work.out.loose.push_back({number, one ? square.own[tile] : own_of(points, lanes),
                                static_cast<std::uint16_t>(lanes), square.tau, box});
      work.loose_keys.add(centre, face);
      continue;
    }
    for (std::uint32_t left = lanes; left != 0; left &= left - 1) add_ray(work, tile, std::countr_zero(left));
  }
}

void PatchRays::place_square(Work& work) const {
  if (work.gaps == 0) {
    const std::uint8_t face = face_of(centre_of(*work.square, std::countr_zero(work.present)));
    FaceBox& box = work.out.boxes[work.out.count];
    if (project(*work.square, work.present, face, work.out.nodes[work.out.count], box) &&
        area(box) <= widest_square_) {
      return add_node(work, face);
    }
  }
  for (std::uint32_t left = work.present; left != 0; left &= left - 1)
    add_parts(work, std::countr_zero(left));
}

void PatchRays::find(const points::PointPatch& patch, ForestScratch::Patch& out) const {
  out.clear();
  find_facing(patch, out.facing);
  Work work(direction_keys_, distant_, out);
  work.patch = &patch;
  for (const points::PointSquare& square : patch.squares) {
    const std::ptrdiff_t after = &patch.squares.back() - &square;
    if (after >= 2 * squares_ahead) simd::prefetch_all(*(&square + 2 * squares_ahead));
    if (after >= squares_ahead) prefetch_gaps(*(&square + squares_ahead));
    find_lanes(square, work);
    if (work.present == 0) continue;
    out.tau = std::max(out.tau, square.tau);
    double farthest = square.base.radius;
    for (int k = 0; k < 3; ++k) {
      const double base = std::abs(static_cast<double>(square.base.at[k]) - source_.origin[k]);
      farthest = std::max(farthest, base + static_cast<double>(square.base.radius));
    }
    out.in_range &= distant_ != nullptr || farthest < longest_ray;
    if (out.in_range) place_square(work);
  }
  for (std::size_t i = out.count; i < points::patch_squares; ++i) out.nodes[i].live = out.nodes[i].filled = 0;
  work.node_keys.flush();
  work.loose_keys.flush();
}

}  // namespace tenebra::shadow
