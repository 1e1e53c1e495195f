// Consecutive frames: what changes from one to the next beside what changes with 256 samples per pixel.
#include <fmt/format.h>

#include <algorithm>

#include "bench/common/bench_scenes.h"
#include "bench/picture/picture_errors.h"
#include "bench/picture/picture_maker.h"
#include "bench/picture/picture_session.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

/// Scenes of thin things that move: the gallery's knot, the court's tree.
struct Run30 {
  const char* scene;
  int first;
};
constexpr Run30 runs[] = {{"gallery", 45}, {"court", 45}};

/// What changes with each of `sample_counts`.
struct Changes {
  ChangeSums of[3];
};

Expected<Changes> measure_run(PictureMaker& maker, int first, int frames, const std::string& name) {
  Changes changes;
  io::Image8 before[3], reference_before;
  for (int frame = first; frame < first + frames; ++frame) {
    maker.evaluate(frame);
    const auto drawn = maker.draw(reference_sampling);
    if (!drawn) return tl::unexpected(drawn.error());
    const io::Image8 reference = **drawn;
    for (int k = 0; k < 3; ++k) {
      const auto picture = maker.draw({sample_counts[k]});
      if (!picture) return tl::unexpected(picture.error());
      if (frame > first) add_change(before[k], **picture, reference_before, reference, changes.of[k]);
      before[k] = **picture;
    }
    reference_before = reference;
    if ((frame - first) % 10 == 9)
      progress(fmt::format("{}: {} of {} frames", name, frame - first + 1, frames));
  }
  return changes;
}

}  // namespace

Expected<void> measure_picture_flicker(PictureSession& session) {
  const int side = session.by_effort(32, 256, 512), frames = session.by_effort(3, 31, 31);
  std::vector<std::vector<std::string>> table{
      {"scene", "samples", "changes", "at 256", "flicker", "changes less at 256"}};
  double worst = 0;
  for (const Run30& run : runs) {
    const BenchScene& known = bench_scene(run.scene);
    std::unique_ptr<testing::TemporaryFolder> made;
    const auto scene = load_picture_scene(find_scene(known, {}, made), known.no_cast);
    if (!scene) return tl::unexpected(scene.error());
    auto maker = PictureMaker::create({*scene, side, side, thread_count()});
    if (!maker) return tl::unexpected(maker.error());
    const auto changes = measure_run(*maker, run.first, frames, run.scene);
    if (!changes) return tl::unexpected(changes.error());
    for (int k = 0; k < 3; ++k) {
      const ChangeSums& c = changes->of[k];
      const auto add = [&](const char* quantity, double value) {
        session.report.add({"flicker", run.scene, "tenebra", fmt::format("samples={}", sample_counts[k]),
                            quantity, value, "1/255"});
      };
      add("flicker", c.flicker());
      add("change", c.rms());
      add("reference_change", c.reference_rms());
      const auto level = [](double value) { return fmt::format("{:.3f}", value); };
      table.push_back({run.scene, fmt::format("{}", sample_counts[k]), level(c.rms()),
                       level(c.reference_rms()), level(c.flicker()), level(c.rms() - c.reference_rms())});
    }
    worst = std::max(worst, changes->of[2].flicker());
  }
  print_table(fmt::format("{} consecutive frames at {}x{}: RMS change from the frame before, 1/255",
                          frames - 1, side, side),
              table);
  session.headline.flicker_16 = worst;
  return {};
}

}  // namespace tenebra::bench
