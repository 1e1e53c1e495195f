#include "stage/cutout/cut_triangle.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "stage/cutout/piece.h"
#include "stage/cutout/triangulate.h"

namespace tenebra::stage {
namespace {

/// Copies of the outline along an axis that a range meets.
struct TileRange {
  double first = 0, last = 0;
  double count() const { return last - first + 1; }
};

TileRange tiles_of(const AxisTiling& tiling, double low, double high) {
  if (tiling.period == 0) return {};
  const double first = std::floor((low - tiling.first) / tiling.period);
  const double last = std::ceil((high - tiling.first) / tiling.period) - 1;
  return {first, std::max(first, last)};
}

void place_axis(const AxisTiling& tiling, double index, int axis, Tile& tile) {
  const bool reflected = tiling.mirrored && std::fmod(std::abs(index), 2.0) == 1.0;
  tile.sign[axis] = reflected ? -1.0 : 1.0;
  tile.offset[axis] = reflected ? 2 * tiling.first + (index + 1) * tiling.period : index * tiling.period;
}

/// About one for each vertex of the outline in an area of the plane, if the outline repeats both ways.
double expected_triangles(const Region& region, double area) {
  const double tile = region.tiling[0].period * region.tiling[1].period;
  return tile > 0 ? static_cast<double>(region.tree.outline.points.size()) * area / tile : 0.0;
}

/// Gathers the pieces of one triangle.
class TriangleCutter {
public:
  TriangleCutter(const PlaneTriangle& triangle, const std::array<int, 3>& order, CutTriangle& out)
      : triangle_(triangle), order_(order), out_(out) {}

  void add(const OutlineTree& tree, const Tile& tile) {
    for (const Leaf& leaf : tree.leaves) {
      std::vector<std::vector<Spot>> loops;
      if (cut_piece(triangle_, tree.outline, leaf, tile, loops) == PieceKind::nothing) continue;
      if (is_whole(loops)) {
        out_.whole = true;
        return;
      }
      fill(loops);
    }
  }

private:
  static bool is_whole(const std::vector<std::vector<Spot>>& loops) {
    return loops.size() == 1 && loops[0].size() == 3 &&
           std::all_of(loops[0].begin(), loops[0].end(), [](const Spot& spot) { return spot.corner >= 0; });
  }

  void fill(const std::vector<std::vector<Spot>>& loops) {
    std::vector<glm::dvec2> points;
    std::vector<std::uint32_t> vertices;
    std::vector<Loop> indices;
    for (const std::vector<Spot>& loop : loops) {
      indices.emplace_back();
      for (const Spot& spot : loop) {
        indices.back().push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(spot.at);
        vertices.push_back(vertex_at(spot));
      }
    }
    const bool turned = order_[1] == 2;
    for (const glm::uvec3& t : triangulate(points, std::move(indices))) {
      const glm::uvec3 corners(vertices[t.x], vertices[turned ? t.z : t.y], vertices[turned ? t.y : t.z]);
      if (corners.x != corners.y && corners.y != corners.z && corners.z != corners.x)
        out_.triangles.push_back(corners);
    }
  }

  std::uint32_t vertex_at(const Spot& spot) {
    std::array<std::uint64_t, 3> key{0, static_cast<std::uint64_t>(spot.corner), 0};
    if (spot.corner < 0 && spot.edge >= 0) {
      key = {1, static_cast<std::uint64_t>(spot.edge), std::bit_cast<std::uint64_t>(spot.along)};
    } else if (spot.corner < 0) {
      key = {2, std::bit_cast<std::uint64_t>(spot.at.x), std::bit_cast<std::uint64_t>(spot.at.y)};
    }
    const auto [at, is_new] = known_.try_emplace(key, static_cast<std::uint32_t>(out_.vertices.size()));
    if (is_new) out_.vertices.push_back(make_vertex(spot));
    return at->second;
  }

  CutVertex make_vertex(const Spot& spot) const {
    const auto corner = [&](int k) { return order_[static_cast<std::size_t>(k)]; };
    if (spot.corner >= 0) return {1, {corner(spot.corner), 0, 0}, {1, 0, 0}};
    if (spot.edge >= 0) {
      return {2,
              {corner(triangle_.first_end(spot.edge)), corner(triangle_.other_end(spot.edge)), 0},
              {1 - spot.along, spot.along, 0}};
    }
    return {3, order_, triangle_.weights(spot.at)};
  }

  const PlaneTriangle& triangle_;
  const std::array<int, 3>& order_;
  CutTriangle& out_;
  std::map<std::array<std::uint64_t, 3>, std::uint32_t> known_;
};

}  // namespace

bool cut_triangle(const std::array<glm::dvec2, 3>& corners, const Region& region, std::size_t most_triangles,
                  CutTriangle& out) {
  const glm::dvec2 u = corners[1] - corners[0], v = corners[2] - corners[0];
  const bool turned = u.x * v.y - u.y * v.x < 0;
  const std::array<int, 3> order{0, turned ? 2 : 1, turned ? 1 : 2};
  const PlaneTriangle triangle({corners[0], corners[turned ? 2 : 1], corners[turned ? 1 : 2]});
  std::array<TileRange, 2> range;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    range[static_cast<std::size_t>(axis)] =
        tiles_of(region.tiling[static_cast<std::size_t>(axis)], low, high);
  }
  if (!(range[0].count() * range[1].count() <= most_tiles)) return false;  // nor where one overflows
  if (expected_triangles(region, 0.5 * std::abs(u.x * v.y - u.y * v.x)) > static_cast<double>(most_triangles))
    return false;
  TriangleCutter cutter(triangle, order, out);
  // By number: of a tile far away the index plus one may round to the index.
  const auto columns = static_cast<std::size_t>(range[0].count()),
             rows = static_cast<std::size_t>(range[1].count());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      Tile tile;
      place_axis(region.tiling[0], range[0].first + static_cast<double>(column), 0, tile);
      place_axis(region.tiling[1], range[1].first + static_cast<double>(row), 1, tile);
      cutter.add(region.tree, tile);
      if (out.whole) return true;
      if (out.triangles.size() > most_triangles) return false;
    }
  }
  return true;
}

}  // namespace tenebra::stage
