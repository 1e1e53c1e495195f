// The trade of soft shadows: the exact solvers, N points of the light with exact hard shadows, N rays of
// Embree, and the same behind shaft culling.
#include <fmt/core.h>
#include <algorithm>
#include <array>
#include <memory>

#include <tenebra/threads.h>
#include "bench/ao/ao_race.h"
#include "bench/common/memory_meter.h"
#include "bench/soft/soft_fair.h"
#include "bench/trade/trade_contest.h"
#include "bench/trade/trade_crops.h"
#include "bench/trade/trade_session.h"
#include "render/light_points.h"
#include "support/soft_precision.h"

namespace tenebra::bench {
namespace {

constexpr const char* error_family = "error asked (--soft-error)";
constexpr const char* points_family = "light points";

/// In 1/255 of white: over the penumbra and over the whole picture.
std::vector<double> errors_of(const Truth& truth, std::span<const float> irradiance) {
  const SoftErrors penumbra = errors_255(truth, irradiance, Where::penumbra),
                   all = errors_255(truth, irradiance, Where::everywhere);
  return {penumbra.rms, penumbra.worst, all.rms, all.worst};
}

/// One view with all settings on it.
class SoftTrade {
public:
  SoftTrade(TradeSession& session, const SoftView& view) : session_(session), view_(view) {}

  Expected<TradeTable> run();

private:
  Contestant& add(const std::string& family, const std::string& setting,
                  std::function<std::span<const float>()> trace);
  void find_truth();
  Expected<TradeCrops> crops(const std::vector<TradePoint>& points);
  void add_exact();
  void add_errors();
  void add_light_points();
  void add_embree();

  TradeSession& session_;
  const SoftView& view_;
  std::unique_ptr<EmbreeScene> casters_;
  std::vector<SampledReceiver> receivers_;
  double embree_mb_ = 0;  // tree and receivers
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

Contestant& SoftTrade::add(const std::string& family, const std::string& setting,
                           std::function<std::span<const float>()> trace) {
  contestants_.push_back({family, setting, clocked([this, trace]() -> Expected<void> {
                            found_ = trace();
                            return {};
                          }),
                          [this] { return errors_of(truth_, found_); }});
  contestants_.back().forget = [this] {
    tracer_ = {}, light_points_ = {}, shafted_ = {}, mask_ = {}, picture_ = std::vector<float>();
  };
  return contestants_.back();
}

void SoftTrade::find_truth() {
  SoftShadowTracer tracer = testing::soft_tracer(testing::SoftPrecision::reference);
  CostClock clock;
  tracer.trace(view_.frame.points, view_.frame.normals, view_.frame.triangles(), view_.light, {},
               truth_.mask);
  truth_ms_ = clock.ms();
  finish_truth(view_.frame, view_.light, truth_);
}

void SoftTrade::add_exact() {
  const auto with = [this](SoftSolver solver) {
    return [this, solver]() -> std::span<const float> {
      tracer_.trace(view_.frame.points, view_.frame.normals, view_.frame.triangles(), view_.light,
                    {.solver = solver}, mask_);
      return mask_.irradiance;
    };
  };
  add("default (exact)", "", with(SoftSolver::automatic));
  add("exact, other solvers", "clip", with(SoftSolver::clip));
  add("exact, other solvers", "bsp", with(SoftSolver::bsp));
}

void SoftTrade::add_errors() {
  for (const double asked :
       session_.by_effort<std::vector<double>>({4}, {8, 4, 2, 1, 0.5}, {8, 4, 2, 1, 0.5})) {
    add(error_family, fmt::format("{}", asked), [this, asked]() -> std::span<const float> {
      tracer_.trace(view_.frame.points, view_.frame.normals, view_.frame.triangles(), view_.light,
                    {.error_255 = asked}, mask_);
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
    add(points_family, fmt::format("{}", count), [this, count]() -> std::span<const float> {
      light_points_.trace(tiled_, view_.frame.normals, view_.frame.triangles(), view_.light, count, {},
                          mask_);
      return mask_.irradiance;
    });
  }
}

void SoftTrade::add_embree() {
  const MemoryMeter meter;
  casters_ = std::make_unique<EmbreeScene>(view_.frame.triangles(), true);
  receivers_ = sampled_receivers(view_.frame);
  embree_mb_ = meter.mb();
  for (const std::size_t rays : session_.by_effort<std::vector<std::size_t>>(
           {4}, {4, 16, 64, 256}, {4, 8, 16, 32, 64, 128, 256, 512})) {
    const SoftSampler& sampler =
        *samplers_.emplace_back(std::make_unique<SoftSampler>(view_.light, rays, Packing::tile));
    const auto rays_alone = [this, &sampler]() -> std::span<const float> {
      picture_.resize(receivers_.size());
      sampler.trace(*casters_, receivers_, view_.frame.points.width, view_.frame.points.height, {}, picture_);
      return picture_;
    };
    const auto behind_shafts = [this, &sampler]() -> std::span<const float> {
      picture_.resize(receivers_.size());
      shafted_.trace(view_, *casters_, receivers_, sampler, picture_);
      return picture_;
    };
    add("Embree rays", fmt::format("{}", rays), rays_alone).made_mb = embree_mb_;
    add("shafts + Embree rays", fmt::format("{}", rays), behind_shafts).made_mb = embree_mb_;
  }
}

/// Where the errors of the most inexact of them stand out.
Expected<TradeCrops> SoftTrade::crops(const std::vector<TradePoint>& points) {
  constexpr std::array families{error_family, points_family};
  const auto relative = [this](std::span<const float> irradiance) {
    std::vector<float> values(irradiance.begin(), irradiance.end());
    for (float& value : values) value /= static_cast<float>(truth_.white);
    return values;
  };
  const std::vector<float> exact = relative(truth_.mask.irradiance);
  std::vector<CropPicture> pictures;
  for (const TradePoint* setting : crop_settings(points, families)) {
    const auto contestant = std::find_if(contestants_.begin(), contestants_.end(), [&](const Contestant& c) {
      return c.family == setting->family && c.setting == setting->setting;
    });
    if (auto done = contestant->run(); !done) return tl::unexpected(done.error());
    pictures.push_back({setting, relative(found_)});
  }
  std::vector<float> errors(exact.size());
  for (std::size_t i = 0; i < errors.size() && !pictures.empty(); ++i)
    errors[i] = pictures.back().values[i] - exact[i];
  const auto width = static_cast<std::size_t>(view_.frame.points.width);
  return make_crops(plainest_place(errors, exact, width), exact, pictures);
}

Expected<TradeTable> SoftTrade::run() {
  find_truth();
  add_exact();
  add_errors();
  add_light_points();
  add_embree();
  auto points = take_turns(contestants_, session_.turns());
  if (!points) return tl::unexpected(points.error());
  auto crops = this->crops(*points);
  if (!crops) return tl::unexpected(crops.error());
  TradeTable table{"soft",
                   view_.name,
                   {{"penumbra RMS", "1/255"},
                    {"worst penumbra pixel", "1/255"},
                    {"RMS of all", "1/255"},
                    {"worst of all", "1/255"}},
                   std::move(*points),
                   0.01};
  table.crops = std::move(*crops);
  const auto share =
      static_cast<double>(truth_.penumbra_count) / static_cast<double>(view_.frame.pixel_count());
  table.remark =
      fmt::format("{:.1f} % of the pixels are penumbra. The solver in double precision took {} ms ({}).",
                  100 * share, short_number(truth_ms_), threads_text(thread_count()));
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
  choice.width = session.by_effort(32, 960, 1280), choice.height = session.by_effort(24, 540, 720);
  return for_each_view(session.options, choice, session.skipped, [&](const SoftView& of) -> Expected<void> {
    SoftView view = of;
    if (view.sun_only) view.name += ", sun", view.light = *view.sun;
    progress(view.name + ": soft shadows, what they cost");
    auto table = SoftTrade(session, view).run();
    if (!table) return tl::unexpected(table.error());
    keep_soft_headline(session, *table);
    session.finish(std::move(*table));
    return {};
  });
}

}  // namespace tenebra::bench
