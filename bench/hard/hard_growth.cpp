// How the default and Embree's trace alone grow: with the size of the picture, with the triangles of the
// kitchen divided, and with copies side by side, out of view and in view.
#include <fmt/core.h>
#include <cmath>

#include "bench/common/bench_plot.h"
#include "bench/hard/hard_contest.h"
#include "bench/hard/hard_session.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

/// `count` copies in a square, a box's width and depth apart; the first stays in its place.
FrameGeometry copies(const FrameGeometry& one, const glm::vec3& size, std::size_t count) {
  FrameGeometry g;
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 shift(1.05f * size.x * static_cast<float>(i % side), 0.0f,
                          1.05f * size.z * static_cast<float>(i / side));
    const auto base = static_cast<std::uint32_t>(g.positions.size()),
               first = static_cast<std::uint32_t>(g.triangles.size());
    for (const glm::vec3& p : one.positions) g.positions.push_back(p + shift);
    for (const glm::uvec3& t : one.triangles) g.triangles.push_back(t + base);
    for (const std::uint32_t part : one.parts) g.parts.push_back(part + first);
    g.casts_shadow.insert(g.casts_shadow.end(), one.casts_shadow.begin(), one.casts_shadow.end());
  }
  return g;
}

struct Extent {
  glm::vec3 low{HUGE_VALF}, high{-HUGE_VALF};
  explicit Extent(const FrameGeometry& g) {
    for (const glm::vec3& p : g.positions) low = glm::min(low, p), high = glm::max(high, p);
  }
  glm::vec3 size() const { return high - low; }
};

/// One series: a row for each contest, and two curves.
struct Series {
  HardSession& session;
  std::string experiment;
  Rows rows{{"", "triangles", "tenebra", "E. static", "tile", "/static", "ns/ray", "tree MB"}};
  Curve ours{"Tenebra", {}}, embree{"Embree, trace alone", {}};

  HardTimes run(const HardView& view, double x) {
    const HardTimes t =
        run_hard_contest(view, {thread_count(), session.by_effort(1, 3, 7), false, session.simd});
    report_times(t, experiment, view.name, fmt::format("{}", x), session.report);
    ours.points.emplace_back(x, t.ours_static);
    embree.points.emplace_back(x, t.embree_static);
    rows.push_back({view.name, fmt::format("{}", t.stats.triangles), fmt::format("{:.2f}", t.ours_static),
                    fmt::format("{:.2f}", t.embree_static), t.static_tile,
                    fmt::format("{:.3f}", t.static_ratio()),
                    fmt::format("{:.2f}", t.ours_static * 1e6 /
                                              static_cast<double>(std::max<std::uint64_t>(1, t.stats.rays))),
                    fmt::format("{:.0f}", static_cast<double>(t.stats.tree_bytes) / 1e6)});
    progress(fmt::format("{}: {:.3f} of Embree static", view.name, t.static_ratio()));
    return t;
  }
  void conclude(const std::string& title, const std::string& axis) {
    if (rows.size() < 2) return;
    print_table(title, rows);
    session.report.add_plot(experiment, curve_plot(title, {axis, true}, {"time (ms)", true}, {ours, embree}));
  }
};

Expected<void> grow_resolution(HardSession& session) {
  Series series{session, "growth_resolution"};
  const auto sides =
      session.by_effort<std::vector<int>>({32, 64}, {512, 1024, 2048}, {512, 1024, 2048, 4096});
  for (const int side : sides) {
    auto done = for_each_view(session.options, {{"kitchen", {100}}, {"robots", {100}}}, {side, side},
                              session.skipped, [&](const Scene&, const HardView& view) -> Expected<void> {
                                HardView named = view;
                                named.name = fmt::format("{}, {}x{}", view.name, side, side);
                                series.run(named, side);
                                return {};
                              });
    if (!done) return done;
  }
  series.conclude("Growth with the picture", "pixels a side");
  return {};
}

Expected<void> grow_triangles(HardSession& session) {
  Series series{session, "growth_triangles"};
  const int steps = session.by_effort(1, 2, 3);
  auto done = for_each_view(session.options, {{"kitchen", {100}}}, session.size(), session.skipped,
                            [&](const Scene&, const HardView& first) -> Expected<void> {
                              HardView view = first;
                              for (int step = 0; step <= steps; ++step) {
                                if (step > 0) subdivide(view.frame.geometry), see_anew(view, session.size());
                                view.name = fmt::format("kitchen 100 x{}", 1 << (2 * step));
                                const double count =
                                    static_cast<double>(view.frame.geometry.triangles.size());
                                const HardTimes times = series.run(view, count);
                                if (step == 2) session.headline.growth_static_1_8m = times.static_ratio();
                              }
                              return {};
                            });
  if (!done) return done;
  series.conclude("Growth with the triangles of the kitchen, each divided in four", "triangles");
  return {};
}

/// From above a corner of all copies down on them.
ViewRays view_of_all(const Extent& all, PictureSize size) {
  const glm::vec3 centre = 0.5f * (all.low + all.high);
  const glm::vec3 eye = centre + glm::vec3(0.8f, 0.6f, 0.8f) * all.size();
  return look_at(eye, centre, {0, 1, 0}, 0.8f, 0.01f * glm::length(all.size()), size.width, size.height);
}

Expected<void> grow_copies(HardSession& session) {
  Series series{session, "growth_copies"};
  const std::size_t most = session.by_effort<std::size_t>(20000, 1000000, 10000000);
  auto done = for_each_view(
      session.options, {{"kitchen", {100}}, {"robots", {640}}}, session.size(), session.skipped,
      [&](const Scene&, const HardView& first) -> Expected<void> {
        HardView view = first;
        const std::size_t count = std::max<std::size_t>(1, most / first.frame.geometry.triangles.size());
        view.frame.geometry = copies(first.frame.geometry, Extent(first.frame.geometry).size(), count);
        view.before = {};
        view.name = fmt::format("{}, {} copies", first.name, count);
        const double triangles = static_cast<double>(view.frame.geometry.triangles.size());
        series.run(view, triangles);
        const Extent all(view.frame.geometry);
        view.frame.view = view_of_all(all, session.size());
        view.light = {};
        view.light.position = 0.5f * (all.low + all.high) + glm::vec3(0.3f, 1.0f, 0.2f) * all.size();
        see_anew(view, session.size());
        view.before = {};
        view.name += ", all in view";
        series.run(view, triangles);
        return {};
      });
  if (!done) return done;
  series.conclude("Growth with copies, out of view and in view", "triangles");
  return {};
}

}  // namespace

Expected<void> measure_hard_growth(HardSession& session) {
  if (auto done = grow_resolution(session); !done) return done;
  if (auto done = grow_triangles(session); !done) return done;
  return grow_copies(session);
}

}  // namespace tenebra::bench
