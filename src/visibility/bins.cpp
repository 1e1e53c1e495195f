#include "visibility/bins.h"

#include <algorithm>
#include <cmath>

namespace tenebra::visibility {
namespace {

/// Triangles between two looks at the number of records.
constexpr std::size_t batch = 64;

/// Not a number (a plane that rounding left without a height) becomes -most.
float bounded(double value, double most) {
  return static_cast<float>(value >= -most ? std::min(value, most) : -most);
}

}  // namespace

void Bin::fill(const Drawing& drawing, std::size_t most) {
  records_.clear();
  tiles_.clear();
  while (next_ < last_ && records_.size() < most) {
    const std::size_t end = std::min(next_ + batch, last_);
    choose(drawing, next_, end);
    for (std::size_t i = 0; i < chosen_; i += 8) add_eight(drawing, i, std::min<std::size_t>(8, chosen_ - i));
    next_ = end;
  }
  sort(drawing.tiles());
}

void Bin::choose(const Drawing& drawing, std::size_t first, std::size_t last) {
  candidates_.resize(batch + 16);
  chosen_ = 0;
  for (std::size_t i = first; i < last; i += 16) {
    const std::size_t count = std::min<std::size_t>(16, last - i);
    std::uint32_t wanted = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const bool through = !drawing.see_through.empty() && drawing.see_through[i + k] != 0;
      if (through == drawing.draws_see_through) wanted |= 1u << k;
    }
    if (wanted == 0) continue;
    glm::uvec3 tail[16];
    const glm::uvec3* triangles = &drawing.close.triangles[i];
    if (count < 16) {
      std::fill_n(tail, 16, glm::uvec3(0));
      std::copy_n(triangles, count, tail);
      triangles = tail;
    }
    chosen_ += drawing.kernels.choose(drawing.window, drawing.vertices, triangles,
                                      static_cast<std::uint32_t>(i), wanted, chosen_, candidates_);
  }
}

void Bin::add_eight(const Drawing& drawing, std::size_t first, std::size_t count) {
  float corners[3][3][8];
  for (std::size_t k = 0; k < 8; ++k) {
    const glm::uvec3 t = drawing.close.triangles[candidates_.ids[first + std::min(k, count - 1)]];
    for (int corner = 0; corner < 3; ++corner) {
      const glm::vec3& p = drawing.close.positions[t[corner]];
      for (int axis = 0; axis < 3; ++axis) corners[corner][axis][k] = p[axis];
    }
  }
  double x0[8], y0[8];
  for (std::size_t k = 0; k < 8; ++k) {
    x0[k] = candidates_.x0[first + std::min(k, count - 1)];
    y0[k] = candidates_.y0[first + std::min(k, count - 1)];
  }
  TriangleSetup8 setup;
  drawing.kernels.set_up(drawing.window, corners, x0, y0, setup);
  for (std::size_t k = 0; k < count; ++k) add(drawing, first + k, setup, static_cast<int>(k));
}

void Bin::add(const Drawing& drawing, std::size_t candidate, const TriangleSetup8& setup, int k) {
  const std::uint32_t id = candidates_.ids[candidate];
  int turn = 1;
  if ((setup.side_unknown >> k & 1u) != 0) {
    const glm::uvec3 t = drawing.close.triangles[id];
    const auto& positions = drawing.close.positions;
    const int facing = drawing.close.coverage.facing(positions[t.x], positions[t.y], positions[t.z]);
    if (facing == 0) return;
    const int assumed = (setup.back >> k & 1u) != 0 ? -1 : 1;
    turn = facing * assumed;
  }
  const int first_x = candidates_.x0[candidate] / tile_side, last_x = candidates_.x1[candidate] / tile_side;
  const int first_y = candidates_.y0[candidate] / tile_side, last_y = candidates_.y1[candidate] / tile_side;
  if (first_x == last_x && first_y == last_y && turn == 1)
    return add_alone(id, candidate, setup, k, first_x, first_y, drawing);
  for (int y = first_y; y <= last_y; ++y)
    for (int x = first_x; x <= last_x; ++x) add_to_tile(id, candidate, setup, k, turn, x, y, drawing);
}

void Bin::add_alone(std::uint32_t id, std::size_t candidate, const TriangleSetup8& setup, int k, int tile_x,
                    int tile_y, const Drawing& drawing) {
  TileRecord record;
  for (int f = 0; f < 4; ++f) {
    record.value[f] = setup.value_at_box[f][k];
    record.along_x[f] = setup.step_x[f][k];
    record.along_y[f] = setup.step_y[f][k];
  }
  finish_record(record, id, candidate, (setup.doubtful >> k & 1u) != 0,
                {candidates_.x0[candidate], candidates_.y0[candidate], candidates_.x1[candidate],
                 candidates_.y1[candidate]},
                tile_x, tile_y, drawing);
}

void Bin::add_to_tile(std::uint32_t id, std::size_t candidate, const TriangleSetup8& setup, int k, int turn,
                      int tile_x, int tile_y, const Drawing& drawing) {
  const int left = tile_x * tile_side, top = tile_y * tile_side;
  const int x0 = std::max(candidates_.x0[candidate], left), y0 = std::max(candidates_.y0[candidate], top);
  const int x1 = std::min(candidates_.x1[candidate], left + tile_side - 1),
            y1 = std::min(candidates_.y1[candidate], top + tile_side - 1);
  const bool doubtful = (setup.doubtful >> k & 1u) != 0;
  TileRecord record;
  for (int f = 0; f < 4; ++f) {
    const double sign = f < 3 ? turn : 1;
    const double along_x = sign * setup.along_x[f][k], along_y = sign * setup.along_y[f][k];
    const double value = (sign * setup.at_origin[f][k] + (x0 + 0.5) * along_x) + (y0 + 0.5) * along_y;
    // Outside of an edge at the corner that is farthest inside.
    const double most = value + std::max(along_x, 0.0) * (x1 - x0) + std::max(along_y, 0.0) * (y1 - y0) +
                        drawing.around_px * (std::abs(along_x) + std::abs(along_y));
    if (f < 3 && !doubtful && most < -2.0 * double{edge_band}) return;
    const double limit = f < 3 ? farthest_edge : steepest_depth;
    record.value[f] = bounded(value, limit);
    record.along_x[f] = bounded(along_x, limit);
    record.along_y[f] = bounded(along_y, limit);
  }
  finish_record(record, id, candidate, doubtful, {x0, y0, x1, y1}, tile_x, tile_y, drawing);
}

void Bin::finish_record(TileRecord& record, std::uint32_t id, std::size_t candidate, bool doubtful,
                        const PixelBox& box, int tile_x, int tile_y, const Drawing& drawing) {
  const int left = tile_x * tile_side, top = tile_y * tile_side;
  record.near_depth = candidates_.near_depth[candidate];
  record.far_depth = candidates_.far_depth[candidate];
  record.id = doubtful ? id | doubtful_bit : id;
  record.x0 = static_cast<std::uint8_t>(box.x0 - left);
  record.y0 = static_cast<std::uint8_t>(box.y0 - top);
  record.x1 = static_cast<std::uint8_t>(box.x1 - left);
  record.y1 = static_cast<std::uint8_t>(box.y1 - top);
  records_.push_back(record);
  tiles_.push_back(static_cast<std::uint32_t>(tile_y * drawing.tiles_x + tile_x));
}

void Bin::sort(std::size_t tiles) {
  starts_.assign(tiles + 1, 0);
  for (const std::uint32_t tile : tiles_) ++starts_[tile];
  std::uint32_t sum = 0;
  for (std::uint32_t& start : starts_) start = (sum += start);  // the end of each tile
  order_.resize(records_.size());
  for (std::size_t i = records_.size(); i-- > 0;)
    order_[--starts_[tiles_[i]]] = static_cast<std::uint32_t>(i);
}

}  // namespace tenebra::visibility
