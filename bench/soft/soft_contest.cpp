#include "bench/soft/soft_contest.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"

namespace tenebra::bench {
namespace {

constexpr std::size_t packing_trial_rays = 64;
constexpr std::size_t short_runs = 64;  // rays: up to here the sweep takes the median of three runs

/// One view with what the contestants share, and a clock.
class Ring {
public:
  Ring(const SoftView& view, const std::string& experiment, Report& report)
      : view_(view),
        experiment_(experiment),
        report_(report),
        casters_(view.frame.triangles(), true),
        receivers_(sampled_receivers(view.frame)),
        picture_(view.frame.pixel_count()) {}

  double time_tenebra(const SoftShadowConfig& config, SoftMask& out) {
    return time_tracer(tracer_, config, out);
  }
  double time_tracer(SoftShadowTracer& tracer, const SoftShadowConfig& config, SoftMask& out) {
    base::Stopwatch watch;
    tracer.trace(view_.frame.points, view_.frame.normals, view_.frame.triangles(), view_.light, config, out);
    return watch.lap_ms();
  }
  double time_sampler(const SoftSampler& sampler) {
    base::Stopwatch watch;
    sampler.trace(casters_, receivers_, view_.frame.points.width, view_.frame.points.height, {}, picture_);
    return watch.lap_ms();
  }
  double time_fair(const SoftSampler& sampler) {
    base::Stopwatch watch;
    shafted_.trace(view_, casters_, receivers_, sampler, picture_);
    return watch.lap_ms();
  }

  const std::vector<float>& picture() const { return picture_; }  ///< of the last sampler
  const SoftShadowTracer& tracer() const { return tracer_; }
  double traced_part() const { return shafted_.traced_part(); }
  const SoftView& view() const { return view_; }

  void note(const std::string& contestant, const std::string& parameter, const std::string& quantity,
            double value, const std::string& unit) {
    report_.add({experiment_, view_.name, contestant, parameter, quantity, value, unit});
  }

private:
  const SoftView& view_;
  std::string experiment_;
  Report& report_;
  EmbreeScene casters_;
  std::vector<SampledReceiver> receivers_;
  std::vector<float> picture_;
  SoftShadowTracer tracer_;
  ShaftedSampler shafted_;
};

std::string rays_text(std::size_t rays) {
  return fmt::format("rays={}", rays);
}

Truth exact_answer(Ring& ring, testing::SoftPrecision precision) {
  SoftShadowTracer tracer = testing::soft_tracer(precision);
  Truth truth;
  const double ms = ring.time_tracer(tracer, {}, truth.mask);
  finish_truth(ring.view().frame, ring.view().light, truth);
  ring.note("reference", "", "time", ms, "ms");
  ring.note("reference", "", "white", truth.white, "");
  ring.note("reference", "", "penumbra pixels", static_cast<double>(truth.penumbra_count), "");
  return truth;
}

/// The faster way to hand rays to Embree here: two runs each, in turn.
Packing faster_packing(Ring& ring) {
  double best[2] = {HUGE_VAL, HUGE_VAL};
  const SoftSampler samplers[2] = {{ring.view().light, packing_trial_rays, Packing::pixel},
                                   {ring.view().light, packing_trial_rays, Packing::tile}};
  for (int run = 0; run < 2; ++run)
    for (int k = 0; k < 2; ++k) best[k] = std::min(best[k], ring.time_sampler(samplers[k]));
  for (int k = 0; k < 2; ++k)
    ring.note(fmt::format("embree {}", packing_name(k == 0 ? Packing::pixel : Packing::tile)),
              rays_text(packing_trial_rays), "time", best[k], "ms");
  return best[0] < best[1] ? Packing::pixel : Packing::tile;
}

/// Quality and cost of growing numbers of rays; finds EQ.
void sweep_rays(Ring& ring, const Truth& truth, const ContestPlan& plan, Contest& contest) {
  for (std::size_t rays = 1; rays <= most_rays; rays *= 2) {
    const SoftSampler sampler(ring.view().light, rays, contest.packing);
    std::vector<double> runs;
    do runs.push_back(ring.time_sampler(sampler));
    while (rays <= short_runs && runs.size() < 3);
    const double ms = median(runs), rmse = penumbra_rmse_255(truth, ring.picture());
    contest.curve.push_back({rays, rmse, ms});
    ring.note("embree", rays_text(rays), "rmse", rmse, "1/255");
    ring.note("embree", rays_text(rays), "largest error", largest_error_255(truth, ring.picture()), "1/255");
    ring.note("embree", rays_text(rays), "time", ms, "ms");
    if (rmse < equal_quality_255 && !contest.eq_reached) {
      contest.eq_reached = true;
      contest.eq_rays = rays;
    }
    if (contest.eq_reached && !plan.whole_curve) break;
  }
}

void run_rounds(Ring& ring, const Truth& truth, const ContestPlan& plan, Contest& contest) {
  const SoftSampler sampler(ring.view().light, contest.eq_rays, contest.packing);
  SoftMask mask;
  ring.time_tenebra(plan.config, mask);  // warm
  contest.max_error_255 = largest_error_255(truth, mask.irradiance);
  contest.rmse_255 = penumbra_rmse_255(truth, mask.irradiance);
  std::vector<double> tenebra, embree, fair, over_embree, over_fair;
  for (int round = 0; round < plan.rounds; ++round) {
    tenebra.push_back(ring.time_tenebra(plan.config, mask));
    embree.push_back(ring.time_sampler(sampler));
    fair.push_back(ring.time_fair(sampler));
    over_embree.push_back(embree.back() / tenebra.back());
    over_fair.push_back(fair.back() / tenebra.back());
    ring.note("tenebra", fmt::format("round={}", round), "time", tenebra.back(), "ms");
    ring.note("embree", fmt::format("round={} rays={}", round, contest.eq_rays), "time", embree.back(), "ms");
    ring.note("shaft+embree", fmt::format("round={} rays={}", round, contest.eq_rays), "time", fair.back(),
              "ms");
  }
  contest.tenebra_ms = median(tenebra);
  contest.embree_ms = median(embree);
  contest.fair_ms = median(fair);
  contest.over_embree = median(over_embree);
  contest.over_fair = median(over_fair);
  contest.fair_rmse_255 = penumbra_rmse_255(truth, ring.picture());
  contest.traced_part = ring.traced_part();
  contest.stats = ring.tracer().stats();
  contest.timings = ring.tracer().timings();
  contest.tenebra = std::move(mask.irradiance);
}

/// RMSE that Embree has in `ms`: on the line through the logarithms of the two neighbours on the curve.
double rmse_in(const std::vector<SampledPoint>& curve, double ms) {
  std::size_t i = 1;
  while (i + 1 < curve.size() && curve[i].time_ms < ms) ++i;
  if (curve.size() < 2) return curve.empty() ? 0 : curve[0].rmse_255;
  const SampledPoint &a = curve[i - 1], &b = curve[i];
  const double step = std::log(b.time_ms / a.time_ms);
  const double part = step > 0 ? std::log(ms / a.time_ms) / step : 0.0;
  return a.rmse_255 * std::pow(b.rmse_255 / a.rmse_255, std::clamp(part, 0.0, 1.0));
}

void compare_at_equal_time(Ring& ring, const Truth& truth, const ContestPlan& plan, Contest& contest) {
  contest.rmse_at_equal_time_255 = rmse_in(contest.curve, contest.tenebra_ms);
  std::size_t rays = 1;
  for (const SampledPoint& point : contest.curve) {
    rays = point.rays;
    if (point.time_ms >= contest.tenebra_ms) break;
  }
  if (!plan.pictures) return;
  const double ms = ring.time_sampler({ring.view().light, rays, contest.packing});
  contest.equal_time = {rays, penumbra_rmse_255(truth, ring.picture()), ms};
  contest.embree_equal_time = ring.picture();
}

void note_results(Ring& ring, const Contest& c) {
  ring.note("embree", rays_text(c.eq_rays), "median time at EQ", c.embree_ms, "ms");
  ring.note("shaft+embree", rays_text(c.eq_rays), "median time at EQ", c.fair_ms, "ms");
  ring.note("shaft+embree", rays_text(c.eq_rays), "rmse", c.fair_rmse_255, "1/255");
  ring.note("shaft+embree", rays_text(c.eq_rays), "points traced", c.traced_part, "");
  ring.note("embree", "equal time", "rmse", c.rmse_at_equal_time_255, "1/255");
  ring.note("tenebra", "", "median time", c.tenebra_ms, "ms");
  ring.note("tenebra", "", "rmse", c.rmse_255, "1/255");
  ring.note("tenebra", "", "largest error", c.max_error_255, "1/255");
  ring.note("tenebra", "", "speed-up over embree at EQ", c.over_embree, "");
  ring.note("tenebra", "", "speed-up over shaft+embree at EQ", c.over_fair, "");
}

}  // namespace

Contest run_contest(const SoftView& view, const ContestPlan& plan, Report& report) {
  Ring ring(view, plan.experiment, report);
  Contest contest;
  contest.view = view.name;
  contest.counted = view.counted;
  contest.triangles = view.frame.geometry.triangles.size();
  progress(fmt::format("{}: exact answer", view.name));
  const Truth truth = exact_answer(ring, plan.truth);
  contest.white = truth.white;
  progress(fmt::format("{}: rays until equal quality", view.name));
  contest.packing = faster_packing(ring);
  sweep_rays(ring, truth, plan, contest);
  progress(fmt::format("{}: {} rounds at {} rays{}", view.name, plan.rounds, contest.eq_rays,
                       contest.eq_reached ? "" : " (equal quality not reached)"));
  run_rounds(ring, truth, plan, contest);
  compare_at_equal_time(ring, truth, plan, contest);
  note_results(ring, contest);
  contest.penumbra = truth.penumbra;
  return contest;
}

}  // namespace tenebra::bench
