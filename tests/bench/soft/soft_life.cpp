#include "bench/soft/soft_life.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t stops = 24;
constexpr int runs = 3;

std::uint32_t busiest_triangle(const SoftView& view, std::span<const std::uint8_t> penumbra,
                               std::size_t most_points) {
  const auto& ids = view.frame.points.triangles;
  std::vector<std::size_t> seen(view.frame.geometry.triangles.size()), partly(seen.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] == no_triangle) continue;
    ++seen[ids[i]];
    partly[ids[i]] += penumbra[i];
  }
  std::uint32_t best = no_triangle;
  for (std::size_t t = 0; t < seen.size(); ++t) {
    if (seen[t] > most_points || partly[t] == 0) continue;
    if (best == no_triangle || partly[t] > partly[best]) best = static_cast<std::uint32_t>(t);
  }
  return best;
}

/// The first `count` of `pixels`, and nothing else.
VisiblePoints only(const VisiblePoints& points, std::span<const std::size_t> pixels, std::size_t count) {
  VisiblePoints some{points.width, points.height, points.positions, {}};
  some.triangles.assign(points.triangles.size(), no_triangle);
  for (const std::size_t pixel : pixels.first(count)) some.triangles[pixel] = points.triangles[pixel];
  return some;
}

/// Time of all queries of a tree with these points, and what it holds in the end.
LifeRow life_up_to(const SoftView& view, const VisiblePoints& points, double& query_us) {
  SoftShadowConfig config;
  config.solver = SoftSolver::bsp;
  config.grouping = SoftGrouping::triangle;
  SoftShadowTracer tracer;
  SoftMask mask;
  query_us = HUGE_VAL;
  for (int run = 0; run < runs; ++run) {
    tracer.trace(points, view.frame.normals, view.frame.view, view.frame.triangles(), view.light, config,
                 mask);
    query_us = std::min(query_us, 1000 * (tracer.timings().query_ms + tracer.timings().irradiance_ms));
  }
  return {0, 0, static_cast<double>(tracer.stats().peak_tree_bytes),
          static_cast<double>(tracer.stats().tree_nodes)};
}

}  // namespace

std::vector<LifeRow> measure_life(const SoftView& view, std::span<const std::uint8_t> penumbra,
                                  std::size_t most_points, Report& report) {
  const std::uint32_t triangle = busiest_triangle(view, penumbra, most_points);
  if (triangle == no_triangle) return {};
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < view.frame.pixel_count(); ++i) {
    if (view.frame.points.triangles[i] == triangle) pixels.push_back(i);
  }
  progress(fmt::format("{}: one tree's life over {} queries", view.name, pixels.size()));
  std::vector<LifeRow> rows;
  double before_us = 0;
  std::size_t before = 0;
  with_threads(1, [&] {
    for (std::size_t stop = 1; stop <= stops; ++stop) {
      const std::size_t count = pixels.size() * stop * stop / (stops * stops);  // denser at first
      if (count <= before) continue;
      double us = 0;
      LifeRow row = life_up_to(view, only(view.frame.points, pixels, count), us);
      row.queries = count;
      row.us_a_query = std::max(us - before_us, 0.0) / static_cast<double>(count - before);
      before = count, before_us = us;
      rows.push_back(row);
    }
  });
  for (const LifeRow& row : rows) {
    const std::string parameter = fmt::format("queries={}", row.queries);
    report.add({"figure11", view.name, "tenebra", parameter, "time a query", row.us_a_query, "us"});
    report.add({"figure11", view.name, "tenebra", parameter, "tree memory", row.bytes, "bytes"});
    report.add({"figure11", view.name, "tenebra", parameter, "tree nodes", row.nodes, ""});
  }
  return rows;
}

}  // namespace tenebra::bench
