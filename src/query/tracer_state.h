// The state of a PointTracer between calls, shared by its three kinds of questions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <tenebra/queries.h>
#include "base/fail.h"
#include "query/geometry_data.h"
#include "query/geometry_scene.h"
#include "query/point_surfaces.h"
#include "query/portion.h"

namespace tenebra::query {

struct TracerState {
  using Data = std::shared_ptr<GeometryData>;

  ShadowTracer hard;
  SoftShadowTracer soft;
  AmbientOcclusion ambient;
  GeometryScene scene;  ///< for `ambient`

  VisiblePoints seen;              ///< a portion
  std::vector<glm::vec3> normals;  ///< its shading normals
  ShadowMask mask;
  SoftMask visible;
  std::vector<float> openness;

  std::shared_ptr<const GeometryData> followed;
  std::uint64_t revision = 0;
  std::uint64_t version = 0;   ///< another for each geometry and each of its moves
  std::uint64_t occluded = 0;  ///< the version that `ambient` knows

  /// Whether this differs from the geometry of the last call.
  bool follow(const Data& data) {
    if (followed == data && revision == data->revision) return false;
    followed = data, revision = data->revision;
    ++version;
    return true;
  }

  /// The triangles that hard and soft shadows meet.
  TriangleView triangles() const {
    TriangleView view = view_of(*followed);
    view.version = version;
    return view;
  }

  /// Where a point is, relative to the geometry's origin.
  glm::dvec3 place_of(const QueryPoints& points, std::size_t i) const {
    return points.positions[i] - followed->origin;
  }

  /// A portion's points; which triangles they lie on, and on which sides, is not set yet.
  void begin(const QueryPoints& points, const Portion& portion) {
    seen.width = portion.width(), seen.height = portion.height();
    seen.tiles.clear();
    seen.sides.assign(portion.pixels(), 0);
    seen.triangles.assign(portion.pixels(), no_triangle);
    seen.positions.resize(portion.pixels());
    each_point(portion, [&](std::size_t i, std::size_t pixel) {
      seen.positions[pixel] = place_of(points, portion.first() + i);
    });
  }
};

}  // namespace tenebra::query
