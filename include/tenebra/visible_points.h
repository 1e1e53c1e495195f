// The samples of a frame: points on triangles, one a pixel. What hard shadows, soft shadows and ambient
// occlusion start from; no OpenGL.
#pragma once

#include <tenebra/frame_geometry.h>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

namespace tenebra {

namespace points {
struct PointTiles;
}

/// Id of a pixel where no triangle is seen.
inline constexpr std::uint32_t no_triangle = 0xffffffffu;

/// Triangles of one instant: float vertices, taken as exact. Receivers and occluders alike, known by their
/// index.
struct TriangleView {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;
  std::span<const std::uint8_t> casts_shadow;  ///< one a triangle; empty: all cast
  std::span<const std::uint32_t>
      parts;                  ///< a hint: first triangle of each group that moves as one, ascending
  std::uint64_t version = 0;  ///< not 0: the caller's word that views of one number are the same throughout
};
inline TriangleView triangle_view(const FrameGeometry& geometry) {
  return {geometry.positions, geometry.triangles, geometry.casts_shadow, geometry.parts};
}

/// The visible points once more, in the form that hard shadows read; opaque. A copy is deep.
class PointTileStore {
public:
  PointTileStore();
  PointTileStore(const PointTileStore& other);
  PointTileStore(PointTileStore&&) noexcept;
  PointTileStore& operator=(const PointTileStore& other);
  PointTileStore& operator=(PointTileStore&&) noexcept;
  ~PointTileStore();

  bool empty() const;
  void clear();
  points::PointTiles& operator*();                                       ///< made where there are none
  const points::PointTiles& operator*() const { return *tiles_; }        ///< if not empty()
  const points::PointTiles* operator->() const { return tiles_.get(); }  ///< if not empty()

private:
  std::unique_ptr<points::PointTiles> tiles_;
};

/// Samples, one a pixel, row 0 at the top: a point, taken as exact, and the triangle it lies on.
struct VisiblePoints {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec3> positions;     ///< width * height; meaningless where the id is no_triangle
  std::vector<std::uint32_t> triangles;  ///< width * height ids, or no_triangle
  PointTileStore tiles;  ///< empty, or the same points again: to be cleared by whoever changes them
};

/// Hard shadows read tiles; where there are none they make their own, of points in rows.
enum class PointLayout { rows, rows_and_tiles };

/// Points where the pixels' rays meet the planes of their triangles, in double, clamped into the triangle
/// (a rasteriser's id may lie just outside). `ids`: width * height, row 0 at the top; ids out of range count
/// as no_triangle. Bits do not depend on threads; those of rows not on the instruction set either.
void compute_visible_points(std::span<const std::uint32_t> ids, int width, int height, const ViewRays& view,
                            const TriangleView& triangles, VisiblePoints& out,
                            PointLayout layout = PointLayout::rows);

/// Unit shading normals at the points, one a pixel: `normals` (one a vertex of `triangles`; empty: face
/// normals) interpolated in double, turned to the side from which `view` sees the triangle; the face normal
/// where the interpolated one vanishes; zero where no triangle is seen or it has no area. Bits do not depend
/// on threads or instruction set.
void compute_shading_normals(const VisiblePoints& points, std::span<const glm::vec3> normals,
                             const ViewRays& view, const TriangleView& triangles,
                             std::vector<glm::vec3>& out);

}  // namespace tenebra
