#include "bench/hard/hard_contest.h"

#include <array>

#include "bench/ao/ao_race.h"
#include "bench/hard/hard_embree.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

/// One kind of Embree's builds with both packings.
struct Peer {
  Peer(const HardView& view, RTCBuildQuality quality, const HardContest& contest)
      : embree(view.frame.triangles(), quality, contest.threads, contest.simd) {}
  HardPeer embree;
  std::array<std::vector<double>, 2> trace_ms;
  std::vector<double> build_ms;
  ShadowMask mask;

  void round(const PeerPoints& points, const ShadowLight& light, bool build) {
    if (build) build_ms.push_back(cost_ms([&] { embree.build(); }));
    for (const PacketTile tile : packet_tiles) {
      trace_ms[static_cast<std::size_t>(tile)].push_back(
          cost_ms([&] { embree.trace(points, light, tile, mask); }));
    }
  }
  void forget() {
    for (auto& times : trace_ms) times.clear();
    build_ms.clear();
  }
  PacketTile best() const {
    return median(trace_ms[0]) <= median(trace_ms[1]) ? PacketTile::wide : PacketTile::square;
  }
  double best_ms() const { return median(trace_ms[static_cast<std::size_t>(best())]); }
};

std::size_t count_differing(const VisiblePoints& points, const ShadowMask& ours, const PeerPoints& padded,
                            const ShadowMask& theirs) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const std::size_t x = i % static_cast<std::size_t>(points.width),
                      y = i / static_cast<std::size_t>(points.width);
    differing += ours[i] != theirs[y * static_cast<std::size_t>(padded.width) + x] ? 1 : 0;
  }
  return differing;
}

/// Tenebra's default, kept from frame to frame.
struct Ours {
  const HardView& view;
  HardShadowConfig config;
  ShadowTracer tracer;
  ShadowMask mask;
  std::vector<double> dynamic_ms, static_ms;
  std::array<std::vector<double>, 2> points_ms;  // by PointLayout

  double trace(const TriangleView& triangles) {
    return cost_ms([&] { tracer.trace_shadow_mask(view.frame.points, triangles, view.light, config, mask); });
  }
  void round(bool dynamic) {
    if (dynamic) {
      trace(triangle_view(view.before));
      dynamic_ms.push_back(trace(view.frame.triangles()));
    }
    // The caller's word that nothing moved: what an application gives that knows its scene.
    TriangleView unmoved = view.frame.triangles();
    unmoved.version = 1;
    trace(unmoved);
    static_ms.push_back(trace(unmoved));
  }
  void time_points(int rounds) {
    const BenchFrame& f = view.frame;
    std::array<VisiblePoints, 2> points;
    for (int i = 0; i < rounds; ++i) {
      for (const PointLayout layout : {PointLayout::rows, PointLayout::rows_and_tiles}) {
        const auto place = static_cast<std::size_t>(layout);
        points_ms[place].push_back(cost_ms([&] {
          compute_visible_points(f.points.triangles, f.points.width, f.points.height, f.view, f.triangles(),
                                 points[place], layout);
        }));
      }
    }
  }
};

HardTimes contest_here(const HardView& view, const HardContest& contest) {
  const PeerPoints points = peer_points(view);
  Peer low(view, RTC_BUILD_QUALITY_LOW, contest);
  Peer medium(view, RTC_BUILD_QUALITY_MEDIUM, contest);
  Peer high(view, RTC_BUILD_QUALITY_HIGH, contest);
  Ours ours{view, {.simd = contest.simd}, {}, {}, {}, {}, {}};
  for (int round = -1; round < contest.rounds; ++round) {
    if (round == 0) {
      for (Peer* peer : {&low, &medium, &high}) peer->forget();
      ours.dynamic_ms.clear(), ours.static_ms.clear();
    }
    ours.round(contest.dynamic);
    if (contest.dynamic) low.round(points, view.light, true);
    medium.round(points, view.light, false);
    high.round(points, view.light, false);
  }
  ours.time_points(std::min(contest.rounds, 3));

  HardTimes times;
  times.ours_static = median(ours.static_ms);
  times.points = median(ours.points_ms[0]);
  times.tiled_points = median(ours.points_ms[1]);
  const Peer& better = medium.best_ms() <= high.best_ms() ? medium : high;
  times.embree_static = better.best_ms();
  times.static_tile = packet_tile_name(better.best());
  if (contest.dynamic) {
    times.ours_dynamic = median(ours.dynamic_ms);
    times.embree_build = median(low.build_ms);
    times.embree_dynamic = times.embree_build + low.best_ms();
    times.dynamic_tile = packet_tile_name(low.best());
  }
  times.differing = count_differing(view.frame.points, ours.mask, points, better.mask);
  times.stats = ours.tracer.stats();
  return times;
}

}  // namespace

HardTimes run_hard_contest(const HardView& view, const HardContest& contest) {
  HardTimes times;
  with_threads(contest.threads, [&] { times = contest_here(view, contest); });
  return times;
}

void report_times(const HardTimes& times, const std::string& experiment, const std::string& view,
                  const std::string& parameter, Report& report) {
  const auto add = [&](const char* contestant, const char* quantity, double value, const char* unit) {
    report.add({experiment, view, contestant, parameter, quantity, value, unit});
  };
  if (times.embree_dynamic > 0) {
    add("tenebra", "dynamic_time", times.ours_dynamic, "ms");
    add("embree", "build_time", times.embree_build, "ms");
    add("embree", "dynamic_time", times.embree_dynamic, "ms");
    add("tenebra", "dynamic_ratio", times.dynamic_ratio(), "");
    add("tenebra", "dynamic_ratio_with_points", times.dynamic_ratio_with_points(), "");
  }
  add("tenebra", "static_time", times.ours_static, "ms");
  add("embree", "static_time", times.embree_static, "ms");
  add("tenebra", "static_ratio", times.static_ratio(), "");
  add("tenebra", "static_ratio_with_points", times.static_ratio_with_points(), "");
  add("both", "points_time", times.points, "ms");
  add("tenebra", "tiled_points_time", times.tiled_points, "ms");
  add("embree", "differing_pixels", static_cast<double>(times.differing), "");
  add("tenebra", "rays", static_cast<double>(times.stats.rays), "");
  add("tenebra", "nodes", static_cast<double>(times.stats.nodes), "");
  add("tenebra", "leaf_tests", static_cast<double>(times.stats.leaf_tests), "");
}

}  // namespace tenebra::bench
