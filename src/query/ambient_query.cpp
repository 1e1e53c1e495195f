// Ambient occlusion of points: the geometry as a scene.
#include "query/tracer_state.h"

namespace tenebra {
namespace {

using glm::dvec3;

/// Unit: the point's own, else its triangle's on its side, else zero.
dvec3 open_normal(const QueryPoints& points, std::size_t point, const TriangleView& triangles) {
  const dvec3 own(query::normal_of(points, point));
  if (own != dvec3(0.0)) return glm::normalize(own);
  const std::uint32_t triangle = query::triangle_of(points, point);
  if (triangle == no_triangle) return dvec3(0.0);
  const int side = query::said_side(points, point, triangles);
  return query::face_normal(triangles, triangle) * (side < 0 ? -1.0 : 1.0);
}

Expected<void> check_normals(const QueryPoints& points) {
  for (std::size_t i = 0; i < points.positions.size(); ++i)
    if (query::triangle_of(points, i) == no_triangle && query::normal_of(points, i) == glm::vec3(0.0f))
      return base::fail(
          "ambient occlusion: point {} has neither a triangle nor a normal, expected one of them", i);
  return {};
}

}  // namespace

Expected<void> PointTracer::ambient_occlusion(const Geometry& geometry, const QueryPoints& points,
                                              const AoConfig& asked, std::span<float> openness,
                                              const StopFlag* stop, const QueryProgress& progress) {
  const parallel::FloatEnvironment ieee;
  query::TracerState& s = *state_;
  if (openness.size() != points.positions.size())
    return base::fail("ambient occlusion: found room for {} values, expected one for each of {} points",
                      openness.size(), points.positions.size());
  if (auto checked = query::check_points(points, *geometry.data_); !checked) return checked;
  if (auto checked = check_normals(points); !checked) return checked;
  AoConfig config = asked;
  if (config.mode == AoMode::none) config.mode = AoMode::adaptive;
  if (config.distance_m == 0) {
    const double diagonal = geometry.data_->diagonal;
    config.distance_m = diagonal > 0 ? diagonal / 20 : 1;
  }
  if (s.follow(geometry.data_) || s.occluded != s.version) s.ambient = AmbientOcclusion();
  s.occluded = s.version;
  if (query::some_free(points)) config.place = AoPlace::pixels;  // a point in the air has no vertices

  return query::in_portions(points, stop, progress, [&](const query::Portion& portion) -> Expected<void> {
    if (!s.scene.follow(geometry.data_, stop)) return base::stopped();
    const TriangleView triangles = triangle_view(s.scene.geometry());
    s.begin(points, portion);
    s.normals.assign(portion.pixels(), glm::vec3(0.0f));
    query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
      const std::size_t point = portion.first() + i;
      const std::uint32_t triangle = query::triangle_of(points, point);
      const dvec3 normal = open_normal(points, point, triangles);
      s.normals[pixel] = glm::vec3(normal);
      s.seen.triangles[pixel] = triangle == no_triangle ? free_point : triangle;
    });
    if (auto done = s.ambient.compute(s.scene.scene(), s.scene.geometry(), s.seen, s.normals, config,
                                      s.openness, {}, stop);
        !done)
      return done;
    query::each_point(portion, [&](std::size_t i, std::size_t pixel) {
      openness[portion.first() + i] = s.openness[pixel];
    });
    return {};
  });
}

}  // namespace tenebra
