#include "soft/sample/sampled_blocks.h"

#include <algorithm>

#include "parallel/parallel.h"
#include "points/point_tiles.h"
#include "points/sample_points.h"
#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

/// Within a block.
constexpr std::uint32_t slot_in_block(std::uint32_t x, std::uint32_t y) {
  const std::uint32_t phase = y % 2 * 2 + x % 2;
  return phase * phase_slots + y / 2 * 4 + x / 2;
}

/// Bits of x and y in turn.
std::uint64_t z_order(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  for (std::uint32_t bit = 0; bit < 32; ++bit)
    key |= (std::uint64_t{x >> bit & 1u} << (2 * bit)) | (std::uint64_t{y >> bit & 1u} << (2 * bit + 1));
  return key;
}

glm::vec3 face_of(const SoftFrame& frame, std::uint32_t pixel) {
  if (frame.points.triangles[pixel] == free_point) return glm::vec3(frame.free_normal(pixel));
  const points::Corners c = points::corners_of(frame.triangles, frame.points.triangles[pixel]);
  const glm::dvec3 a(c.v[0]), across = glm::cross(glm::dvec3(c.v[1]) - a, glm::dvec3(c.v[2]) - a);
  const double length = glm::length(across);
  return length > 0 ? glm::vec3(across * (visible_side(frame.points, frame.triangles, pixel) / length))
                    : glm::vec3(0.0f);
}

SampledSurface surface_at(const SoftFrame& frame, std::uint32_t pixel) {
  SampledSurface out;
  const double size = glm::length(frame.light.ex);
  out.at = glm::vec3(frame.light.way_from(frame.points.positions[pixel]) / -size);
  out.face = face_of(frame, pixel);
  out.sees_half = frame.points.triangles[pixel] == free_point && frame.sees_half(pixel);
  out.normal = frame.normals.empty() ? out.face : frame.normals[pixel];
  return out;
}

}  // namespace

std::uint32_t SampledBlocks::slot(int x, int y) const {
  if (x < 0 || y < 0 || x >= width || y >= height) return no_slot;
  const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
  const std::uint32_t block = block_at[row / block_side * columns() + column / block_side];
  if (block == no_slot) return no_slot;
  const std::uint32_t slot = block * block_slots + slot_in_block(column % block_side, row % block_side);
  return pixels[slot] == no_pixel ? no_slot : slot;
}

void find_blocks(const SoftFrame& frame, std::span<const std::uint32_t> pixels, SampledBlocks& out) {
  out.width = frame.points.width, out.height = frame.points.height;
  out.places.clear();
  const std::uint32_t columns = out.columns(),
                      rows = (static_cast<std::uint32_t>(out.height) + block_side - 1) / block_side;
  const auto width = static_cast<std::uint32_t>(out.width);
  const auto place_of = [&](std::uint32_t pixel) {
    return pixel / width / block_side * columns + pixel % width / block_side;
  };
  out.block_at.assign(static_cast<std::size_t>(columns) * rows, no_slot);
  for (const std::uint32_t pixel : pixels) {
    std::uint32_t& block = out.block_at[place_of(pixel)];
    if (block == no_slot) out.places.push_back(place_of(pixel));
    block = 0;
  }
  std::sort(out.places.begin(), out.places.end(), [&](std::uint32_t a, std::uint32_t b) {
    return z_order(a % columns, a / columns) < z_order(b % columns, b / columns);
  });
  for (std::size_t k = 0; k < out.places.size(); ++k)
    out.block_at[out.places[k]] = static_cast<std::uint32_t>(k);
  out.pixels.assign(out.count() * block_slots, no_pixel);
  for (const std::uint32_t pixel : pixels) {
    const std::uint32_t x = pixel % width, y = pixel / width;
    out.pixels[out.block_at[place_of(pixel)] * block_slots + slot_in_block(x % block_side, y % block_side)] =
        pixel;
  }
  out.surfaces.resize(out.pixels.size());
  parallel::parallel_ranges(out.pixels.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    for (std::size_t slot = first; slot < last; ++slot)
      if (out.pixels[slot] != no_pixel) out.surfaces[slot] = surface_at(frame, out.pixels[slot]);
  });
}

void take_phase(const SoftFrame& frame, const SampledBlocks& blocks, std::span<const std::uint32_t> chosen,
                std::uint32_t phase, VisiblePoints& out) {
  const points::SampleGrid grid(chosen.size() * phase_slots);
  out.width = grid.width(), out.height = grid.height();
  out.positions.resize(grid.pixels());
  out.triangles.assign(grid.pixels(), no_triangle);
  out.sides.resize(frame.points.sides.empty() ? 0 : grid.pixels());
  out.seen_from = frame.points.seen_from;
  parallel::parallel_ranges(chosen.size(), 64, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t* from = &blocks.pixels[chosen[k] * block_slots + phase * phase_slots];
      for (std::uint32_t i = 0; i < phase_slots; ++i) {
        if (from[i] == no_pixel) continue;
        const std::size_t to = grid.pixel(k * phase_slots + i);
        out.positions[to] = frame.points.positions[from[i]];
        out.triangles[to] = frame.points.triangles[from[i]];
        if (!frame.points.sides.empty()) out.sides[to] = frame.points.sides[from[i]];
      }
    }
  });
  points::make_point_tiles(out, frame.triangles, *out.tiles);
}

}  // namespace tenebra::soft
