// The frames of the goals, at two sizes, against the renderer on Embree.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "base/fail.h"
#include "bench/common/bench_frame.h"
#include "bench/common/bench_scenes.h"
#include "bench/frame/frame_contest.h"
#include "bench/frame/frame_session.h"
#include "parallel/parallel.h"
#include "stage/cutout/cutout.h"
#include "stage/looks.h"

namespace tenebra::bench {
namespace {

constexpr ScenePlace places[] = {
    {"city", 150}, {"robots", 100}, {"kitchen", 100}, {"museum5", 20}, {"court", 60}};
struct Size {
  int width, height;
};

/// As the program prepares it, but that glass is opaque: Embree's side would need a renderer of its own for
/// it.
void prepare(Scene& scene) {
  make_opaque(scene);
  stage::cut_out_masks(scene);
  stage::leave_out_blank_emission(scene);
}

Rows head() {
  return {{"view", "size", "Tenebra", "evaluate", "raster", "points", "shadows", "shade", "Embree",
           "evaluate", "tree", "primary", "shadows", "shade", "by", "ratio", "unshaded", "differing"}};
}

std::vector<std::string> row(const FrameContest& contest, Size size, const FrameContestResult& r) {
  const auto ms = [](double value) { return fmt::format("{:.1f}", value); };
  const TenebraFrameTimes& a = r.ours;
  const EmbreeFrameTimes& b = r.theirs;
  return {contest.name,
          fmt::format("{}x{}", size.width, size.height),
          ms(a.total),
          ms(a.evaluate),
          ms(a.raster),
          ms(a.points),
          ms(a.shadows),
          ms(a.shade),
          ms(b.total),
          ms(b.evaluate),
          ms(b.tree),
          ms(b.primary),
          ms(b.shadows),
          ms(b.shade),
          r.embree_by,
          fmt::format("{:.3f}", r.ratio()),
          fmt::format("{:.3f}", r.unshaded_ratio()),
          fmt::format("{:.2f} %", 100 * r.differing)};
}

void report(const FrameContest& contest, Size size, const FrameContestResult& r, Report& report) {
  const std::string where = fmt::format("{}x{}", size.width, size.height);
  const auto add = [&](const char* contestant, const char* quantity, double value, const char* unit) {
    report.add({"frame", contest.name, contestant, where, quantity, value, unit});
  };
  const TenebraFrameTimes& a = r.ours;
  add("tenebra", "time", a.total, "ms");
  add("tenebra", "evaluate_time", a.evaluate, "ms");
  add("tenebra", "raster_time", a.raster, "ms");
  add("tenebra", "points_time", a.points, "ms");
  add("tenebra", "shadows_time", a.shadows, "ms");
  add("tenebra", "shade_time", a.shade, "ms");
  const EmbreeFrameTimes& b = r.theirs;
  add("embree", "time", b.total, "ms");
  add("embree", "evaluate_time", b.evaluate, "ms");
  add("embree", "tree_time", b.tree, "ms");
  add("embree", "primary_time", b.primary, "ms");
  add("embree", "shadows_time", b.shadows, "ms");
  add("embree", "shade_time", b.shade, "ms");
  add("tenebra", "ratio", r.ratio(), "");
  add("tenebra", "unshaded_ratio", r.unshaded_ratio(), "");
  add("both", "differing_share", r.differing, "");
  add("both", "lights", static_cast<double>(r.lights), "");
}

class Measurement {
public:
  explicit Measurement(FrameSession& session) : session_(session) {}

  Expected<void> measure(const ScenePlace& place, const Scene& scene, const shade::SurfaceTable& surfaces,
                         Size size);
  void conclude() const;

private:
  FrameSession& session_;
  Rows table_ = head();
  std::vector<double> ratios_, unshaded_;
};

Expected<void> Measurement::measure(const ScenePlace& place, const Scene& scene,
                                    const shade::SurfaceTable& surfaces, Size size) {
  FrameContest contest{fmt::format("{} {}", place.scene, place.frame), {}, session_.by_effort(1, 3, 7)};
  const int after = session_.by_effort(0, 1, 2);
  for (int frame = place.frame - 1; frame <= place.frame + after; ++frame) contest.frames.push_back(frame);
  const auto result = run_frame_contest({scene, surfaces, size.width, size.height, thread_count()}, contest);
  if (!result) return tl::unexpected(result.error());
  ratios_.push_back(result->ratio());
  unshaded_.push_back(result->unshaded_ratio());
  if (place.scene == std::string("city") && size.width == size.height)
    session_.headline.city_per_second = 1e3 / result->ours.total;
  report(contest, size, *result, session_.report);
  table_.push_back(row(contest, size, *result));
  progress(fmt::format("{}, {}x{}: {:.1f} ms, {:.3f} of Embree", contest.name, size.width, size.height,
                       result->ours.total, result->ratio()));
  return {};
}

void Measurement::conclude() const {
  if (ratios_.empty()) return;
  print_table("Whole frames without files, medians in ms (\"unshaded\": the ratio without the shading)",
              table_);
  session_.headline.ratio_geomean = geometric_mean(ratios_);
  session_.headline.ratio_worst = *std::max_element(ratios_.begin(), ratios_.end());
  session_.headline.unshaded_geomean = geometric_mean(unshaded_);
  session_.headline.unshaded_worst = *std::max_element(unshaded_.begin(), unshaded_.end());
}

}  // namespace

Expected<void> measure_frames(FrameSession& session) {
  if (!has_ray_masks()) {
    session.skipped.push_back("scenes: skipped, this Embree was built without ray masks");
    return {};
  }
  const std::vector<Size> sizes = session.effort == Effort::tiny
                                      ? std::vector<Size>{{64, 64}, {72, 40}}
                                      : std::vector<Size>{{1024, 1024}, {1920, 1080}};
  Measurement measurement(session);
  const auto body = [&](const ScenePlace& place, const BenchScene& known,
                        const std::filesystem::path& file) -> Expected<void> {
    auto scene = load_scene(file, known.no_cast);
    if (!scene) return tl::unexpected(scene.error());
    prepare(*scene);
    const shade::SurfaceTable surfaces(*scene);
    for (const Size size : sizes) {
      if (auto measured = measurement.measure(place, *scene, surfaces, size); !measured) return measured;
    }
    return {};
  };
  if (auto done = for_each_place(places, session.options.data, session.skipped, body); !done) return done;
  measurement.conclude();
  return {};
}

}  // namespace tenebra::bench
