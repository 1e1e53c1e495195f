// Figure 8 of the paper, its last column: what a frame costs as objects are added.
#include <fmt/core.h>
#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_crowd.h"
#include "bench/ao/ao_frame_peer.h"
#include "bench/ao/ao_race.h"
#include "bench/ao/ao_session.h"
#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

constexpr float crowd_reach_m = 1.0f;
constexpr int rays = 64;

struct Cost {
  std::size_t triangles = 0;
  double field_ms = 0, embree_ms = 0;
  std::uint64_t lookups = 0;
};

Expected<Cost> cost_of(const AoSession& session, const std::vector<Object>& meshes, int count) {
  const Scene scene = make_crowd(meshes, count, far_view.spacing_m);
  BenchFrame frame;
  see_crowd(scene, far_view, 0, session.by_effort(64, 512, 1024), frame);
  const FramePeer peer(scene, frame, crowd_reach_m);
  AmbientOcclusion ao;
  std::vector<float> values;
  std::vector<double> field, embree;
  for (int round = -1; round < session.by_effort(1, 3, 5); ++round) {
    CostClock clock;  // the first round builds
    auto done = ao.compute(scene, frame.geometry, frame.points, frame.normals,
                           session.field_config(rays, crowd_reach_m), values);
    if (!done) return tl::unexpected(done.error());
    if (round < 0) continue;
    field.push_back(clock.ms());
    embree.push_back(peer.trace_ms(rays, 1, PeerMode::packets, session.by_effort(1, 16, 8)));
  }
  return Cost{frame.geometry.triangles.size(), median(field), median(embree), ao.stats().lookups};
}

}  // namespace

Expected<void> measure_many(AoSession& session) {
  std::vector<std::string> known;  // named with the frames
  auto meshes = crowd_objects(session.options.data, known);
  if (session.effort == Effort::tiny) meshes.resize(1);
  std::vector<std::vector<std::string>> rows{
      {"objects", "triangles", "look-ups", "field ms", "embree ms", "embree / field"}};
  Curve field{"field", {}}, embree{"embree, packets", {}};
  for (const int count : {1, 5, 10, 20, 50}) {
    if (session.effort == Effort::tiny && count > 1) continue;
    progress(fmt::format("many: {} objects", count));
    const auto cost = cost_of(session, meshes, count);
    if (!cost) return tl::unexpected(cost.error());
    rows.push_back({fmt::format("{}", count), fmt::format("{}", cost->triangles),
                    fmt::format("{}", cost->lookups), fmt::format("{:.1f}", cost->field_ms),
                    fmt::format("{:.0f}", cost->embree_ms),
                    fmt::format("{:.1f}", cost->embree_ms / cost->field_ms)});
    const std::string parameter = fmt::format("objects={}", count);
    session.report.add({"figure8", "crowd", "field", parameter, "time", cost->field_ms, "ms"});
    session.report.add({"figure8", "crowd", "embree", parameter, "time", cost->embree_ms, "ms"});
    field.points.emplace_back(count, cost->field_ms);
    embree.points.emplace_back(count, cost->embree_ms);
  }
  print_table(fmt::format("Figure 8, multiple objects: frames of {} rays per point for both", rays), rows);
  session.report.add_plot("figure8_objects",
                          curve_plot("Time of a frame, 64 rays per point for both", {"objects", false},
                                     {"time (ms)", true}, {field, embree}));
  return {};
}

}  // namespace tenebra::bench
