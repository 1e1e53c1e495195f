#include "bake/texel_coverage.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tenebra::bake {
namespace {

using glm::dvec2;
using glm::dvec3;

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

double twice_area(const MapTriangle& t) {
  return cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
}

/// Weights of the corners at `p`; the triangle has an area.
dvec3 weights_at(const MapTriangle& t, const dvec2& p) {
  const double area = twice_area(t);
  const double b = cross(p - t.corners[0], t.corners[2] - t.corners[0]) / area,
               c = cross(t.corners[1] - t.corners[0], p - t.corners[0]) / area;
  return {1 - b - c, b, c};
}

double least(const dvec3& v) {
  return std::min({v.x, v.y, v.z});
}

/// Whole numbers [first, last) of `count` cells that [low, high] may touch.
struct Run {
  int first, last;
};
Run cells(double low, double high, int count) {
  const double first = std::clamp(std::floor(low), 0.0, static_cast<double>(count)),
               last = std::clamp(std::floor(high) + 1, 0.0, static_cast<double>(count));
  return {static_cast<int>(first), static_cast<int>(last)};
}

struct Box {
  dvec2 low, high;
};
Box box_of(const MapTriangle& t) {
  return {glm::min(t.corners[0], glm::min(t.corners[1], t.corners[2])),
          glm::max(t.corners[0], glm::max(t.corners[1], t.corners[2]))};
}

bool usable(const MapTriangle& t) {
  const double area = twice_area(t);
  return std::isfinite(area) && area != 0;
}

/// The part of a texel in a triangle: a convex polygon.
struct Piece {
  double area = 0;
  dvec2 centroid{0.0};
};

Piece piece_of(const MapTriangle& t, const dvec2& texel) {
  std::vector<dvec2> polygon{texel, texel + dvec2(1, 0), texel + dvec2(1, 1), texel + dvec2(0, 1)}, kept;
  const double turn = twice_area(t) < 0 ? -1 : 1;
  for (std::size_t e = 0; e < 3 && !polygon.empty(); ++e) {
    const dvec2 a = t.corners[e], way = t.corners[(e + 1) % 3] - a;
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double at_p = turn * cross(way, p - a), at_q = turn * cross(way, q - a);
      if (at_p >= 0) kept.push_back(p);
      if ((at_p >= 0) != (at_q >= 0)) kept.push_back(glm::mix(p, q, at_p / (at_p - at_q)));
    }
    polygon.swap(kept);
  }
  Piece piece;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const double area = 0.5 * cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    piece.area += area;
    piece.centroid += area / 3 * (polygon[0] + polygon[i - 1] + polygon[i]);
  }
  if (piece.area > 0) piece.centroid /= piece.area;
  return piece;
}

}  // namespace

TexelCoverage::TexelCoverage(std::span<const MapTriangle> triangles, int size, int per_side)
    : triangles_(triangles), size_(size), per_side_(per_side) {
  const auto side = static_cast<std::size_t>(size) * static_cast<std::size_t>(per_side);
  owners_.assign(side * side, none);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    if (usable(triangles[i])) cover_places(i);
  find_slivers();
}

dvec2 TexelCoverage::place(int column, int row) const {
  constexpr dvec2 off_grid{0.53711, 0.46093};  // of the step from place to place
  return (dvec2(column, row) + off_grid) / static_cast<double>(per_side_);
}

void TexelCoverage::cover_places(std::uint32_t index) {
  constexpr double rounding = 1e-6;  // neighbours share an edge, on which both have a place
  const MapTriangle& t = triangles_[index];
  const auto [low, high] = box_of(t);
  const int side = size_ * per_side_;
  const Run rows = cells(low.y * per_side_ - 1, high.y * per_side_, side);
  const Run columns = cells(low.x * per_side_ - 1, high.x * per_side_, side);
  for (int y = rows.first; y < rows.last; ++y)
    for (int x = columns.first; x < columns.last; ++x) {
      const dvec2 at = place(x, y);
      const double inside = least(weights_at(t, at));
      if (!(inside >= 0)) continue;
      std::uint32_t& owner =
          owners_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)];
      if (owner == none) {
        owner = index;
        ++covered_;
      } else if (inside > rounding && least(weights_at(triangles_[owner], at)) > rounding) {
        ++(triangles_[owner].part == t.part ? overlaps_within_ : overlaps_between_);
      }
    }
}

bool TexelCoverage::has_places(int x, int y) const {
  const auto side = static_cast<std::size_t>(size_ * per_side_);
  for (int row = y * per_side_; row < (y + 1) * per_side_; ++row) {
    const std::uint32_t* first = &owners_[static_cast<std::size_t>(row) * side];
    for (int column = x * per_side_; column < (x + 1) * per_side_; ++column)
      if (first[column] != none) return true;
  }
  return false;
}

void TexelCoverage::find_slivers() {
  struct Found {
    Sliver sliver;
    double area;
  };
  std::vector<Found> found;
  for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
    const MapTriangle& t = triangles_[i];
    if (!usable(t)) continue;
    const auto [low, high] = box_of(t);
    const Run rows = cells(low.y, high.y, size_), columns = cells(low.x, high.x, size_);
    for (int y = rows.first; y < rows.last; ++y)
      for (int x = columns.first; x < columns.last; ++x) {
        if (has_places(x, y)) continue;
        const Piece piece = piece_of(t, dvec2(x, y));
        if (!(piece.area > 0)) continue;
        const auto texel =
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(size_) + static_cast<std::uint32_t>(x);
        found.push_back({{texel, i, weights_at(t, piece.centroid)}, piece.area});
      }
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return a.sliver.texel != b.sliver.texel ? a.sliver.texel < b.sliver.texel : a.area > b.area;
  });
  for (const Found& f : found)
    if (slivers_.empty() || slivers_.back().texel != f.sliver.texel) slivers_.push_back(f.sliver);
}

void TexelCoverage::add_texel(int x, int y, std::vector<Sample>& out) const {
  const auto texel =
      static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(size_) + static_cast<std::uint32_t>(x);
  const auto side = static_cast<std::size_t>(size_ * per_side_);
  const std::size_t before = out.size();
  for (int row = y * per_side_; row < (y + 1) * per_side_; ++row)
    for (int column = x * per_side_; column < (x + 1) * per_side_; ++column) {
      const std::uint32_t owner =
          owners_[static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column)];
      if (owner == none) continue;
      const MapTriangle& t = triangles_[owner];
      out.push_back({texel, t.triangle, 1.0f, weights_at(t, place(column, row))});
    }
  if (out.size() > before) return;
  const auto sliver =
      std::lower_bound(slivers_.begin(), slivers_.end(), texel,
                       [](const Sliver& s, std::uint32_t wanted) { return s.texel < wanted; });
  if (sliver != slivers_.end() && sliver->texel == texel)
    out.push_back({texel, triangles_[sliver->owner].triangle, 1.0f, sliver->weights});
}

void TexelCoverage::samples_of_band(int first_row, std::vector<Sample>& out) const {
  out.clear();
  // Squares of 64 x 64 texels, each along a Z-shaped curve: bits of x and y in turns.
  for (int first_column = 0; first_column < size_; first_column += band_rows)
    for (int i = 0; i < band_rows * band_rows; ++i) {
      int x = first_column, y = first_row;
      for (int bit = 0; bit < 6; ++bit) {
        x += (i >> (2 * bit) & 1) << bit;
        y += (i >> (2 * bit + 1) & 1) << bit;
      }
      if (x < size_ && y < size_) add_texel(x, y, out);
    }
}

}  // namespace tenebra::bake
