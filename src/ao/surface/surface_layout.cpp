#include "ao/surface/surface_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ao/surface/surface_layout_inline.h"
#include "base/until_stopped.h"

namespace tenebra::ao {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::uint32_t refinement = 4;  // fine steps in a wide one
constexpr double wide_steps = 12;        // wide steps in a reach
constexpr std::uint32_t cell_steps = 4;  // of a divided cell
static_assert((cell_steps + 1) * (cell_steps + 2) / 2 == SurfaceLayout::cell_samples);
constexpr float pull = 0.25f;  // steps towards the middle of the triangle

struct GridPoint {
  std::uint32_t i, j;
};
GridPoint grid_point(std::uint32_t index, std::uint32_t steps) {
  std::uint32_t j = 0;
  while (index > steps - j) index -= steps - j++ + 1;  // rows shrink by one
  return {index, j};
}

std::size_t grids_size(std::uint32_t steps) {
  return level_start(levels_of(steps) - 1, steps) + grid_size(steps);
}
/// A point of one of the grids.
struct LevelPoint {
  int level;
  std::uint32_t i, j;  ///< in steps of the level
};
LevelPoint level_point(std::uint32_t index, std::uint32_t steps) {
  int level = 0;
  while (level + 1 < levels_of(steps) && index >= level_start(level + 1, steps)) ++level;
  const GridPoint p = grid_point(index - level_start(level, steps), level_steps(level, steps));
  return {level, p.i, p.j};
}

double longest_edge(const ObjectShape& shape, std::size_t triangle) {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const dvec3 edge = dvec3(shape.positions[shape.triangles[triangle][(k + 1) % 3]]) -
                       dvec3(shape.positions[shape.triangles[triangle][k]]);
    square = std::max(square, glm::dot(edge, edge));
  }
  return std::sqrt(square);
}

/// Fine steps along a side: a multiple of the refinement, 2 for a triangle within one wide step, 1 for one
/// whose corners will do.
std::uint32_t steps_of(double edge, double spacing) {
  constexpr double most_wide = 2048;
  if (!(edge > 0.5 * spacing)) return 1;
  if (edge <= spacing) return 2;
  return refinement * static_cast<std::uint32_t>(std::clamp(std::ceil(edge / spacing), 1.0, most_wide));
}

/// The same for corners at one place that face alike.
std::uint64_t corner_key(const ObjectShape& shape, std::uint32_t triangle, int corner) {
  const std::uint32_t vertex = shape.triangles[triangle][corner];
  const vec3 face = face_normal(shape, triangle);
  const vec3 normal = shape.normals[vertex] == vec3(0.0f) ? face : shape.normals[vertex];
  std::uint64_t key = 0x243f6a8885a308d3u;
  const auto mix = [&key](double number) {
    constexpr double limit = 1e15;
    key ^= static_cast<std::uint64_t>(static_cast<std::int64_t>(std::clamp(number, -limit, limit)));
    key *= 0x9e3779b97f4a7c15u;
    key ^= key >> 31;
  };
  for (int k = 0; k < 3; ++k) {
    mix(std::bit_cast<std::uint32_t>(shape.positions[vertex][k] + 0.0f));
    mix(std::round(4.0 * normal[k]));
    mix(std::round(3.0 * face[k]));
  }
  return key;
}

struct Corner {
  std::uint64_t key;
  std::uint32_t id;  // 3 x triangle + corner
};

/// All corners of a shape by their keys, then by their ids. Keys are spread evenly: sorted by their first
/// bits at once, and then range by range, so that a stop need not wait for all.
std::vector<Corner> sorted_corners(const ObjectShape& shape, const StopFlag* stop) {
  constexpr int first_bits = 8;
  const std::size_t count = 3 * shape.triangles.size();
  std::vector<Corner> corners, sorted;
  corners.reserve(count);
  std::vector<std::size_t> ends((1u << first_bits) + 1);
  const auto range_of = [](const Corner& corner) { return corner.key >> (64 - first_bits); };
  base::each_until_stopped(0, count, stop, [&](std::size_t i) {
    const auto id = static_cast<std::uint32_t>(i);
    corners.push_back({corner_key(shape, id / 3, static_cast<int>(id % 3)), id});
    ++ends[range_of(corners.back()) + 1];
  });
  if (!base::resize_until_stopped(sorted, count, stop)) return {};
  for (std::size_t k = 1; k < ends.size(); ++k) ends[k] += ends[k - 1];
  const bool all = base::each_until_stopped(
      0, corners.size(), stop, [&](std::size_t i) { sorted[ends[range_of(corners[i])]++] = corners[i]; });
  if (!all) return {};
  for (std::size_t k = 0, first = 0; k + 1 < ends.size(); first = ends[k++]) {
    if (stop_requested(stop)) return {};
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[k]),
              [](const Corner& a, const Corner& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
  }
  return sorted;
}

}  // namespace

SurfaceLayout::SurfaceLayout(const ObjectShape& shape, double reach, const StopFlag* stop)
    : shape_(shape), spacing_(reach / wide_steps) {
  lay_grids(stop);
  if (!stop_requested(stop)) weld_corners(stop);
  if (stop_requested(stop)) return;
  places_ = shared_.size();
  for (const std::uint32_t t : large_) {
    grids_[t].first = static_cast<std::uint32_t>(places_);
    places_ += grids_size(grids_[t].steps);
  }
}

// Too many places: the spacing grows until they fit.
void SurfaceLayout::lay_grids(const StopFlag* stop) {
  grids_.assign(shape_.triangles.size(), {});
  std::vector<double> edges(shape_.triangles.size());
  base::each_until_stopped(0, edges.size(), stop, [&](std::size_t t) { edges[t] = longest_edge(shape_, t); });
  const auto count = [&] {
    std::size_t places = 0;
    for (const double edge : edges) {
      const std::uint32_t steps = steps_of(edge, spacing_);
      places += steps > 1 ? grids_size(steps) : 0;
    }
    return places;
  };
  while (!stop_requested(stop) && count() > most_places) spacing_ *= 1.25;
  base::each_until_stopped(0, edges.size(), stop, [&](std::size_t t) {
    grids_[t].steps = steps_of(edges[t], spacing_);
    if (grids_[t].steps > 1) large_.push_back(static_cast<std::uint32_t>(t));
  });
}

void SurfaceLayout::weld_corners(const StopFlag* stop) {
  const std::vector<Corner> corners = sorted_corners(shape_, stop);
  if (!base::resize_until_stopped(corners_, corners.size(), stop)) return;
  base::each_until_stopped(0, corners.size(), stop, [&](std::size_t i) {
    if (i == 0 || corners[i].key != corners[i - 1].key) shared_.push_back(corners[i].id);
    corners_[corners[i].id] = static_cast<std::uint32_t>(shared_.size() - 1);
  });
}

SampleTriple SurfaceLayout::corners(const SurfacePoint& point) const {
  const Weights at(point);
  const std::uint32_t* c = &corners_[std::size_t{3} * point.triangle];
  const std::uint32_t side = point.front ? 0 : 1;
  return {{2 * c[0] + side, 2 * c[1] + side, 2 * c[2] + side}, {1 - at.v - at.w, at.v, at.w}};
}

std::uint32_t SurfaceLayout::triangle_at(std::uint32_t place) const {
  const auto after = std::upper_bound(large_.begin(), large_.end(), place,
                                      [&](std::uint32_t p, std::uint32_t t) { return p < grids_[t].first; });
  return *(after - 1);
}

int SurfaceLayout::levels(std::uint32_t triangle) const {
  return levels_of(grids_[triangle].steps);
}

std::uint32_t SurfaceLayout::shared(std::uint32_t sample) const {
  if (sample / 2 < shared_.size()) return sample;
  const std::uint32_t triangle = triangle_at(sample / 2), side = sample % 2;
  const Grid grid = grids_[triangle];
  LevelPoint p = level_point(sample / 2 - grid.first, grid.steps);
  for (; p.level > 0 && ((p.i | p.j) & 1) == 0; --p.level) p.i /= 2, p.j /= 2;
  const std::uint32_t steps = level_steps(p.level, grid.steps), sum = p.i + p.j;
  if (p.level == 0 && (sum == 0 || p.i == steps || p.j == steps))
    return 2 * corners_[std::size_t{3} * triangle + (sum == 0 ? 0 : p.i == steps ? 1 : 2)] + side;
  return 2 * (grid.first + level_start(p.level, grid.steps) + grid_index(p.i, p.j, steps)) + side;
}

SurfacePoint SurfaceLayout::place(std::uint32_t sample) const {
  const bool front = sample % 2 == 0;
  sample /= 2;
  const auto pulled = [&](std::uint32_t triangle, float v, float w, float steps) {
    return SurfacePoint{triangle, v + pull / steps * (1.0f / 3 - v), w + pull / steps * (1.0f / 3 - w),
                        front};
  };
  if (sample < shared_.size()) {
    const std::uint32_t corner = shared_[sample] % 3;
    const std::uint32_t owner = shared_[sample] / 3;
    return pulled(owner, corner == 1 ? 1.0f : 0.0f, corner == 2 ? 1.0f : 0.0f,
                  static_cast<float>(grids_[owner].steps));
  }
  const std::uint32_t triangle = triangle_at(sample);
  const Grid grid = grids_[triangle];
  const LevelPoint p = level_point(sample - grid.first, grid.steps);
  const auto steps = static_cast<float>(level_steps(p.level, grid.steps));
  return pulled(triangle, static_cast<float>(p.i) / steps, static_cast<float>(p.j) / steps,
                static_cast<float>(grid.steps));
}

// Bits from 30 on: the triangle, 14 each for the cell's place, one for the half, one for the side.
std::uint64_t SurfaceLayout::cell_key(const SurfacePoint& point) const {
  const Weights at(point);
  const Cell c = cell(at.v, at.w, grids_[point.triangle].steps);
  const std::uint64_t i = c.i[c.upper ? 1 : 0], j = c.j[c.upper ? 2 : 0];
  return std::uint64_t{point.triangle} << 30 | i << 16 | j << 2 | (c.upper ? 2u : 0u) |
         (point.front ? 0u : 1u);
}

SampleTriple SurfaceLayout::in_cell(const SurfacePoint& point) const {
  const Weights at(point);
  const Cell outer = cell(at.v, at.w, grids_[point.triangle].steps);
  const Cell c = cell(outer.weights[1], outer.weights[2], cell_steps);
  const auto index = [&](int k) { return grid_index(c.i[k], c.j[k], cell_steps); };
  return {{index(0), index(1), index(2)}, {c.weights[0], c.weights[1], c.weights[2]}};
}

SurfacePoint SurfaceLayout::place_in_cell(std::uint64_t key, std::uint32_t sample) const {
  const GridPoint p = grid_point(sample, cell_steps);
  const auto triangle = static_cast<std::uint32_t>(key >> 30);
  const auto i = static_cast<float>(key >> 16 & 0x3fff), j = static_cast<float>(key >> 2 & 0x3fff);
  const auto steps = static_cast<float>(grids_[triangle].steps);
  float v = static_cast<float>(p.i) / cell_steps, w = static_cast<float>(p.j) / cell_steps;
  v += pull / cell_steps * (1.0f / 3 - v), w += pull / cell_steps * (1.0f / 3 - w);
  if ((key & 2) == 0) return {triangle, (i + v) / steps, (j + w) / steps, (key & 1) == 0};
  return {triangle, (i + 1 - v) / steps, (j + 1 - w) / steps, (key & 1) == 0};
}

std::size_t SurfaceLayout::bytes() const {
  return grids_.size() * sizeof(Grid) +
         (corners_.size() + shared_.size() + large_.size()) * sizeof(std::uint32_t);
}

}  // namespace tenebra::ao
