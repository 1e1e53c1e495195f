// What writing pictures adds: the program over an animation, with them and without.
#include <fmt/format.h>

#include <filesystem>

#include "base/fail.h"
#include "base/stopwatch.h"
#include "bench/common/bench_program.h"
#include "bench/frame/frame_session.h"
#include "parallel/parallel.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

struct ProgramRun {
  std::filesystem::path program;
  std::string frames, size;
  int threads;

  /// Milliseconds of the whole process.
  Expected<double> ms(const std::string& output) const {
    const auto arguments = with_library_settings(
        {program.string(), "render", (std::filesystem::path(TENEBRA_SCENES_DIR) / "city.glb").string(),
         "--frames", frames, "--size", size, "--threads", fmt::format("{}", threads), "--quiet", "-o",
         output});
    base::Stopwatch watch;
    const auto result = testing::ChildProgram(arguments).wait(600);
    const double ms = watch.lap_ms();
    if (result.exit_code != 0)
      return base::fail("{}: found exit code {}, expected 0: {}", program.string(), result.exit_code,
                        result.errors);
    return ms;
  }
};

}  // namespace

Expected<void> measure_frame_files(FrameSession& session) {
  const auto program = program_file();
  if (program.empty()) {
    session.skipped.push_back("files: skipped, found no program tenebra beside this one");
    return {};
  }
  const bool tiny = session.effort == Effort::tiny;
  const ProgramRun run{program, tiny ? "0:2" : "0:60", tiny ? "64x64" : "1024x1024", thread_count()};
  std::vector<double> with, without;
  for (int round = 0; round < session.by_effort(1, 1, 3); ++round) {
    const testing::TemporaryFolder folder;
    const auto bare = run.ms("none");
    if (!bare) return tl::unexpected(bare.error());
    const auto pictures = run.ms((folder / "city_%04d.png").string());
    if (!pictures) return tl::unexpected(pictures.error());
    without.push_back(*bare);
    with.push_back(*pictures);
    progress(fmt::format("city, {} frames: {:.0f} ms with pictures, {:.0f} without", run.frames, *pictures,
                         *bare));
  }
  const double most = median(with), least = median(without);
  session.report.add({"files", "city", "tenebra", "pictures", "time", most, "ms"});
  session.report.add({"files", "city", "tenebra", "none", "time", least, "ms"});
  print_table(
      fmt::format("tenebra render scenes/city.glb --frames {} --size {}, one sample per pixel", run.frames,
                  run.size),
      {{"output", "ms"}, {"pictures", fmt::format("{:.0f}", most)}, {"none", fmt::format("{:.0f}", least)}});
  session.headline.render_over_frames = most / least;
  return {};
}

}  // namespace tenebra::bench
