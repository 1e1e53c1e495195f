#include "points/patch_maker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "points/contact_rule.h"
#include "simd/prefetch.h"

namespace tenebra::points {
namespace {

using glm::dvec3;

constexpr std::uint32_t no_plane = 0xffffffffu;
constexpr std::size_t most_planes = 3;
constexpr std::uint32_t many_receivers = 8;  // in one square: scanning the next one pays from here on

/// >= |q| of a square's points: the farthest corner of the box around all tiles. Floats' squares in double
/// neither overflow nor vanish; what is rounded is far below 2^-20, or the least float.
float radius_of(const PointSquare& square) {
  double squares = 0;
  for (int axis = 0; axis < 3; ++axis) {
    float largest = 0;
    for (std::uint32_t left = square.filled; left != 0; left &= left - 1) {
      const int t = std::countr_zero(left);
      largest = std::max(largest, std::max(-square.low[axis][t], square.high[axis][t]));
    }
    squares += static_cast<double>(largest) * static_cast<double>(largest);
  }
  return static_cast<float>(std::sqrt(squares)) * (1 + 0x1p-20f) + 0x1p-149f;
}

}  // namespace

/// On which side of the triangle the view's eye is, as eye_side(). In double n.v of float differences carries
/// nine roundings in each of its three products and two in their sums: it is off by less than 2^-46
/// |e1||e2||v|, whose squares no floats take out of the range of doubles.
int PatchMaker::side_of(const Receiver& r, const Corners& c, double squares) const {
  const dvec3 to_eye = view_.orthographic ? -dvec3(view_.d0) : dvec3(view_.eye) - r.a;
  const double value = glm::dot(r.normal, to_eye);
  if (value * value > 0x1p-92 * squares * glm::dot(to_eye, to_eye)) return value > 0 ? 1 : -1;
  return eye_side(c.v, view_);
}

// n / |n| in double is off by less than 2^-48 |e1||e2| / |n|; rounding it, the difference p - a and the
// products add less than 16 u of |p - a|. Rounding up: a float is off by u, as its product is, or by less
// than the least float.
std::uint16_t PatchMaker::add_receiver(std::uint32_t id, int stored_side) {
  const Corners c = corners_of(triangles_, id);
  const Receiver r = points::receiver_of(triangles_, id);
  const double squares = glm::dot(r.e1, r.e1) * glm::dot(r.e2, r.e2);
  const int side = points_.sides.empty() ? side_of(r, c, squares) : stored_side;
  if (side == 0) return no_receiver;
  const std::uint32_t number = patch_.receiver_count++;
  if (number % 16 == 0) patch_.receivers.emplace_back();
  ReceiverBlock& block = patch_.receivers.back();
  const std::uint32_t i = number % 16;
  const double length = glm::length(r.normal);
  const dvec3 unit = length > 0 ? r.normal * (side / length) : dvec3(0);
  block.nx[i] = static_cast<float>(unit.x), block.ny[i] = static_cast<float>(unit.y);
  block.nz[i] = static_cast<float>(unit.z);
  block.ax[i] = c.v[0].x, block.ay[i] = c.v[0].y, block.az[i] = c.v[0].z;
  const double slack = 16 * 0x1p-24 + 0x1p-47 * std::sqrt(squares) / length;
  block.slack[i] = slack < 1 ? static_cast<float>(slack) : 2.0f;
  block.tau[i] = static_cast<float>(rounding_tolerance(c.v)) * (1 + 0x1p-22f) + 0x1p-149f;
  block.id[i] = id;
  block.side[i] = static_cast<std::int8_t>(side);
  if (from_view_) receivers_.push_back(r), plane_numbers_.push_back(no_plane);
  if (from_view_ && !triangles_.normals.empty()) smooth_.push_back(smooth_surface(triangles_, id, side));
  return static_cast<std::uint16_t>(number);
}

/// All free points have one receiver: it has no plane, and note_free() finds their tolerances.
std::uint16_t PatchMaker::add_free_receiver() {
  const std::uint32_t number = patch_.receiver_count++, i = number % 16;
  if (i == 0) patch_.receivers.emplace_back();
  ReceiverBlock& block = patch_.receivers.back();
  block.slack[i] = 2;
  block.id[i] = free_point;
  block.side[i] = 1;
  if (from_view_) receivers_.emplace_back(), plane_numbers_.push_back(no_plane);
  if (from_view_ && !triangles_.normals.empty()) smooth_.emplace_back();
  return static_cast<std::uint16_t>(number);
}

/// `side`: where sides are stored.
std::uint16_t PatchMaker::receiver_of(std::uint32_t id, int side) {
  if (!is_point(id)) return no_receiver;
  if (last_.id == id && last_.side == side) return last_.number;
  Known& known = known_[id % known_.size()];
  if (known.id != id || known.side != side)
    known = {id, static_cast<std::int8_t>(side),
             id == free_point ? add_free_receiver() : add_receiver(id, side)};
  last_ = known;
  return known.number;
}

/// Adds lanes on one triangle of the tile at (x, y) by the sides that are stored.
void PatchMaker::add_sides(std::uint32_t id, std::uint32_t lanes, std::uint32_t x, std::uint32_t y,
                           Seen& seen) {
  std::uint32_t of[2] = {0, 0};  // in front, behind
  for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const int side = points_.sides[std::size_t{y + lane / tile_side} * width_ + x + lane % tile_side];
    if (side != 0) of[side < 0 ? 1 : 0] |= 1u << lane;
  }
  if (of[0] != 0) seen.add(receiver_of(id, 1), of[0]);
  if (of[1] != 0) seen.add(receiver_of(id, -1), of[1]);
}

void PatchMaker::prefetch_corners(std::uint32_t x, std::uint32_t y) {
  const std::uint32_t added = patch_.receiver_count - receivers_before_;
  receivers_before_ = patch_.receiver_count;
  if (added < many_receivers) return;
  std::uint32_t last = no_triangle;
  for (std::uint32_t row = y; row < std::min(y + square_side, height_); row += 2) {
    const std::uint32_t* const ids = ids_at(0, row);
    for (std::uint32_t column = x; column < std::min(x + square_side, width_); column += 2) {
      const std::uint32_t id = ids[column];
      if (id == last || id >= triangles_.triangles.size()) continue;
      last = id;
      const glm::uvec3& t = triangles_.triangles[id];
      for (int k = 0; k < 3; ++k) simd::prefetch(&triangles_.positions[t[k]]);
    }
  }
}

/// Whether all sixteen pixels, which are in the picture, see the same triangle.
bool PatchMaker::one_receiver(std::uint32_t x, std::uint32_t y) const {
  const std::uint32_t* const ids = ids_at(x, y);
  const std::uint64_t twice = std::uint64_t{ids[0]} << 32 | ids[0];
  std::uint64_t different = 0;
  for (std::size_t row = 0; row < tile_side; ++row) {
    std::uint64_t pairs[2];
    std::memcpy(pairs, ids + row * width_, sizeof pairs);
    different |= (pairs[0] ^ twice) | (pairs[1] ^ twice);
  }
  return different == 0;
}

void PatchMaker::find_receivers(std::uint32_t x, std::uint32_t y, Seen& seen) {
  seen.lanes = 0, seen.count = 0;
  if (x >= width_ || y >= height_) return;
  const bool whole = x + tile_side <= width_ && y + tile_side <= height_;
  const bool sides = !points_.sides.empty();
  if (whole && !sides && one_receiver(x, y)) return seen.add(receiver_of(*ids_at(x, y)), 0xffffu);
  if (!whole) std::fill(std::begin(seen.ids), std::end(seen.ids), no_triangle);
  const std::uint32_t columns = std::min<std::uint32_t>(tile_side, width_ - x),
                      rows = std::min<std::uint32_t>(tile_side, height_ - y);
  for (std::uint32_t row = 0; row < rows; ++row)
    std::copy_n(ids_at(x, y + row), columns, &seen.ids[tile_side * row]);
  std::uint16_t same[tile_points];
  const int different = kernels_.part_lanes(seen.ids, same);
  for (int i = 0; i < different; ++i) {
    const std::uint32_t id = seen.ids[std::countr_zero(same[i])];
    if (!is_point(id)) continue;
    if (sides && id != free_point) {
      add_sides(id, same[i], x, y, seen);
    } else {
      seen.add(receiver_of(id), same[i]);
    }
  }
}

/// Notes what the points of the tile (it has some) lie on.
void PatchMaker::note_owners(const Seen& seen, int place, PointSquare& square) const {
  const bool one = seen.count == 1;
  const std::uint16_t first = seen.parts[0].receiver;
  square.own[place] = one ? patch_.receivers[first / 16].id[first % 16] : no_triangle;
  square.receiver[place] = one ? first : several_receivers;
  for (const ReceiverLanes& part : seen.receivers())
    square.tau = std::max(square.tau, patch_.receivers[part.receiver / 16].tau[part.receiver % 16]);
}

/// Free points are stored, so `points` has them.
void PatchMaker::note_free(const Seen& seen, const TilePoints& points, PointSquare& square) const {
  for (const ReceiverLanes& part : seen.receivers()) {
    if (patch_.receivers[part.receiver / 16].id[part.receiver % 16] != free_point) continue;
    for (std::uint32_t left = part.lanes; left != 0; left &= left - 1) {
      const double tau = own_tolerance(triangles_, free_point, points.at(std::countr_zero(left)));
      square.tau = std::max(square.tau, static_cast<float>(tau) * (1 + 0x1p-22f) + 0x1p-149f);
    }
  }
}

void PatchMaker::note_ids(const Seen& seen, PointTile& tile) const {
  std::copy(std::begin(seen.ids), std::end(seen.ids), tile.id);
  for (std::uint32_t left = 0xffffu & ~seen.lanes; left != 0; left &= left - 1)
    tile.id[std::countr_zero(left)] = no_triangle;
}

/// The points of the tile's lanes (there are some); the others are undefined.
void PatchMaker::see(const Seen& seen, glm::uvec2 at, TilePoints& points) const {
  if (!from_view_) {
    const dvec3* const from = &points_.positions[std::size_t{at.y} * width_ + at.x];
    if (at.x + tile_side <= width_ && at.y + tile_side <= height_) return kernels_.take(from, width_, points);
    for (std::uint32_t left = seen.lanes; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      points.set(lane, from[static_cast<std::size_t>(lane / tile_side) * width_ +
                            static_cast<std::size_t>(lane % tile_side)]);
    }
    return;
  }
  const std::uint32_t inside = kernels_.see(receivers_.data(), seen.receivers(), rays_, at, points);
  for (const ReceiverLanes& part : seen.receivers()) {
    for (std::uint32_t left = part.lanes & ~inside; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      const glm::uvec2 pixel = at + glm::uvec2(lane % tile_side, lane / tile_side);
      points.set(lane, rays_.point_on(receivers_[part.receiver], pixel.x, pixel.y));
    }
  }
  if (lifts(seen)) lift(seen, points);
}

bool PatchMaker::lifts(const Seen& seen) const {
  return !smooth_.empty() && std::any_of(seen.parts, seen.parts + seen.count, [&](const ReceiverLanes& part) {
    return smooth_[part.receiver].lifts;
  });
}

void PatchMaker::lift(const Seen& seen, TilePoints& points) const {
  for (const ReceiverLanes& part : seen.receivers()) {
    const SmoothSurface& smooth = smooth_[part.receiver];
    for (std::uint32_t left = smooth.lifts ? part.lanes : 0u; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      points.set(lane, lifted(smooth, points.at(lane)));
    }
  }
}

const SeenPlane& PatchMaker::plane_of(std::uint16_t receiver) {
  std::uint32_t& number = plane_numbers_[receiver];
  if (number == no_plane) {
    number = static_cast<std::uint32_t>(planes_.size());
    const Receiver& r = receivers_[receiver];
    planes_.push_back(r.flat ? SeenPlane{} : seen_plane(r, rays_, rows_));
  }
  return planes_[number];
}

/// Makes a tile from a perspective view, if floats can. Planes of triangles that share each tile with many
/// others would cost more than they save.
bool PatchMaker::see_in_float(const Seen& seen, glm::uvec2 at, const SquareEye& eye, PointTile& tile,
                              int place, PointSquare& square, PlaneError& error) {
  if (rays_.orthographic || seen.count > most_planes) return false;
  if (seen.parts[0].lanes == 0xffffu) {
    const SeenPlane& plane = plane_of(seen.parts[0].receiver);
    return kernels_.see_plane(plane, rows_, eye, at, tile, place, square, error);
  }
  const SeenPlane* planes[most_planes];
  for (std::size_t i = 0; i < seen.count; ++i) plane_of(seen.parts[i].receiver);  // may move the others
  for (std::size_t i = 0; i < seen.count; ++i) planes[i] = &plane_of(seen.parts[i].receiver);
  return kernels_.see_planes(planes, seen.receivers(), rows_, eye, at, tile, place, square, error);
}

void PatchMaker::add_square(std::uint32_t x, std::uint32_t y, std::uint32_t first) {
  PointSquare& square = patch_.squares.emplace_back();
  square.first_tile = first;
  glm::vec3 base(0.0f);
  Seen seen;
  TilePoints points;
  SquareEye eye{};
  PlaneError error;
  for (std::uint32_t t = 0; t < 16; ++t) {
    const std::uint32_t tile_x = x + t % 4 * tile_side, tile_y = y + t / 4 * tile_side;
    const int place = static_cast<int>(t);
    PointTile& tile = out_.tiles[first + t];
    find_receivers(tile_x, tile_y, seen);
    if (seen.lanes == 0) continue;
    const glm::uvec2 at(tile_x, tile_y);
    if (!from_view_ || square.filled == 0 || lifts(seen) ||
        !(see_in_float(seen, at, eye, tile, place, square, error) ||
          kernels_.see_whole(receivers_.data(), seen.receivers(), rays_, at, base, tile, place, square))) {
      see(seen, at, points);
      if (square.filled == 0) {
        base = points.at(std::countr_zero(seen.lanes));
        eye = square_eye(rays_.eye, base);
      }
      kernels_.fill(points, base, seen.lanes, tile, place, square);
    }
    square.filled |= 1u << t;
    square.lanes[t] = static_cast<std::uint16_t>(seen.lanes);
    note_owners(seen, place, square);
    if (!from_view_) note_free(seen, points, square);
    if (square.receiver[t] != several_receivers) continue;
    note_ids(seen, tile);
    patch_.mixed.insert(patch_.mixed.end(), seen.parts, seen.parts + seen.count);
    if (kernels_.beyond_gap(tile, seen.lanes) != 0) square.gaps |= 1u << t;
  }
  if (square.filled == 0) return patch_.squares.pop_back();
  // A square that leaves the range of floats: its infinite radius makes hard shadows use the cone tree
  // instead. Not NaN, of which max would take the finite operand.
  const bool finite = std::isfinite(base.x) && std::isfinite(base.y) && std::isfinite(base.z);
  square.base.radius = finite ? radius_of(square) : std::numeric_limits<float>::infinity();
  square.base.grain = grain_of(square.base.radius, error);
  for (int k = 0; k < 3; ++k) square.base.at[k] = base[k];
  out_.bases[first / 16] = square.base;
}

}  // namespace tenebra::points
