// The trade of soft shadows: the exact solvers, N points of the light with exact hard shadows, N rays of
// Embree, and the same behind shaft culling.
#include <fmt/core.h>
#include <memory>

#include "bench/ao/ao_race.h"
#include "bench/soft/soft_fair.h"
#include "bench/trade/trade_contest.h"
#include "bench/trade/trade_session.h"
#include "render/light_points.h"

namespace tenebra::bench {
namespace {

/// In 1/255 of white: over the penumbra and over the whole picture.
std::vector<double> errors_of(const Truth& truth, std::span<const float> irradiance) {
  const SoftErrors penumbra = errors_255(truth, irradiance, Where::penumbra),
                   all = errors_255(truth, irradiance, Where::everywhere);
  return {penumbra.rms, penumbra.worst, all.rms, all.worst};
}

/// One view with all settings on it.
class SoftTrade {
public:
  SoftTrade(TradeSession& session, const SoftView& view)
      : session_(session),
        view_(view),
        casters_(view.frame.triangles(), true),
        receivers_(sampled_receivers(view.frame)),
        picture_(view.frame.pixel_count()) {}

  Expected<TradeTable> run();

private:
  void add(const std::string& family, const std::string& setting, int rounds,
           std::function<std::span<const float>()> trace);
  void find_truth();
  void add_exact();
  void add_errors();
  void add_light_points();
  void add_embree();

  TradeSession& session_;
  const SoftView& view_;
  EmbreeScene casters_;
  std::vector<SampledReceiver> receivers_;
  std::vector<float> picture_;
  VisiblePoints tiled_;
  SoftShadowTracer tracer_;
  SoftMask mask_;
  Truth truth_;
  double truth_ms_ = 0;
  std::span<const float> found_;  // of the last run
  render::LightPointShadows light_points_;
  ShaftedSampler shafted_;
  std::vector<std::unique_ptr<SoftSampler>> samplers_;
  std::vector<Contestant> contestants_;
};

void SoftTrade::add(const std::string& family, const std::string& setting, int rounds,
                    std::function<std::span<const float>()> trace) {
  contestants_.push_back({family, setting, rounds, clocked([this, trace]() -> Expected<void> {
                            found_ = trace();
                            return {};
                          }),
                          [this] { return errors_of(truth_, found_); }});
}

void SoftTrade::find_truth() {
  const SoftShadowConfig config{.precision = SoftPrecision::reference};
  CostClock clock;
  tracer_.trace(view_.frame.points, view_.frame.normals, view_.frame.view, view_.frame.triangles(),
                view_.light, config, truth_.mask);
  truth_ms_ = clock.ms();
  finish_truth(view_.frame, view_.light, truth_);
}

void SoftTrade::add_exact() {
  const auto with = [this](SoftSolver solver) {
    return [this, solver]() -> std::span<const float> {
      tracer_.trace(view_.frame.points, view_.frame.normals, view_.frame.view, view_.frame.triangles(),
                    view_.light, {.solver = solver}, mask_);
      return mask_.irradiance;
    };
  };
  add("default (exact)", "", session_.by_effort(1, 3, 5), with(SoftSolver::automatic));
  add("exact, other solvers", "clip", session_.by_effort(1, 1, 3), with(SoftSolver::clip));
  if (session_.effort != Effort::quick)
    add("exact, other solvers", "bsp", session_.by_effort(1, 1, 3), with(SoftSolver::bsp));
}

void SoftTrade::add_errors() {
  for (const double asked :
       session_.by_effort<std::vector<double>>({4}, {8, 4, 2, 1, 0.5}, {8, 4, 2, 1, 0.5})) {
    add("error asked (--soft-error)", fmt::format("{}", asked), session_.by_effort(1, 3, 5),
        [this, asked]() -> std::span<const float> {
          tracer_.trace(view_.frame.points, view_.frame.normals, view_.frame.view, view_.frame.triangles(),
                        view_.light, {.error_255 = asked}, mask_);
          return mask_.irradiance;
        });
  }
}

/// Beside tiles, as the renderer has them.
void SoftTrade::add_light_points() {
  const VisiblePoints& points = view_.frame.points;
  compute_visible_points(points.triangles, points.width, points.height, view_.frame.view,
                         view_.frame.triangles(), tiled_, PointLayout::rows_and_tiles);
  for (const int count :
       session_.by_effort<std::vector<int>>({8}, {4, 8, 16, 32, 64}, {4, 8, 16, 32, 64, 128})) {
    add("light points (--soft-points)", fmt::format("{}", count),
        count > 16 ? session_.by_effort(1, 1, 3) : session_.by_effort(1, 3, 5),
        [this, count]() -> std::span<const float> {
          light_points_.trace(tiled_, view_.frame.normals, view_.frame.view, view_.frame.triangles(),
                              view_.light, count, {}, mask_);
          return mask_.irradiance;
        });
  }
}

void SoftTrade::add_embree() {
  for (const std::size_t rays : session_.by_effort<std::vector<std::size_t>>(
           {4}, {4, 8, 16, 32, 64, 128, 256}, {4, 8, 16, 32, 64, 128, 256, 512})) {
    const SoftSampler& sampler =
        *samplers_.emplace_back(std::make_unique<SoftSampler>(view_.light, rays, Packing::tile));
    const int rounds = rays > 64 ? session_.by_effort(1, 1, 3) : session_.by_effort(1, 3, 5);
    add("Embree rays", fmt::format("{}", rays), rounds, [this, &sampler]() -> std::span<const float> {
      sampler.trace(casters_, receivers_, view_.frame.points.width, view_.frame.points.height, {}, picture_);
      return picture_;
    });
    add("shafts + Embree rays", fmt::format("{}", rays), rounds,
        [this, &sampler]() -> std::span<const float> {
          shafted_.trace(view_, casters_, receivers_, sampler, picture_);
          return picture_;
        });
  }
}

Expected<TradeTable> SoftTrade::run() {
  find_truth();
  add_exact();
  add_errors();
  add_light_points();
  add_embree();
  auto points = take_turns(contestants_);
  if (!points) return tl::unexpected(points.error());
  points->push_back({"exact, other solvers", "reference precision", truth_ms_, {0, 0, 0, 0}});
  TradeTable table{"soft",
                   view_.name,
                   {{"penumbra RMS", "1/255"},
                    {"worst penumbra pixel", "1/255"},
                    {"RMS of all", "1/255"},
                    {"worst of all", "1/255"}},
                   std::move(*points),
                   0.01};
  const auto share = static_cast<double>(truth_.penumbra_count) / static_cast<double>(picture_.size());
  table.remark = fmt::format("{:.1f} % of the pixels are penumbra.", 100 * share);
  return table;
}

void keep_soft_headline(TradeSession& session, const TradeTable& table) {
  const TradePoint& exact = *table.find("default (exact)");
  session.keep_largest("soft_default_worst_255", exact.errors[3]);
  if (const TradePoint* p = table.find("error asked (--soft-error), 4"))
    session.keep_largest("soft_fast_rms_255", p->errors[0]);
}

}  // namespace

Expected<void> measure_trade_soft(TradeSession& session) {
  ViewChoice choice;
  if (session.effort == Effort::tiny) choice.width = 32, choice.height = 24;
  if (session.effort == Effort::quick) choice.only = {"robots", "museum5", "kitchen", "court"};
  return for_each_view(session.options, choice, session.skipped, [&](const SoftView& view) -> Expected<void> {
    progress(view.name + ": soft shadows, what they cost");
    auto table = SoftTrade(session, view).run();
    if (!table) return tl::unexpected(table.error());
    keep_soft_headline(session, *table);
    session.finish(std::move(*table));
    return {};
  });
}

}  // namespace tenebra::bench
