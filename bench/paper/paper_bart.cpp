// The rules of BART (Lext, Assarsson and Möller 2001): an animation is rendered whole; its total time, its
// worst frame and the standard deviation of its frames' times count.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_plot.h"
#include "bench/common/bench_scenes.h"
#include "bench/common/scene_renderer.h"
#include "bench/paper/paper_session.h"
#include "stage/cutout/cutout.h"
#include "stage/looks.h"

namespace tenebra::bench {
namespace {

struct BartClip {
  const char* scene;
  int frames;
};
constexpr BartClip bart_clips[] = {{"kitchen", 800}, {"robots", 800}, {"museum5", 300}};
constexpr BartClip clip_without_bart{"city", 300};

struct ClipTimes {
  std::string scene;
  int frames = 0;       ///< of the animation
  std::vector<int> at;  ///< frames that were drawn
  std::vector<double> ms;
};

int bart_step(const PaperSession& session, int count) {
  return session.paper.stride > 0 ? session.paper.stride : session.by_effort(count / 2, 16, 1);
}

Expected<ClipTimes> draw_clip(const PaperSession& session, const BartClip& clip,
                              const std::filesystem::path& file) {
  auto scene = load_scene(file, bench_scene(clip.scene).no_cast);
  if (!scene) return tl::unexpected(scene.error());
  stage::cut_out_masks(*scene);
  stage::leave_out_blank_emission(*scene);
  const bool tiny = session.effort == Effort::tiny;
  auto renderer = SceneRenderer::create({*scene, tiny ? 64 : 800, tiny ? 48 : 600, session.options.threads});
  if (!renderer) return tl::unexpected(renderer.error());
  ClipTimes times{clip.scene, clip.frames, {}, {}};
  const int step = bart_step(session, clip.frames);
  for (int frame = 0; frame < clip.frames; frame += step) {
    base::Stopwatch watch;
    renderer->evaluate(frame);
    if (const auto drawn = renderer->draw(renderer->settings()); !drawn) return tl::unexpected(drawn.error());
    times.at.push_back(frame), times.ms.push_back(watch.lap_ms());
    if (times.ms.size() % 100 == 1)
      progress(fmt::format("{} {}: {:.1f} ms", clip.scene, frame, times.ms.back()));
  }
  return times;
}

std::vector<std::string> clip_row(const ClipTimes& times, Report& report) {
  double total = 0, squares = 0;
  for (const double ms : times.ms) total += ms;
  const auto count = static_cast<double>(times.ms.size());
  const double mean = total / count;
  for (const double ms : times.ms) squares += (ms - mean) * (ms - mean);
  const double deviation = std::sqrt(squares / count);
  const auto worst = static_cast<std::size_t>(
      std::distance(times.ms.begin(), std::max_element(times.ms.begin(), times.ms.end())));
  report.add({"bart", times.scene, "tenebra", "", "total time", total, "ms"});
  report.add({"bart", times.scene, "tenebra", "", "worst frame", times.ms[worst], "ms"});
  report.add({"bart", times.scene, "tenebra", "", "standard deviation", deviation, "ms"});
  return {times.scene,
          fmt::format("{} of {}", times.ms.size(), times.frames),
          fmt::format("{:.2f}", total / 1000),
          fmt::format("{:.1f}", mean),
          fmt::format("{:.1f} (frame {})", times.ms[worst], times.at[worst]),
          fmt::format("{:.1f}", deviation)};
}

Expected<std::vector<ClipTimes>> draw_clips(PaperSession& session) {
  std::vector<ClipTimes> all;
  const auto draw = [&](const BartClip& clip) -> Expected<bool> {
    const ScenePlace place{clip.scene, 0};
    bool there = false;
    const auto body = [&](const ScenePlace&, const BenchScene&,
                          const std::filesystem::path& file) -> Expected<void> {
      there = true;
      auto times = draw_clip(session, clip, file);
      if (!times) return tl::unexpected(times.error());
      all.push_back(std::move(*times));
      return {};
    };
    if (auto done = for_each_place({&place, 1}, session.options.data, session.skipped, body); !done)
      return tl::unexpected(done.error());
    return there;
  };
  for (const BartClip& clip : bart_clips)
    if (const auto drawn = draw(clip); !drawn) return tl::unexpected(drawn.error());
  if (all.empty())
    if (const auto drawn = draw(clip_without_bart); !drawn) return tl::unexpected(drawn.error());
  return all;
}

}  // namespace

Expected<void> measure_paper_bart(PaperSession& session) {
  const auto clips = draw_clips(session);
  if (!clips) return tl::unexpected(clips.error());
  PaperSection section;
  section.title = bart_title;
  section.setup = fmt::format(
      "Consecutive frames, each from evaluating the scene at its time to the picture in memory, loading "
      "apart: {}, one sample per pixel, hard shadows of all lights, otherwise `tenebra`'s own settings. The "
      "benchmark's rules want the total time, the worst frame and the standard deviation, of all frames. "
      "These rules are for ray tracers: they ask for reflections among other things, and Tenebra draws none, "
      "so the times are not comparable with those of programs that do. Their measure of errors is for "
      "approximations: here masks are exact.{}",
      session.effort == Effort::tiny ? "64x48" : "800x600",
      clips->front().scene == clip_without_bart.scene ? " BART is not here: the city stands in for it." : "");
  Rows rows{{"scene", "frames", "total s", "mean ms", "worst ms", "standard deviation ms"}};
  std::vector<Curve> curves;
  for (const ClipTimes& times : *clips) {
    rows.push_back(clip_row(times, session.report));
    curves.push_back({times.scene, {}});
    for (std::size_t i = 0; i < times.ms.size(); ++i)
      curves.back().points.emplace_back(100.0 * times.at[i] / times.frames, times.ms[i]);
  }
  section.tables = {{"Times of frames", rows}};
  section.plots.emplace_back("bart", curve_plot("Times of frames", {"% of the animation"}, {"ms"}, curves));
  session.finish(std::move(section));
  return {};
}

}  // namespace tenebra::bench
