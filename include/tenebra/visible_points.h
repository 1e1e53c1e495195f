// The samples of a frame: for each pixel a point on a triangle. Hard shadows, soft shadows and ambient
// occlusion start from them. No OpenGL.
#pragma once

#include <tenebra/frame_geometry.h>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tenebra {

namespace points {
struct PointTiles;
struct ViewOfSamples;
}  // namespace points

/// Id of a pixel where no triangle is seen.
inline constexpr std::uint32_t no_triangle = 0xffffffffu;
/// Id of a point that lies on no triangle: it counts as rounded to float where a triangle may touch it. Hard
/// shadows see all around it. For soft shadows its side is 0, and it sees all around, or 1, and it sees the
/// half of space that its shading normal points into.
inline constexpr std::uint32_t free_point = 0xfffffffeu;

/// Triangles of one instant that the caller owns, receivers and occluders alike. Vertices are floats,
/// taken as exact; a triangle's id is its index.
struct TriangleView {
  std::span<const glm::vec3> positions;        ///< vertices, metres, world space
  std::span<const glm::uvec3> triangles;       ///< three vertices each; ids are places here
  std::span<const std::uint8_t> casts_shadow;  ///< one for each triangle; empty: all cast
  std::span<const std::uint32_t>
      parts;                  ///< a hint, ascending: the first triangle of each run that moves as one
  std::uint64_t version = 0;  ///< if not 0, the caller promises that views with the same number are equal
  /// One for each vertex (zero: the face normal): points are on the smooth surface that these describe, see
  /// lift_visible_points(). Empty: points are on the triangles. `version` does not cover them.
  std::span<const glm::vec3> normals{};
};
/// Views into `geometry`, which must live as long.
inline TriangleView triangle_view(const FrameGeometry& geometry) {
  return {geometry.positions, geometry.triangles, geometry.casts_shadow, geometry.parts};
}

/// The visible points once more, in the form that hard shadows read. Opaque; copies are deep.
class PointTileStore {
public:
  PointTileStore();
  PointTileStore(const PointTileStore& other);
  PointTileStore(PointTileStore&&) noexcept;
  PointTileStore& operator=(const PointTileStore& other);
  PointTileStore& operator=(PointTileStore&&) noexcept;
  ~PointTileStore();

  bool empty() const;                                                    ///< whether there are none
  void clear();                                                          ///< drops them
  points::PointTiles& operator*();                                       ///< makes them if there are none
  const points::PointTiles& operator*() const { return *tiles_; }        ///< if not empty()
  const points::PointTiles* operator->() const { return tiles_.get(); }  ///< if not empty()

private:
  std::unique_ptr<points::PointTiles> tiles_;
};

/// The view that samples were seen from, if from one: their sides, and positions that are not stored, are
/// worked out from it. Only what makes samples looks inside; what is asked about samples does not depend on
/// an eye but for these.
class SeenFrom {
public:
  SeenFrom() = default;  ///< from none
  SeenFrom(const ViewRays& view)
      : view_(view) {}  // NOLINT(google-explicit-constructor): samples are of a view

private:
  friend struct points::ViewOfSamples;
  std::optional<ViewRays> view_;
};

/// For each pixel, row 0 at the top, a point and the triangle that it lies on. The points are taken as exact.
struct VisiblePoints {
  int width = 0;                         ///< pixels
  int height = 0;                        ///< pixels
  std::vector<glm::dvec3> positions;     ///< width * height; meaningless where the id is no_triangle.
                                         ///< Empty: visible_position() says where they are
  std::vector<std::uint32_t> triangles;  ///< width * height ids, no_triangle or free_point
  /// The side of its triangle that each point is on: 1 where the triangle is counter-clockwise, -1 behind, 0
  /// on neither, so that no light reaches it. Empty: visible_side() says which.
  std::vector<std::int8_t> sides;
  PointTileStore tiles;  ///< empty, or the same points again: clear them if you change the points or sides
  SeenFrom seen_from;    ///< the rays of the pixels, where `positions` is empty; the eye, where `sides` is
};

/// The forms in which points are stored. Hard shadows read tiles, and make their own if there are none; the
/// few positions that they need as well are computed again. Soft shadows and occlusion read rows of
/// positions, and make their own if there are none.
enum class PointLayout { rows, rows_and_tiles, tiles };

/// Finds where the pixels' rays meet the planes of their triangles, in double, clamped into the triangle (a
/// rasteriser's id may belong to a triangle that the ray just misses). `ids`: width * height, row 0 at the
/// top; ids out of range count as no_triangle. The bits do not depend on the number of threads, and those of
/// rows not on the instruction set either. With TriangleView::normals they are then lifted.
void compute_visible_points(std::span<const std::uint32_t> ids, int width, int height, const ViewRays& view,
                            const TriangleView& triangles, VisiblePoints& out,
                            PointLayout layout = PointLayout::rows);

/// The point of a pixel whose id is not no_triangle: from `positions` or, where that is empty, worked out
/// from id, pixel and `points.seen_from`. The same bits both ways.
glm::dvec3 visible_position(const VisiblePoints& points, const TriangleView& triangles, std::size_t pixel);
/// The side of the triangle that the pixel's point is on, whose id is not no_triangle: from `sides` or, where
/// that is empty, from `points.seen_from`: the side on which the eye lies, exactly (orthographic views: the
/// eye is at infinity against d0).
int visible_side(const VisiblePoints& points, const TriangleView& triangles, std::size_t pixel);

/// Lifts points of triangles that TriangleView::normals shade smoothly (their three normals differ) to the
/// surface that these describe, in double; all others stay as they are. `points`: with positions, on their
/// triangles, samples of any kind; tiles, where there are some, are made anew. A shadow that starts there
/// ends along a smooth line where light grazes, not along the triangles; the masks are exact for the points
/// as they are then. Triangles that share an edge and its normals lift it alike, and vertices stay. Nothing
/// is lifted where the surface is concave, where normals are equal or zero or contradict the triangle (not
/// all on one side of it), or by less than the effect of rounding. Give the same normals to whatever traces
/// the points. Compute shading normals from the points before lifting.
void lift_visible_points(const TriangleView& triangles, VisiblePoints& points);

/// Fills `out` with unit shading normals, one per pixel: `normals` (one for each vertex of `triangles`;
/// empty: face normals) interpolated in double and turned to the side that the point is on.
/// Where the interpolated normal vanishes it is the face normal; where no triangle is seen, or one without an
/// area, it is zero. The bits do not depend on the number of threads or the instruction set.
void compute_shading_normals(const VisiblePoints& points, std::span<const glm::vec3> normals,
                             const TriangleView& triangles, std::vector<glm::vec3>& out);

}  // namespace tenebra
