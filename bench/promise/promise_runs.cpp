#include "bench/promise/promise_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "settings/method_settings.h"

namespace tenebra::bench {
namespace {

constexpr std::array errors{0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::size_t least_penumbra = 100;  // pixels; fewer have no root mean square worth the name
constexpr double least_estimate = 0.25;

render::RenderSettings settings_for(const session::StagedScene& staged, const PromiseView& view) {
  settings::MethodSettings method;
  method.render.shadows = render::ShadowMode::soft;
  method.render.light = view.light;
  if (view.sun)
    method.render.area_lights.sun_deg = static_cast<float>(view.size);
  else
    method.light_size = settings::LightSize{glm::vec2(static_cast<float>(view.size)), true};
  render::RenderSettings settings = settings::render_settings(method, staged.size, staged.display);
  settings.aovs.irradiance = true;
  return settings;
}

/// What the light shows of a white surface at each pixel, background left out.
std::vector<float> shown(const render::FrameResult& drawn) {
  std::vector<float> out;
  const std::vector<float>& rgb = drawn.aovs.irradiance.pixels;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3)
    out.push_back(std::max({rgb[i], rgb[i + 1], rgb[i + 2]}));
  return out;
}

double white_of(std::vector<float> values) {
  std::erase_if(values, [](float v) { return !(v > 0); });
  if (values.empty()) return 0;
  const std::size_t rank = (values.size() * 999 + 999) / 1000 - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return static_cast<double>(values[rank]);
}

/// Least times of exact (error 0) and of each error, taken in turns.
Expected<std::vector<double>> least_times(session::Session& session, render::RenderSettings settings,
                                          int rounds) {
  std::vector<double> least(errors.size() + 1, HUGE_VAL);
  render::FrameResult drawn;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t e = 0; e < least.size(); ++e) {
      settings.soft.error_255 = e == 0 ? 0 : errors[e - 1];
      if (auto done = session.draw(settings, drawn); !done) return tl::unexpected(done.error());
      least[e] = std::min(least[e], drawn.timings.total_ms - drawn.timings.evaluate_ms);
    }
  }
  return least;
}

}  // namespace

double PromiseRun::estimate_off() const {
  const double truth = std::max(rms, least_estimate), said = std::max(estimate, least_estimate);
  return std::max(truth, said) / std::min(truth, said);
}

Expected<void> measure_view(session::Session& session, const PromiseView& view, PromiseTable& table) {
  render::RenderSettings settings = settings_for(session.staged(), view);
  render::FrameResult drawn;
  if (auto done = session.draw(settings, drawn); !done) return done;
  const std::vector<float> exact = shown(drawn);
  if (drawn.masks.empty()) return {};
  const std::vector<float> fraction = drawn.masks[0].visible_fraction.pixels;
  const double white = white_of(exact);
  std::vector<std::size_t> penumbra;
  for (std::size_t i = 0; i < fraction.size(); ++i)
    if (fraction[i] > 0 && fraction[i] < 1) penumbra.push_back(i);
  if (penumbra.size() < least_penumbra || !(white > 0)) return {};
  std::vector<double> times;
  if (view.rounds > 0) {
    auto timed = least_times(session, settings, view.rounds);
    if (!timed) return tl::unexpected(timed.error());
    times = *timed;
  }
  for (std::size_t e = 0; e < errors.size(); ++e) {
    settings.soft.error_255 = errors[e];
    if (auto done = session.draw(settings, drawn); !done) return done;
    PromiseRun run{
        fmt::format("{} light {} {:g}{}", view.name, view.light, view.size, view.sun ? " deg" : "%"),
        errors[e],
        0,
        drawn.soft.error_255,
        penumbra.size(),
        drawn.soft.points_sampled > 0};
    const std::vector<float> values = shown(drawn);
    double sum = 0;
    for (const std::size_t i : penumbra) {
      const double off = 255 * static_cast<double>(values[i] - exact[i]) / white;
      sum += off * off;
    }
    run.rms = std::sqrt(sum / static_cast<double>(penumbra.size()));
    if (!times.empty()) {
      run.over_exact = times[e + 1] / times[0];
      run.over_smaller =
          times[e + 1] / *std::min_element(times.begin(), times.begin() + static_cast<long>(e) + 1);
    }
    table.runs.push_back(run);
  }
  return {};
}

void PromiseTable::print(bool with_times) const {
  Rows rows{{"view", "E", "RMS", "estimate", "penumbra", "RMS / E"}};
  if (with_times) rows[0].insert(rows[0].end(), {"over exact", "over smaller"});
  std::vector<PromiseRun> worst;
  std::ranges::copy_if(runs, std::back_inserter(worst), &PromiseRun::sampled);
  const std::size_t sampled = worst.size();
  std::stable_sort(worst.begin(), worst.end(), [](const PromiseRun& a, const PromiseRun& b) {
    return a.rms / a.asked > b.rms / b.asked;
  });
  worst.resize(std::min<std::size_t>(worst.size(), 30));
  for (const PromiseRun& run : worst) {
    rows.push_back({run.view, fmt::format("{:g}", run.asked), fmt::format("{:.2f}", run.rms),
                    fmt::format("{:.2f}", run.estimate), std::to_string(run.penumbra),
                    fmt::format("{:.2f}", run.rms / run.asked)});
    if (with_times)
      rows.back().insert(rows.back().end(),
                         {fmt::format("{:.2f}", run.over_exact), fmt::format("{:.2f}", run.over_smaller)});
  }
  print_table(fmt::format("The worst of {} runs; {} more were exact", sampled, runs.size() - sampled), rows);
  double kept = 0, within = 0, most = 0, slower = 0;
  for (const PromiseRun& run : runs) {
    slower = std::max(slower, run.over_smaller);
    if (!run.sampled) continue;
    kept += run.rms <= run.asked, within += run.estimate_off() <= 1.5;
    most = std::max(most, run.rms / run.asked);
  }
  const auto all = static_cast<double>(std::max<std::size_t>(sampled, 1));
  std::printf("%s%s%s", headline("soft.promise_within", kept / all, 3).c_str(),
              headline("soft.promise_worst", most, 2).c_str(),
              headline("soft.estimate_within", within / all, 3).c_str());
  if (with_times) std::printf("%s", headline("soft.slower_worst", slower, 2).c_str());
}

void PromiseTable::add_to(Report& report) const {
  for (const PromiseRun& run : runs) {
    const std::string what = fmt::format("error={:g}", run.asked);
    report.add({"promise", run.view, "tenebra", what, "rmse", run.rms, "1/255"});
    report.add({"promise", run.view, "tenebra", what, "estimate", run.estimate, "1/255"});
    report.add({"promise", run.view, "tenebra", what, "penumbra", static_cast<double>(run.penumbra), ""});
    if (run.over_smaller > 0)
      report.add({"promise", run.view, "tenebra", what, "over_smaller", run.over_smaller, ""});
  }
}

}  // namespace tenebra::bench
