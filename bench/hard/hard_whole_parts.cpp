// From ids to masks against the harder opponent: the lights of the scenes, and directional lights.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "bench/hard/hard_session.h"
#include "bench/hard/hard_whole.h"
#include "parallel/parallel.h"
#include "render/frame_lights.h"
#include "render/shadow_lights.h"

namespace tenebra::bench {
namespace {

// BART has no directional light: this one, towards the light, y up, stands in for it in all frames.
constexpr glm::vec3 bart_sun{0.1f, 1.0f, 0.5f};

std::vector<HardFrames> whole_frames(Effort effort) {
  if (effort == Effort::tiny)
    return {{"robots", {100}}, {"museum5", {20}}, {"kitchen", {100}}, {"city", {150}}};
  return {{"robots", {100, 160, 400, 640}},
          {"museum5", {20, 100, 200}},
          {"museum5x64", {20, 100, 200}},
          {"kitchen", {100, 400}},
          {"city", {30, 150, 250}}};
}

/// A scene's triangles by the middles of their edges in four, `times` times.
struct CutFrames {
  HardFrames frames;
  int times;
};
std::vector<CutFrames> cut_frames(Effort effort) {
  if (effort == Effort::tiny) return {{{"city", {150}}, 1}};
  return {{{"robots", {100, 160, 400, 640}}, 2}, {{"city", {30, 150, 250}}, 1}};
}

/// The lights that a frame is drawn with, those with a place or those from a direction.
std::vector<ShadowLight> lights_of(const Scene& scene, const HardView& view, bool directional) {
  render::FrameInput input;
  input.lights = view.frame.lights;
  std::vector<std::string> notes;
  std::vector<ShadowLight> lights;
  const auto drawn_lights = render::drawn_lights(scene, input, {}, notes);  // never fails: all are asked for
  for (const render::DrawnLight& drawn : *drawn_lights) {
    const ShadowLight light = render::shadow_light(drawn.light, drawn.placed);
    if (light.directional == directional) lights.push_back(light);
  }
  if (directional && view.counted) {  // BART
    ShadowLight sun;
    sun.directional = true;
    sun.to_light = bart_sun;
    lights = {sun};
  }
  return lights;
}

/// Ratios of all frames.
struct WholeRatios {
  std::vector<double> moved, still;

  std::vector<double> both() const {
    std::vector<double> all = moved;
    all.insert(all.end(), still.begin(), still.end());
    return all;
  }
};
double worst(const std::vector<double>& ratios) {
  return *std::max_element(ratios.begin(), ratios.end());
}

void report(const char* experiment, const HardView& view, const WholeTask& task, const WholeResult& r,
            Report& report) {
  const auto add = [&](const char* contestant, const std::string& quantity, double value, const char* unit) {
    report.add({experiment, view.name, contestant, fmt::format("lights={}", task.lights.size()), quantity,
                value, unit});
  };
  for (const auto& [name, times] : {std::pair{"moved", r.moved}, std::pair{"still", r.still}}) {
    add("tenebra", fmt::format("{}_time", name), times.ours, "ms");
    report.add(
        {experiment, view.name, "embree", times.embree_by, fmt::format("{}_time", name), times.embree, "ms"});
    add("tenebra", fmt::format("{}_ratio", name), times.ratio(), "");
  }
  add("embree", "build_time", r.moved.embree_build, "ms");
  add("tenebra", "tiles_time", r.tiles, "ms");
  add("embree", "differing_samples", static_cast<double>(r.differing), "");
}

Rows whole_head() {
  return {{"frame", "lights", "moved", "E. moved", "E. build", "ratio", "E. by", "still", "E. still", "ratio",
           "E. by", "tiles", "lit", "differing"}};
}
std::vector<std::string> row(const HardView& view, const WholeTask& task, const WholeResult& r) {
  const auto ms = [](double value) { return fmt::format("{:.2f}", value); };
  return {view.name,
          fmt::format("{}", task.lights.size()),
          ms(r.moved.ours),
          ms(r.moved.embree),
          ms(r.moved.embree_build),
          fmt::format("{:.3f}", r.moved.ratio()),
          r.moved.embree_by,
          ms(r.still.ours),
          ms(r.still.embree),
          fmt::format("{:.3f}", r.still.ratio()),
          r.still.embree_by,
          ms(r.tiles),
          fmt::format("{:.0f} %", 100.0 * static_cast<double>(r.lit) / static_cast<double>(r.samples)),
          fmt::format("{}", r.differing)};
}

class Measurement {
public:
  Measurement(HardSession& session, const char* experiment) : session_(session), experiment_(experiment) {}

  /// All frames with their lights; frames without such a light are passed over.
  Expected<void> measure(bool directional);
  /// All frames with their triangles cut up, with the lights that have a place.
  Expected<void> measure_cut();

  WholeRatios all;    ///< with all lights of the frames
  WholeRatios first;  ///< with the first of them alone

private:
  void one(const Scene& scene, const HardView& view, bool directional);
  void add(const HardView& view, const WholeTask& task, WholeRatios& ratios);
  void conclude() const;

  HardSession& session_;
  const char* experiment_;
  Rows table_ = whole_head();
};

void Measurement::add(const HardView& view, const WholeTask& task, WholeRatios& ratios) {
  const WholeResult result = run_whole_contest(task);
  ratios.moved.push_back(result.moved.ratio());
  ratios.still.push_back(result.still.ratio());
  report(experiment_, view, task, result, session_.report);
  table_.push_back(row(view, task, result));
  progress(fmt::format("{}, {}, {} lights: {:.3f} of Embree moved, {:.3f} still", experiment_, view.name,
                       task.lights.size(), result.moved.ratio(), result.still.ratio()));
}

void Measurement::one(const Scene& scene, const HardView& view, bool directional) {
  WholeTask task{view, lights_of(scene, view, directional), thread_count(), session_.by_effort(1, 5, 15),
                 session_.simd};
  if (task.lights.empty()) return;
  add(view, task, all);
  if (task.lights.size() == 1) {
    first.moved.push_back(all.moved.back());
    first.still.push_back(all.still.back());
    return;
  }
  task.lights.resize(1);
  add(view, task, first);
}

Expected<void> Measurement::measure(bool directional) {
  const auto body = [&](const Scene& scene, const HardView& view) -> Expected<void> {
    one(scene, view, directional);
    return {};
  };
  auto done =
      for_each_view(session_.options, whole_frames(session_.effort), session_.size(), session_.skipped, body);
  if (done && !all.moved.empty()) conclude();
  return done;
}

Expected<void> Measurement::measure_cut() {
  for (const CutFrames& cut : cut_frames(session_.effort)) {
    const auto body = [&](const Scene& scene, const HardView& whole) -> Expected<void> {
      HardView view = whole;
      for (int i = 0; i < cut.times; ++i) subdivide(view.before), subdivide(view.frame.geometry);
      see_anew(view, session_.size());
      view.name = fmt::format("{} x{}", whole.name, 1 << (2 * cut.times));
      one(scene, view, false);
      return {};
    };
    auto done = for_each_view(session_.options, {cut.frames}, session_.size(), session_.skipped, body);
    if (!done) return done;
  }
  if (!all.moved.empty()) conclude();
  return {};
}

void Measurement::conclude() const {
  print_table(fmt::format("{}: from ids to the masks of all lights, medians in ms", experiment_), table_);
  for (const auto& [name, ratios] : {std::pair{"all lights", all}, std::pair{"first light alone", first}}) {
    std::printf("%s: geometric means %.3f moved, %.3f still; worst %.3f moved, %.3f still\n", name,
                geometric_mean(ratios.moved), geometric_mean(ratios.still), worst(ratios.moved),
                worst(ratios.still));
  }
}

}  // namespace

Expected<void> measure_hard_whole(HardSession& session) {
  Measurement whole(session, "whole");
  auto done = whole.measure(false);
  if (!done || whole.all.moved.empty()) return done;
  HardHeadline& h = session.headline;
  h.whole_moved_geomean = geometric_mean(whole.all.moved);
  h.whole_moved_worst = worst(whole.all.moved);
  h.whole_static_geomean = geometric_mean(whole.all.still);
  h.whole_static_worst = worst(whole.all.still);
  h.first_moved_geomean = geometric_mean(whole.first.moved);
  h.first_moved_worst = worst(whole.first.moved);
  h.first_static_geomean = geometric_mean(whole.first.still);
  h.first_static_worst = worst(whole.first.still);
  return {};
}

Expected<void> measure_hard_sun(HardSession& session) {
  Measurement sun(session, "sun");
  auto done = sun.measure(true);
  if (!done || sun.all.moved.empty()) return done;
  session.headline.sun_geomean = geometric_mean(sun.all.both());
  session.headline.sun_worst = worst(sun.all.both());
  return {};
}

Expected<void> measure_hard_cut(HardSession& session) {
  Measurement cut(session, "cut");
  auto done = cut.measure_cut();
  if (!done || cut.all.moved.empty()) return done;
  session.headline.cut_moved_geomean = geometric_mean(cut.all.moved);
  session.headline.cut_moved_worst = worst(cut.all.moved);
  return {};
}

}  // namespace tenebra::bench
