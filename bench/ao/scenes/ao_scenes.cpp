// Ambient occlusion of whole scenes: errors against thousands of rays, times and work at every preset, and
// the time that filtered rays take for the same error.
#include <fmt/core.h>

#include <algorithm>

#include <tenebra/ambient_occlusion.h>
#include "bench/ao/ao_session.h"
#include "bench/ao/scenes/ao_scene_contest.h"
#include "bench/ao/scenes/ao_scene_first.h"
#include "bench/ao/scenes/ao_scene_ours.h"
#include "bench/ao/scenes/ao_scene_pictures.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

using Rows = std::vector<std::vector<std::string>>;

struct Tables {
  Rows ours{{"view", "size", "setting", "RMS", "99 %", "worst", "estimate", "ms", "first ms", "warm x",
             "rays/point", "look-ups/point", "samples"}};
  Rows race{{"view", "size", "setting", "RMS", "ms", "Embree ms", "by", "rays", "tree", "faster x"}};
};

int walkers(const AoSession& session) {
  return session.by_effort(3, 50, 50);
}

/// One view at one size with all that is measured on it.
class SceneBench {
public:
  SceneBench(AoSession& session, const AoSceneView& view) : session_(session), view_(view) {}
  Expected<void> run(Tables& tables);

private:
  void find_truth();
  Expected<void> start();
  Expected<void> find_first_frame();
  Expected<void> race();
  Expected<void> tell(const OurAoScene& ours, Rows& rows);
  Expected<void> write_pictures(const std::string& setting, const AoSceneResult& result);
  void tell_race(const OurAoScene& ours, Rows& rows);
  void add_curves();
  void add(const std::string& contestant, const char* quantity, double value, const char* unit);
  void keep(const std::string& setting, const AoSceneResult& result);
  std::string title() const;

  AoSession& session_;
  const AoSceneView& view_;
  AoSceneTruth truth_;
  double first_over_later_ = 0;  ///< of the default, warm
  std::vector<std::unique_ptr<OurAoScene>> ours_;
  std::unique_ptr<AoSceneContest> peer_;  ///< null: not asked for
  testing::TemporaryFolder fields_;
};

std::string SceneBench::title() const {
  return fmt::format("{} {}", view_.name, view_.now.points.width);
}

void SceneBench::find_truth() {
  const AoSceneOptions& options = session_.scenes;
  const int step = options.truth_step > 0 ? options.truth_step : session_.by_effort(5, 5, 1);
  const int rays = session_.by_effort(256, 4096, 4096);
  truth_ = bench::find_truth(
      {view_.now.triangles(), view_.now.points, view_.now.normals, view_.reach_m, rays, step}, view_.name,
      session_.effort == Effort::tiny ? std::filesystem::path() : options.truth_folder);
}

/// All settings' first frames; then the opponent's errors, as far as they are needed.
Expected<void> SceneBench::start() {
  const bool tiny = session_.effort == Effort::tiny;
  for (auto& setting : scene_settings(view_.reach_m, fields_.path(), tiny))
    ours_.push_back(std::make_unique<OurAoScene>(view_, std::move(setting)));
  constexpr double surely = 0.98;  // in case later frames err by a little less
  std::vector<double> errors;
  for (const auto& ours : ours_) {
    if (auto done = ours->start(); !done) return done;
    errors.push_back(surely * ours->result(truth_).errors.rms);
  }
  if (session_.scenes.only_ours) return {};
  progress(fmt::format("scenes: {}, Embree", title()));
  peer_ = std::make_unique<AoSceneContest>(view_, truth_);
  peer_->find_errors(errors, session_.by_effort(4, 1024, 1024));
  return {};
}

/// Of a process of its own, which finds on disk what the first one has built.
Expected<void> SceneBench::find_first_frame() {
  const bool tiny = session_.effort == Effort::tiny;
  const auto ratio = first_over_later(
      {view_.name, view_.now.points.width, walkers(session_), tiny, fields_.path()}, session_.options);
  if (!ratio) return tl::unexpected(ratio.error());
  first_over_later_ = *ratio;
  add("default", "first frame, warm, over later ones", *ratio, "");
  keep_largest(session_.headline.first_frame_warm, *ratio);
  return {};
}

/// All contestants in turn.
Expected<void> SceneBench::race() {
  for (int round = 0; round < session_.by_effort(1, 3, 5); ++round) {
    for (const auto& ours : ours_) {
      if (auto done = ours->run(); !done) return done;
    }
    if (peer_) peer_->run_round();
  }
  return {};
}

void SceneBench::add(const std::string& contestant, const char* quantity, double value, const char* unit) {
  session_.report.add({"scenes", title(), contestant, "", quantity, value, unit});
}

void SceneBench::keep(const std::string& setting, const AoSceneResult& result) {
  AoHeadline& h = session_.headline;
  if (setting == "default") {
    keep_largest(h.scene_rms_worst, result.errors.rms);
    keep_largest(h.scene_p99_worst, result.errors.p99);
    keep_largest(h.scene_max_worst, result.errors.worst);
  } else if (setting == "exact") {
    keep_largest(h.exact_rms_worst, result.errors.rms);
    keep_largest(h.exact_max_worst, result.errors.worst);
  }
  if (!result.estimate_255) return;
  constexpr double least = 0.25;  // 1/255: below, nobody sees a difference
  const double truth = std::max(least, result.errors.rms), said = std::max(least, *result.estimate_255);
  keep_largest(h.estimate_worst, std::max(truth / said, said / truth));
}

Expected<void> SceneBench::tell(const OurAoScene& ours, Rows& rows) {
  const AoSceneResult r = ours.result(truth_);
  const double points = std::max(1.0, static_cast<double>(r.stats.points));
  const auto per_point = [&](std::uint64_t count) {
    return fmt::format("{:.1f}", static_cast<double>(count) / points);
  };
  rows.push_back(
      {view_.name, fmt::format("{}", view_.now.points.width), ours.name(),
       fmt::format("{:.2f}", r.errors.rms), fmt::format("{:.1f}", r.errors.p99),
       fmt::format("{:.1f}", r.errors.worst), r.estimate_255 ? fmt::format("{:.2f}", *r.estimate_255) : "",
       fmt::format("{:.1f}", r.ms), fmt::format("{:.0f}", r.first_ms),
       ours.name() == "default" ? fmt::format("{:.2f}", first_over_later_) : "", per_point(r.stats.rays_cast),
       per_point(r.stats.lookups), fmt::format("{}", r.stats.cache_cells)});
  add(ours.name(), "rms", r.errors.rms, "1/255");
  add(ours.name(), "99th percentile", r.errors.p99, "1/255");
  add(ours.name(), "worst pixel", r.errors.worst, "1/255");
  add(ours.name(), "time", r.ms, "ms");
  add(ours.name(), "first frame", r.first_ms, "ms");
  add(ours.name(), "rays cast", static_cast<double>(r.stats.rays_cast), "");
  add(ours.name(), "look-ups", static_cast<double>(r.stats.lookups), "");
  add(ours.name(), "samples", static_cast<double>(r.stats.cache_cells), "");
  keep(ours.name(), r);
  return session_.scenes.pictures.empty() ? Expected<void>() : write_pictures(ours.name(), r);
}

Expected<void> SceneBench::write_pictures(const std::string& setting, const AoSceneResult& result) {
  constexpr int named = 8, apart = 10;  // worst pixels
  const int width = view_.now.points.width, height = view_.now.points.height;
  const auto stem = title() + " " + setting;
  for (const WorstPixel& w : worst_pixels(result.values, truth_, width, named, apart)) {
    const auto columns = static_cast<std::size_t>(width);
    session_.notes.push_back(fmt::format("{}: pixel ({}, {}), triangle {}: {:.3f}, truth {:.3f}", stem,
                                         w.pixel % columns, w.pixel / columns,
                                         view_.now.points.triangles[w.pixel], w.value, w.truth));
  }
  return write_ao_pictures(session_.scenes.pictures, stem, result.values, truth_, width, height);
}

void SceneBench::tell_race(const OurAoScene& ours, Rows& rows) {
  const double rms = ours.result(truth_).errors.rms;
  const ErrorMatch match = match_error(peer_->curves(), rms);
  const double faster = match.ms / ours.ms();
  const char* mark = match.bound ? "> " : "";
  rows.push_back(
      {view_.name, fmt::format("{}", view_.now.points.width), ours.name(), fmt::format("{:.2f}", rms),
       fmt::format("{:.1f}", ours.ms()), fmt::format("{}{:.1f}", mark, match.ms), match.name,
       fmt::format("{}{:.1f}", mark, match.rays), peer_->tree(), fmt::format("{}{:.2f}", mark, faster)});
  const char* quantity = match.bound ? "time at equal rms, at least" : "time at equal rms";
  session_.report.add(
      {"scenes", title(), "embree", "for " + ours.name() + ", " + match.name, quantity, match.ms, "ms"});
  if (ours.name() == "default") session_.scene_speedups.push_back(faster);
  if (ours.name() == "exact") session_.exact_speedups.push_back(faster);
}

void SceneBench::add_curves() {
  for (const CostCurve& curve : peer_->curves()) {
    for (const RayCost& cost : curve.costs) {
      const std::string parameter = fmt::format("{}, rays={}", curve.name, cost.rays);
      session_.report.add({"scenes", title(), "embree", parameter, "rms", cost.rms, "1/255"});
      session_.report.add({"scenes", title(), "embree", parameter, "time", cost.ms, "ms"});
    }
  }
}

Expected<void> SceneBench::run(Tables& tables) {
  progress(fmt::format("scenes: {}, truth", title()));
  find_truth();
  progress(fmt::format("scenes: {}", title()));
  if (auto done = start(); !done) return done;
  if (auto done = find_first_frame(); !done) return done;
  if (auto done = race(); !done) return done;
  for (const auto& ours : ours_) {
    if (auto done = tell(*ours, tables.ours); !done) return done;
    if (peer_) tell_race(*ours, tables.race);
  }
  if (peer_) add_curves();
  return {};
}

bool wanted(const AoSession& session, const std::string& name) {
  const auto& views = session.scenes.views;
  if (session.effort == Effort::tiny && views.empty()) return name == "museum5 20" || name == "crowd near";
  return views.empty() || std::any_of(views.begin(), views.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

void keep_speedups(AoSession& session) {
  AoHeadline& h = session.headline;
  if (!session.scene_speedups.empty()) {
    h.scene_speedup_geomean = geometric_mean(session.scene_speedups);
    h.scene_speedup_worst = *std::min_element(session.scene_speedups.begin(), session.scene_speedups.end());
  }
  if (!session.exact_speedups.empty()) h.exact_speedup_geomean = geometric_mean(session.exact_speedups);
}

}  // namespace

Expected<void> measure_scenes(AoSession& session) {
  Tables tables;
  const std::vector<int>& chosen = session.scenes.sizes;
  const auto sizes = chosen.empty() ? session.by_effort<std::vector<int>>({64}, {512}, {512, 1024}) : chosen;
  for (const std::string& name : ao_scene_names()) {
    if (!wanted(session, name)) continue;
    for (const int size : sizes) {
      const auto view = load_ao_scene(name, size, walkers(session), session.options.data, session.notes);
      if (!view) return tl::unexpected(view.error());
      if (*view == nullptr) break;
      if (auto done = SceneBench(session, **view).run(tables); !done) return done;
    }
  }
  print_table("Whole scenes: errors in 1/255 against many rays per point, times per frame", tables.ours);
  if (tables.race.size() > 1)
    print_table("Embree's filtered rays at the same RMS error; >: even the most rays leave more",
                tables.race);
  keep_speedups(session);
  return {};
}

}  // namespace tenebra::bench
