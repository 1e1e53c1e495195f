// What objects hide of their own surface: the whole of AmbientOcclusion on an object that moves and is alone.
#include <fmt/core.h>
#include <cmath>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_contestants.h"
#include "bench/ao/ao_crowd.h"
#include "bench/ao/ao_session.h"

namespace tenebra::bench {
namespace {

struct Found {
  std::vector<float> hidden;
  double build_ms = 0;
};

/// Occlusion at points of an object whose node moves, at rest.
Expected<Found> found_on(const AoSession& session, const Object& object,
                         const std::vector<SurfacePoint>& points, float reach) {
  const Scene scene = make_crowd({object}, 1, 0);
  FrameGeometry geometry;
  evaluate_frame(scene, -1, 0, geometry);
  // The floor is of another body: the object is asked alone.
  const std::size_t floor_triangles = scene.meshes[0].triangles.size();
  for (std::size_t i = 0; i < floor_triangles; ++i) geometry.casts_shadow[i] = 0;
  VisiblePoints visible{static_cast<int>(points.size()), 1, {}, {}};
  std::vector<glm::vec3> normals;
  for (const SurfacePoint& point : points) {
    visible.positions.emplace_back(point.at.position);
    visible.triangles.push_back(point.triangle + static_cast<std::uint32_t>(floor_triangles));
    normals.push_back(point.at.normal);
  }
  AmbientOcclusion ao;
  Found found;
  auto done = ao.compute(scene, geometry, visible, normals, session.field_config(256, reach), found.hidden);
  if (!done) return tl::unexpected(done.error());
  found.build_ms = ao.timings().ao_build_ms;
  for (float& v : found.hidden) v = 1 - v;
  return found;
}

}  // namespace

Expected<void> measure_surface(AoSession& session) {
  std::vector<std::string> known;  // named with the errors already
  const auto objects = error_objects(session.options.data, known);
  if (!objects) return tl::unexpected(objects.error());
  std::vector<std::vector<std::string>> rows{
      {"object", "triangles", "points", "build s", "RMS", "embree, 256 rays"}};
  for (const Object& object : *objects) {
    if (session.effort == Effort::tiny && object.name != "robot head") continue;
    progress(fmt::format("surface: {}", object.name));
    const Ball ball = ObjectTree(object).ball;
    const AoPeer peer(object);
    const auto reach = static_cast<float>(2 * ball.radius), start = 1e-5f * reach;
    const auto points = surface_points(object, session.by_effort(100, 2000, 5000), 23);
    std::vector<Receiver> receivers;
    for (const SurfacePoint& point : points) receivers.push_back(point.at);
    const auto truth = occlusion(receivers, CosineRays(session.by_effort(256, 4096, 4096), 29), reach,
                                 peer.packets(false, start));
    const double noise =
        rms_255(occlusion(receivers, CosineRays(256, 31), reach, peer.packets(false, start)), truth);
    const auto found = found_on(session, object, points, reach);
    if (!found) return tl::unexpected(found.error());
    const double rms = rms_255(found->hidden, truth);
    session.report.add({"surface", object.name, "field", "rays=256", "rms", rms, "1/255"});
    session.report.add({"surface", object.name, "field", "rays=256", "build", found->build_ms, "ms"});
    session.report.add({"surface", object.name, "embree", "rays=256", "rms", noise, "1/255"});
    rows.push_back({object.name, fmt::format("{}", object.triangles.size()), fmt::format("{}", points.size()),
                    fmt::format("{:.2f}", found->build_ms / 1e3), fmt::format("{:.2f}", rms),
                    fmt::format("{:.2f}", noise)});
    if (object.name != "flake") keep_largest(session.headline.surface_rms_255, rms);
  }
  print_table("Occlusion of the object by itself: RMS in 1/255 over its surface", rows);
  return {};
}

}  // namespace tenebra::bench
