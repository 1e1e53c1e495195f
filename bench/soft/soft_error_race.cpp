#include "bench/soft/soft_error_race.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/stopwatch.h"
#include "bench/soft/soft_quality.h"
#include "bench/soft/soft_rival.h"

namespace tenebra::bench {
namespace {

constexpr int filters = 3;
constexpr double least_estimate = 0.25;
constexpr std::array<const char*, raced_errors.size()> error_names{"8", "4", "2", "1", "05"};

struct RivalPoint {
  double rmse, ms;
};
using RivalCurve = std::vector<RivalPoint>;

struct ErrorRing {
  const SoftView& view;
  EmbreeScene casters;
  std::vector<SampledReceiver> receivers;
  RivalSampler rival;
  SoftShadowTracer tracer;
  SoftMask mask;
  std::vector<float> picture;

  explicit ErrorRing(const SoftView& of)
      : view(of),
        casters(of.frame.triangles(), true),
        receivers(sampled_receivers(of.frame)),
        rival(of, casters, receivers) {}

  double time_tenebra(double error) {
    SoftShadowConfig config;
    config.error_255 = error;
    base::Stopwatch watch;
    tracer.trace(view.frame.points, view.frame.normals, view.frame.triangles(), view.light, config, mask);
    return watch.lap_ms();
  }
  double time_rival(std::size_t rays, int passes) {
    base::Stopwatch watch;
    rival.trace(rays, passes, picture);
    return watch.lap_ms();
  }
};

/// Time at which the curve errs by `error`: between its points in the logarithms.
double time_at(const RivalCurve& curve, double error, bool& reached) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    if (curve[i].rmse > error) continue;
    reached = true;
    if (i == 0) return curve[0].ms;
    const RivalPoint &a = curve[i - 1], &b = curve[i];
    const double part = std::log(error / a.rmse) / std::log(b.rmse / a.rmse);
    return a.ms * std::pow(b.ms / a.ms, part);
  }
  return std::numeric_limits<double>::infinity();
}

void race_row(ErrorRing& ring, const Truth& truth, const std::vector<RivalCurve>& curves, int rounds,
              ErrorRow& row) {
  std::vector<double> times;
  ring.time_tenebra(row.asked);  // warm
  for (int round = 0; round < rounds; ++round) times.push_back(ring.time_tenebra(row.asked));
  row.tenebra_ms = median(times);
  row.rmse = penumbra_rmse_255(truth, ring.mask.irradiance);
  row.worst = largest_error_255(truth, ring.mask.irradiance);
  const SoftStats& stats = ring.tracer.stats();
  row.estimate = stats.error_255;
  const auto sampled = static_cast<double>(stats.points_sampled);
  row.rays = sampled > 0 ? static_cast<double>(stats.sampled_rays) / sampled : 0;
  row.sampled = sampled / static_cast<double>(ring.picture.size());
  row.reached = false;
  row.rival_ms = std::numeric_limits<double>::infinity();
  for (const RivalCurve& curve : curves)
    row.rival_ms = std::min(row.rival_ms, time_at(curve, std::max(row.asked, row.rmse), row.reached));
  if (row.reached) return;
  for (const RivalCurve& curve : curves) row.rival_ms = std::min(row.rival_ms, curve.back().ms);
}

}  // namespace

double ErrorRow::estimate_off() const {
  const double truth = std::max(rmse, least_estimate), said = std::max(estimate, least_estimate);
  return std::max(truth, said) / std::min(truth, said);
}

ErrorRace race_errors(const SoftView& view, int rounds, std::size_t most_rays, Report& report) {
  ErrorRing ring(view);
  ErrorRace race{view.name, 0, 0, {}};
  progress(fmt::format("{}: allowed errors", view.name));
  Truth truth;
  race.exact_ms = ring.time_tenebra(0);
  truth.mask = ring.mask;
  finish_truth(view.frame, view.light, truth);
  const auto note = [&](const std::string& who, const std::string& what, const std::string& quantity,
                        double value, const std::string& unit) {
    report.add({"errors", view.name, who, what, quantity, value, unit});
  };
  // Alternately, so that both have the same of what else the machine does.
  std::vector<double> exact;
  std::vector<RivalCurve> curves(filters);
  for (std::size_t rays = RivalSampler::probe_rays; rays <= most_rays; rays *= 2) {
    exact.push_back(ring.time_tenebra(0));
    for (int passes = 0; passes < filters; ++passes) {
      std::vector<double> times;
      ring.time_rival(rays, passes);
      for (int round = 0; round < rounds; ++round) times.push_back(ring.time_rival(rays, passes));
      const RivalPoint point{penumbra_rmse_255(truth, ring.picture), median(times)};
      curves[static_cast<std::size_t>(passes)].push_back(point);
      const std::string what = fmt::format("rays={} passes={}", rays, passes);
      note("rival", what, "rmse", point.rmse, "1/255");
      note("rival", what, "time", point.ms, "ms");
    }
  }
  race.exact_ms = median(exact);
  note("tenebra", "error=0", "time", race.exact_ms, "ms");
  for (std::size_t k = 0; k < race.rows.size(); ++k) {
    ErrorRow& row = race.rows[k];
    row.asked = raced_errors[k];
    race_row(ring, truth, curves, rounds, row);
    const std::string what = fmt::format("error={}", row.asked);
    note("tenebra", what, "time", row.tenebra_ms, "ms");
    note("tenebra", what, "rmse", row.rmse, "1/255");
    note("tenebra", what, "estimate", row.estimate, "1/255");
    note("rival", what, row.reached ? "time" : "time, more at least", row.rival_ms, "ms");
  }
  return race;
}

std::string error_table(const std::vector<ErrorRace>& races) {
  Rows rows{{"view", "error asked", "Tenebra ms", "rival ms", "ratio", "error", "estimate", "worst pixel",
             "sampled", "rays"}};
  for (const ErrorRace& race : races) {
    rows.push_back({race.view, "0", fmt::format("{:.1f}", race.exact_ms), "", "", "", "", "", "", ""});
    for (const ErrorRow& row : race.rows)
      rows.push_back({race.view, fmt::format("{}", row.asked), fmt::format("{:.1f}", row.tenebra_ms),
                      fmt::format("{}{:.1f}", row.reached ? "" : "over ", row.rival_ms),
                      fmt::format("{:.2f}", row.ratio()), fmt::format("{:.2f}", row.rmse),
                      fmt::format("{:.2f}", row.estimate), fmt::format("{:.0f}", row.worst),
                      fmt::format("{:.0f} %", 100 * row.sampled), fmt::format("{:.1f}", row.rays)});
  }
  return "At allowed errors (1/255, RMS over the penumbra)\n" + text_table(rows);
}

std::string error_summary(const std::vector<ErrorRace>& races) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::string text;
  double off = races.empty() ? nan : 0.0;
  for (std::size_t k = 0; k < raced_errors.size(); ++k) {
    std::vector<double> ratios;
    for (const ErrorRace& race : races) {
      ratios.push_back(race.rows[k].ratio());
      off = std::max(off, race.rows[k].estimate_off());
    }
    const std::string name = fmt::format("soft.ratio_{}_", error_names[k]);
    text +=
        headline(name + "geomean", ratios.empty() ? nan : geometric_mean(ratios), 2) +
        headline(name + "worst", ratios.empty() ? nan : *std::max_element(ratios.begin(), ratios.end()), 2);
  }
  return text + headline("soft.estimate_worst", off, 2);
}

std::string sized_summary(const std::vector<ErrorRace>& races) {
  std::map<double, std::array<double, raced_errors.size()>> worst;
  for (const ErrorRace& race : races) {
    auto& of = worst[race.percent];
    for (std::size_t k = 0; k < of.size(); ++k) of[k] = std::max(of[k], race.rows[k].ratio());
  }
  std::string text;
  for (const auto& [percent, ratios] : worst)
    for (std::size_t k = 0; k < ratios.size(); ++k)
      text += headline(fmt::format("soft.size_{:g}_ratio_{}_worst", percent, error_names[k]), ratios[k], 2);
  return text;
}

std::string sun_summary(const std::vector<ErrorRace>& races) {
  std::vector<double> ratios;
  for (const ErrorRace& race : races) ratios.push_back(race.rows.back().ratio());
  return headline("soft.sun_ratio_05",
                  ratios.empty() ? std::numeric_limits<double>::quiet_NaN() : geometric_mean(ratios), 2);
}

}  // namespace tenebra::bench
