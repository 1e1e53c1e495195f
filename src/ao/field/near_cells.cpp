#include "ao/field/near_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tenebra::ao {

namespace {

constexpr double cell_size = 2.0 / near_side;
const double half_diagonal = 0.5 * std::sqrt(3.0) * cell_size;

using Grid = std::vector<std::uint8_t>;  // one per cell
using Corners = std::array<glm::dvec3, 3>;

std::size_t place(glm::ivec3 c) {
  return (static_cast<std::size_t>(c.z) * near_side + static_cast<std::size_t>(c.y)) * near_side +
         static_cast<std::size_t>(c.x);
}
glm::ivec3 cell_at(glm::dvec3 p) {
  return glm::clamp(glm::ivec3(glm::floor((p + 1.0) / cell_size)), 0, near_side - 1);
}

double distance_to_segment(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b) {
  const glm::dvec3 along = b - a;
  const double square = glm::dot(along, along);
  const double t = square > 0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * along);
}

double distance_to_triangle(glm::dvec3 p, const Corners& t) {
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
  bool above = glm::dot(n, n) > 0;  // p's foot lies in the triangle
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 a = t[k], b = t[(k + 1) % 3];
    above = above && glm::dot(glm::cross(b - a, p - a), n) >= 0;
    least = std::min(least, distance_to_segment(p, a, b));
  }
  return above ? std::abs(glm::dot(n, p - t[0])) / glm::length(n) : least;
}

/// Marks the cells of the cube of `size` cells from `c` on that the triangle passes through, and some next
/// to them.
void mark_cube(Grid& grid, glm::ivec3 c, int size, const Corners& t) {
  const double half = 0.5 * size * cell_size;
  const glm::dvec3 middle = glm::dvec3(c) * cell_size - 1.0 + half;
  if (distance_to_triangle(middle, t) > std::sqrt(3.0) * half) return;
  if (size == 1) {
    grid[place(c)] = 1;
    return;
  }
  for (int i = 0; i < 8; ++i)
    mark_cube(grid, c + size / 2 * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), size / 2, t);
}

void mark(Grid& grid, const Corners& t) {
  const glm::ivec3 low = cell_at(glm::min(t[0], glm::min(t[1], t[2])));
  const glm::ivec3 high = cell_at(glm::max(t[0], glm::max(t[1], t[2])));
  const glm::ivec3 span = high - low;
  if (std::max({span.x, span.y, span.z}) > 1) return mark_cube(grid, {0, 0, 0}, near_side, t);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) grid[place({x, y, z})] = 1;
}

/// Offsets of cells whose centres are at most `radius` apart.
std::vector<glm::ivec3> ball(double radius) {
  std::vector<glm::ivec3> offsets;
  const int most = static_cast<int>(radius / cell_size);
  for (int z = -most; z <= most; ++z)
    for (int y = -most; y <= most; ++y)
      for (int x = -most; x <= most; ++x)
        if (glm::length(glm::dvec3(x, y, z)) * cell_size <= radius) offsets.emplace_back(x, y, z);
  return offsets;
}

bool inner(const Grid& grid, glm::ivec3 c) {  // all six neighbours are marked: those will do
  for (int axis = 0; axis < 3; ++axis) {
    if (c[axis] == 0 || c[axis] == near_side - 1) return false;
    glm::ivec3 step(0);
    step[axis] = 1;
    if (!grid[place(c - step)] || !grid[place(c + step)]) return false;
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> close_cells(std::span<const glm::vec3> positions,
                                       std::span<const glm::uvec3> triangles, const Ellipsoid& bound,
                                       float reach) {
  Grid grid(place({0, 0, near_side}));
  for (const glm::uvec3& triangle : triangles) {
    Corners t;
    bool usable = std::max({triangle.x, triangle.y, triangle.z}) < positions.size();
    for (int k = 0; k < 3 && usable; ++k) {
      glm::dvec3& p = t[static_cast<std::size_t>(k)];
      p = (glm::dvec3(positions[triangle[k]]) - bound.centre) / bound.axes;
      usable = glm::dot(p, p) <= 1.001;
    }
    if (usable) mark(grid, t);
  }
  // From centre to centre: half a diagonal from a cell's centre to a point, the reach to the triangle's
  // point, and half a diagonal to the centre of that one's cell.
  const std::vector<glm::ivec3> offsets = ball(reach + 2 * half_diagonal);
  std::vector<std::uint32_t> bits(near_words);
  for (int z = 0; z < near_side; ++z)
    for (int y = 0; y < near_side; ++y)
      for (int x = 0; x < near_side; ++x) {
        const std::size_t here = place({x, y, z});
        if (!grid[here]) continue;
        bits[here / 32] |= 1u << here % 32;
        if (inner(grid, {x, y, z})) continue;
        for (const glm::ivec3 offset : offsets) {
          const glm::ivec3 c = glm::ivec3(x, y, z) + offset;
          if (std::min({c.x, c.y, c.z}) < 0 || std::max({c.x, c.y, c.z}) >= near_side) continue;
          bits[place(c) / 32] |= 1u << place(c) % 32;
        }
      }
  return bits;
}

}  // namespace tenebra::ao
