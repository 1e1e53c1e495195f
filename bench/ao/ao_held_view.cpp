#include "bench/ao/ao_held_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_moving.h"
#include "bench/common/bench_embree.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {
namespace {

struct Change {
  double sum = 0, squares = 0, largest = 0;
  std::size_t pixels = 0, seen = 0;  ///< seen: changed by more than 1/255

  void add(double change) {
    sum += change, squares += change * change, ++pixels;
    largest = std::max(largest, change);
    if (change > 1) ++seen;
  }
  double over(double total) const { return pixels == 0 ? 0 : total / static_cast<double>(pixels); }
};

/// The frame as another view sees it.
void see_from(const ViewRays& view, int width, int height, BenchFrame& frame) {
  frame.view = view;
  const auto ids = nearest_triangles(frame.triangles(), view, width, height);
  compute_visible_points(ids, width, height, view, frame.triangles(), frame.points);
  compute_shading_normals(frame.points, frame.geometry.normals, frame.triangles(), frame.normals);
}

void compare(const BenchFrame& now, const BenchFrame& next, std::span<const float> before,
             std::span<const float> after, double reach, Change& change) {
  const MovingTriangles moving(now.geometry, next.geometry);
  for (std::size_t p = 0; p < after.size(); ++p) {
    const std::uint32_t id = now.points.triangles[p];
    if (id == no_triangle || id != next.points.triangles[p] || moving.moves()[id]) continue;
    if (moving.within(now.points.positions[p], reach)) continue;
    change.add(255 * std::abs(double{after[p]} - double{before[p]}));
  }
}

}  // namespace

Expected<void> measure_held_view(AoSession& session, const std::string& name, const Scene& scene, int first,
                                 std::vector<std::vector<std::string>>& rows) {
  const int width = session.by_effort(64, 512, 512), height = width, frames = session.by_effort(1, 5, 30);
  AmbientOcclusion ao;
  AoConfig config{.mode = AoMode::adaptive};
  std::vector<float> before, after;
  BenchFrame now, next;
  evaluate_bench_frame(scene, first, width, height, now);
  const ViewRays held = now.view;
  config.distance_m = static_cast<double>(now.diagonal_m) / 20;
  if (auto done = ao.compute(scene, now.geometry, now.points, now.normals, config, before); !done)
    return done;
  Change change;
  for (int f = 1; f <= frames; ++f) {
    progress(fmt::format("steadiness: {}, held view, frame {}", name, first + f));
    evaluate_bench_frame(scene, first + f, width, height, next);
    see_from(held, width, height, next);
    if (auto done = ao.compute(scene, next.geometry, next.points, next.normals, config, after); !done)
      return done;
    compare(now, next, before, after, config.distance_m, change);
    std::swap(now, next);
    std::swap(before, after);
  }
  const double mean = change.over(change.sum), rms = std::sqrt(change.over(change.squares)),
               seen = 100 * change.over(static_cast<double>(change.seen));
  rows.push_back({name, fmt::format("{}..{}", first, first + frames), fmt::format("{}", change.pixels),
                  fmt::format("{:.3f}", mean), fmt::format("{:.3f}", rms),
                  fmt::format("{:.1f}", change.largest), fmt::format("{:.2f}", seen)});
  const auto add = [&](const char* quantity, double value, const char* unit) {
    session.report.add({"flicker", name, "adaptive", "held view", quantity, value, unit});
  };
  add("mean change of undisturbed pixels", mean, "1/255");
  add("RMS change of undisturbed pixels", rms, "1/255");
  add("largest change of undisturbed pixels", change.largest, "1/255");
  if (change.pixels > 0) keep_largest(session.headline.flicker_mean_255, mean);
  return {};
}

}  // namespace tenebra::bench
