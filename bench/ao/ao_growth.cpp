// Figure 8 of the paper: what a look-up costs as the object's triangles grow a thousand-fold.
#include <fmt/core.h>
#include <algorithm>
#include <cmath>
#include <memory>

#include "bench/ao/ao_contestants.h"
#include "bench/ao/ao_race.h"
#include "bench/ao/ao_session.h"
#include "bench/common/bench_plot.h"

namespace tenebra::bench {
namespace {

/// One mesh, subdivided.
struct Level {
  Object object;
  ObjectTree tree;
  std::unique_ptr<BuiltField> field;
  AoPeer peer;
  double field_ms = 0, embree_ms = 0;

  explicit Level(Object of) : object(std::move(of)), tree(object), peer(object) {}
};

void race_levels(std::vector<std::unique_ptr<Level>>& levels, std::span<const trees::RayBatch> rays,
                 int rounds) {
  std::vector<Racer> racers;
  for (const auto& level : levels) {
    racers.push_back({"field", field_tracer(*level->field)});
    racers.push_back({"embree", level->peer.single_rays()});
    racers.push_back({"embree", level->peer.packets(false)});
  }
  race(racers, rays, rounds);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    levels[i]->field_ms = racers[3 * i].ms;
    levels[i]->embree_ms = std::min(racers[3 * i + 1].ms, racers[3 * i + 2].ms);
  }
}

/// How much slower, in percent.
double growth(double from_ms, double to_ms) {
  return 100 * (to_ms / from_ms - 1);
}

void tell(AoSession& session, const std::vector<std::unique_ptr<Level>>& levels) {
  std::vector<std::vector<std::string>> rows{{"triangles", "tree s", "build s", "look-up ms", "growth %",
                                              "embree build s", "embree ms", "embree growth %"}};
  Curve field{"field", {}}, embree{"embree", {}};
  for (const auto& level : levels) {
    const double percent = growth(levels[0]->field_ms, level->field_ms);
    const double peer_percent = growth(levels[0]->embree_ms, level->embree_ms);
    const auto triangles = static_cast<double>(level->object.triangles.size());
    const double field_ms = level->field_ms, embree_ms = level->embree_ms;
    const std::string view = fmt::format("triangles={}", level->object.triangles.size());
    rows.push_back({fmt::format("{}", level->object.triangles.size()),
                    fmt::format("{:.2f}", level->tree.build_ms / 1e3),
                    fmt::format("{:.2f}", level->field->build_ms / 1e3), fmt::format("{:.2f}", field_ms),
                    fmt::format("{:.1f}", percent), fmt::format("{:.2f}", level->peer.build_ms() / 1e3),
                    fmt::format("{:.2f}", embree_ms), fmt::format("{:.1f}", peer_percent)});
    session.report.add(
        {"figure8", "knot", "field", view, "build", level->tree.build_ms + level->field->build_ms, "ms"});
    session.report.add({"figure8", "knot", "field", view, "look-up", field_ms, "ms"});
    session.report.add({"figure8", "knot", "field", view, "growth", percent, "%"});
    session.report.add({"figure8", "knot", "embree", view, "look-up", embree_ms, "ms"});
    session.report.add({"figure8", "knot", "embree", view, "growth", peer_percent, "%"});
    field.points.emplace_back(triangles, field_ms);
    embree.points.emplace_back(triangles, embree_ms);
  }
  print_table("Figure 8: rays from the corner (256 per point) against one mesh, subdivided", rows);
  session.headline.growth_1k_to_1m = growth(levels.front()->field_ms, levels.back()->field_ms);
  session.report.add_plot("figure8", curve_plot("Cost of the corner's rays", {"triangles", true},
                                                {"time (ms)", true}, {field, embree}));
}

}  // namespace

Expected<void> measure_growth(AoSession& session) {
  const Object coarse = make_knot(64, 8);  // 1,024 triangles
  std::vector<std::unique_ptr<Level>> levels;
  for (int times = 0; times <= session.by_effort(1, 5, 5); ++times) {
    levels.push_back(std::make_unique<Level>(subdivided(coarse, times)));
    Level& level = *levels.back();
    progress(fmt::format("growth: {} triangles", level.object.triangles.size()));
    auto field = build_field(level.object, level.tree, session.table());
    if (!field) return tl::unexpected(field.error());
    level.field = std::move(*field);
  }
  const Ball& ball = levels[0]->tree.ball;
  auto rays = batches_towards(corner_receivers(ball), CosineRays(256, 7), ball.centre, ball.radius);
  if (session.effort == Effort::tiny) rays.resize(1000);
  race_levels(levels, rays, session.by_effort(1, 5, 15));
  tell(session, levels);
  return {};
}

}  // namespace tenebra::bench
