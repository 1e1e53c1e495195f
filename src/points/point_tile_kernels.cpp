#include "points/point_tile_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "points/point_tile_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h
#include "points/seen_plane-inl.h"
#include "simd/demote16-inl.h"
#include "simd/dispatch.h"
#include "simd/double8-inl.h"
#include "simd/pack_lanes-inl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace tenebra::points::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

namespace {

Vector16 points_of(const PointTile& tile) {
  return {load<Float16>(tile.qx), load<Float16>(tile.qy), load<Float16>(tile.qz)};
}

/// What eight lanes see.
struct Receivers8 {
  Vector8 normal, a, du, dv;
  Double8 height;  ///< n.(a - eye), which rays from one eye share
};

SIMD_INLINE Receivers8 alike(const Receiver& r, const PixelRays& rays) {
  return {broadcast8(r.normal), broadcast8(r.a), broadcast8(r.du), broadcast8(r.dv),
          broadcast8(glm::dot(r.normal, r.a - rays.eye))};
}

/// The receivers of eight lanes from `first` on. Pixels side by side see few different triangles: each is put
/// into all of its lanes at once. Lanes without a point get the first.
SIMD_INLINE Receivers8 gathered(const Receiver* receivers, std::span<const ReceiverLanes> parts,
                                const PixelRays& rays, int first) {
  Receivers8 all = alike(receivers[parts.front().receiver], rays);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::uint32_t lanes = (std::uint32_t{parts[i].lanes} >> first) & 0xffu;
    if (lanes == 0) continue;
    const Receivers8 those = alike(receivers[parts[i].receiver], rays);
    const Mask<double, 8> there = mask_of_bits<double, 8>(lanes);
    all = {select3(there, those.normal, all.normal), select3(there, those.a, all.a),
           select3(there, those.du, all.du), select3(there, those.dv, all.dv),
           select(there, those.height, all.height)};
  }
  return all;
}

// Lanes compare integers as signed ones: with the highest bit flipped these have the order of unsigned ones.
void copy_ids(std::span<const std::uint32_t> ids, std::size_t count, std::uint32_t* to) {
  const auto turned = [](std::uint32_t id) { return static_cast<std::int32_t>(id ^ 0x80000000u); };
  const Int16 none = broadcast<Int16>(-1), highest = broadcast<Int16>(turned(0)),
              end = broadcast<Int16>(
                  turned(static_cast<std::uint32_t>(std::min<std::size_t>(count, no_triangle))));
  std::size_t i = 0;
  for (; i + 16 <= ids.size(); i += 16) {
    std::int32_t sixteen[16];
    std::memcpy(sixteen, &ids[i], sizeof sixteen);
    const Int16 id = load<Int16>(sixteen);
    store(select(gt(end, id ^ highest), id, none), sixteen);
    std::memcpy(to + i, sixteen, sizeof sixteen);
  }
  for (; i < ids.size(); ++i) to[i] = ids[i] < count ? ids[i] : no_triangle;
}

int part_lanes(const std::uint32_t ids[tile_points], std::uint16_t parts[tile_points]) {
  int count = 0;
  for (std::uint32_t left = 0xffffu; left != 0; ++count) {
    const std::uint32_t same = eq_bits(ids, ids[std::countr_zero(left)]);
    parts[count] = static_cast<std::uint16_t>(same);
    left &= ~same;
  }
  return count;
}

/// Points of eight lanes, and the bits of those that lie inside their triangles.
struct Seen8 {
  Vector8 p;
  std::uint32_t inside;
};

/// Two rows of a tile, from pixel `at` on.
SIMD_INLINE Seen8 see_eight(const Receivers8& r, const PixelRays& rays, glm::uvec2 at) {
  alignas(64) static constexpr double column[8] = {0.5, 1.5, 2.5, 3.5, 0.5, 1.5, 2.5, 3.5},
                                      row[8] = {0.5, 0.5, 0.5, 0.5, 1.5, 1.5, 1.5, 1.5};
  const Double8 px = load<Double8>(column) + broadcast8(static_cast<double>(at.x)),
                py = load<Double8>(row) + broadcast8(static_cast<double>(at.y));
  const Vector8 across = px * broadcast8(rays.dx) + py * broadcast8(rays.dy);
  const Vector8 eye = broadcast8(rays.eye), d0 = broadcast8(rays.d0);
  const Vector8 origin = rays.orthographic ? eye + across : eye,
                direction = rays.orthographic ? d0 : d0 + across;
  const Double8 height = rays.orthographic ? dot_unfused(r.normal, r.a - origin) : r.height,
                t = height / dot_unfused(r.normal, direction);
  const Vector8 p = origin + t * direction, from = p - r.a;
  const Double8 u = dot_unfused(r.du, from), v = dot_unfused(r.dv, from);
  const Double8 zero = broadcast<Double8>(0.0), one = broadcast<Double8>(1.0);
  return {p, bits(lt(zero, t) & lt(t, broadcast<Double8>(std::numeric_limits<double>::infinity())) &
                  le(zero, u) & le(zero, v) & le(u + v, one))};
}

/// A tile: the upper two rows and the lower two.
struct Seen16 {
  Seen8 upper, lower;

  std::uint32_t inside() const { return upper.inside | lower.inside << 8; }
};
SIMD_INLINE Seen16 see_tile(const Receiver* receivers, std::span<const ReceiverLanes> parts,
                            const PixelRays& rays, glm::uvec2 at) {
  const glm::uvec2 lower = at + glm::uvec2(0, 2);
  if (parts.size() == 1) {
    const Receivers8 all = alike(receivers[parts.front().receiver], rays);
    return {see_eight(all, rays, at), see_eight(all, rays, lower)};
  }
  return {see_eight(gathered(receivers, parts, rays, 0), rays, at),
          see_eight(gathered(receivers, parts, rays, 8), rays, lower)};
}

/// Bits of all lanes of `parts`, and of those that lie on no plane.
struct PartLanes {
  std::uint32_t all = 0, flat = 0;
};
PartLanes lanes_of(const Receiver* receivers, std::span<const ReceiverLanes> parts) {
  PartLanes lanes;
  for (const ReceiverLanes& part : parts) {
    lanes.all |= part.lanes;
    if (receivers[part.receiver].flat) lanes.flat |= part.lanes;
  }
  return lanes;
}

std::uint32_t see(const Receiver* receivers, std::span<const ReceiverLanes> parts, const PixelRays& rays,
                  glm::uvec2 at, TilePoints& out) {
  const Seen16 seen = see_tile(receivers, parts, rays, at);
  store(seen.upper.p.x, out.x), store(seen.upper.p.y, out.y), store(seen.upper.p.z, out.z);
  store(seen.lower.p.x, out.x + 8), store(seen.lower.p.y, out.y + 8), store(seen.lower.p.z, out.z + 8);
  return seen.inside() & ~lanes_of(receivers, parts).flat;
}

void take(const glm::dvec3* first, std::size_t width, TilePoints& out) {
  for (int row = 0; row < tile_side; ++row, first += width) {
    const Pack3<Double4> p = load3<Double4>(&first->x);
    const int lane = tile_side * row;
    store(p.x, out.x + lane), store(p.y, out.y + lane), store(p.z, out.z + lane);
  }
}

SIMD_INLINE void set_bounds(const Vector16& q, int place, PointSquare& square) {
  const Float16* const axes[3] = {&q.x, &q.y, &q.z};
  for (int axis = 0; axis < 3; ++axis) {
    square.low[axis][place] = reduce_min(*axes[axis]);
    square.high[axis][place] = reduce_max(*axes[axis]);
  }
}

SIMD_INLINE Vector16 select_points(std::uint32_t lanes, const Vector16& a, const Vector16& b) {
  const Mask<float, 16> there = mask_of_bits<float, 16>(lanes);
  return {select(there, a.x, b.x), select(there, a.y, b.y), select(there, a.z, b.z)};
}

/// Lanes that are not in `lanes` get the q of the first that is.
SIMD_INLINE void store_points(Vector16 q, std::uint32_t lanes, PointTile& tile, int place,
                              PointSquare& square) {
  store(q.x, tile.qx), store(q.y, tile.qy), store(q.z, tile.qz);
  if (lanes != 0xffffu) {
    const int first = std::countr_zero(lanes);
    q = select_points(lanes, q, broadcast3<Float16>(tile.qx[first], tile.qy[first], tile.qz[first]));
    store(q.x, tile.qx), store(q.y, tile.qy), store(q.z, tile.qz);
  }
  set_bounds(q, place, square);
}

/// q of two halves.
SIMD_INLINE void set_points(const Vector8& upper, const Vector8& lower, const glm::vec3& base,
                            std::uint32_t lanes, PointTile& tile, int place, PointSquare& square) {
  const Vector8 centre = broadcast8(glm::dvec3(base)), high = upper - centre, low = lower - centre;
  store_points({demoted(high.x, low.x), demoted(high.y, low.y), demoted(high.z, low.z)}, lanes, tile, place,
               square);
}

void fill(const TilePoints& points, const glm::vec3& base, std::uint32_t lanes, PointTile& tile, int place,
          PointSquare& square) {
  const auto half = [&](int first) HWY_ATTR {
    return Vector8{load<Double8>(points.x + first), load<Double8>(points.y + first),
                   load<Double8>(points.z + first)};
  };
  set_points(half(0), half(8), base, lanes, tile, place, square);
}

bool see_whole(const Receiver* receivers, std::span<const ReceiverLanes> parts, const PixelRays& rays,
               glm::uvec2 at, const glm::vec3& base, PointTile& tile, int place, PointSquare& square) {
  const PartLanes lanes = lanes_of(receivers, parts);
  const Seen16 seen = see_tile(receivers, parts, rays, at);
  if ((lanes.all & ~(seen.inside() & ~lanes.flat)) != 0) return false;
  set_points(seen.upper.p, seen.lower.p, base, lanes.all, tile, place, square);
  return true;
}

bool see_plane(const SeenPlane& plane, const RayRows& rows, const SquareEye& eye, glm::uvec2 at,
               PointTile& tile, int place, PointSquare& square, PlaneError& error) {
  const TileMiddle middle(rows, at);
  const Crossing crossing(plane, eye, middle);
  if (!crossing.good || !corners_inside(plane, middle, crossing)) return false;
  const Vector16 q = QSteps(rows, eye, plane, middle, crossing, error).all(TileLanes());
  store(q.x, tile.qx), store(q.y, tile.qy), store(q.z, tile.qz);
  set_bounds(q, place, square);
  return true;
}

bool see_planes(const SeenPlane* const* planes, std::span<const ReceiverLanes> parts, const RayRows& rows,
                const SquareEye& eye, glm::uvec2 at, PointTile& tile, int place, PointSquare& square,
                PlaneError& error) {
  const TileMiddle middle(rows, at);
  const TileLanes lanes;
  PlaneError grown = error;
  Vector16 q = broadcast3<Float16>(0.0f, 0.0f, 0.0f);
  std::uint32_t all = 0;
  for (const ReceiverLanes& part : parts) {
    const SeenPlane& plane = **planes++;
    const Crossing crossing(plane, eye, middle);
    if (!crossing.good || (part.lanes & ~lanes_inside(plane, middle, crossing, lanes)) != 0) return false;
    q = select_points(part.lanes, QSteps(rows, eye, plane, middle, crossing, grown).all(lanes), q);
    all |= part.lanes;
  }
  error = grown;
  store_points(q, all, tile, place, square);
  return true;
}

std::uint32_t beyond_gap(const PointTile& tile, std::uint32_t lanes) {
  const int first = std::countr_zero(lanes);
  const Vector16 apart =
      points_of(tile) - broadcast3<Float16>(tile.qx[first], tile.qy[first], tile.qz[first]);
  const Float16 distance2 =
      select(mask_of_bits<float, 16>(lanes), dot(apart, apart), broadcast<Float16>(0.0f));
  const float farthest2 = reduce_max(distance2);
  if (!(farthest2 > 0)) return 0;
  std::uint32_t nearer[9];
  const auto find_nearer = [&](int k) HWY_ATTR {
    const Float16 limit = broadcast<Float16>(farthest2 * static_cast<float>(k * k) / 64.0f);
    nearer[k] = lt_bits(distance2, limit) & lanes;
  };
  find_nearer(4), find_nearer(5);
  if (nearer[4] != nearer[5]) return 0;  // no gap, as in most: each spans 4/8 to 5/8 of the farthest
  for (const int k : {1, 2, 3, 6, 7, 8}) find_nearer(k);
  for (int k = 1; k <= 4; ++k)
    if (nearer[k] == nearer[k + 4]) return lanes & ~nearer[k];
  return 0;
}

}  // namespace

PointTileKernels point_tile_kernels() {
  return {copy_ids, part_lanes, see_whole, see_plane, see_planes, see, take, fill, beyond_gap};
}

}  // namespace tenebra::points::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tenebra::points {

PointTileKernels point_tile_kernels(SimdLevel level) {
  return TENEBRA_DISPATCH(level, point_tile_kernels)();
}

}  // namespace tenebra::points
#endif
