// Whole frames in the window beside those of `tenebra render`, and from a key to its picture.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/fail.h"
#include "bench/common/bench_program.h"
#include "bench/viewer/viewer_session.h"

namespace tenebra::bench {
namespace {

/// total_ms of each frame of a log.
std::vector<double> logged_totals(const std::string& log) {
  std::vector<double> totals;
  std::istringstream lines(log);
  std::ptrdiff_t column = -1;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (column < 0) {
      column = std::find(row.begin(), row.end(), "total_ms") - row.begin();
    } else if (static_cast<std::size_t>(column) < row.size()) {
      totals.push_back(std::stod(row[static_cast<std::size_t>(column)]));
    }
  }
  return totals;
}

Expected<double> rendered_ms(const ViewerSession& session, const std::string& scene, int frames) {
  const testing::TemporaryFolder folder;
  const auto arguments =
      with_library_settings({session.program, "render", scene, "--frames", fmt::format("0:{}", frames),
                             "--size", fmt::format("{0}x{0}", session.side()), "-o", "none", "--quiet",
                             "--log", (folder / "log.csv").string()});
  const auto result = testing::ChildProgram(arguments).wait(600);
  if (result.exit_code != 0) return base::fail("tenebra render: {}", result.errors);
  std::vector<double> totals = logged_totals(testing::read_text(folder / "log.csv"));
  if (totals.size() < 2) return base::fail("tenebra render: found no times in its log");
  totals.erase(totals.begin());  // in which buffers are made
  return median(totals);
}

/// total_ms of the whole frames that a held key makes, the first left out.
Expected<double> viewed_ms(WatchedViewer& viewer, const WatchedScreen& screen, double seconds) {
  const std::size_t from = viewer.event_count();
  screen.key(key_right, true);
  viewer.watch(0, seconds);
  screen.key(key_right, false);
  std::vector<double> totals;
  for (const auto& picture : viewer.events("picture", from)) {
    if (picture["preview"] == "") totals.push_back(picture["total_ms"]);
  }
  if (totals.size() < 3) return base::fail("viewer: found {} whole frames, expected more", totals.size());
  totals.erase(totals.begin());
  return median(totals);
}

/// Milliseconds from single presses to their pictures on the screen.
std::vector<double> key_to_picture_ms(WatchedViewer& viewer, const WatchedScreen& screen, int presses,
                                      double patience_s) {
  std::vector<double> times;
  for (int i = 0; i < presses; ++i) {
    viewer.watch(0, 0.5);  // at rest
    screen.key(key_right, true);
    screen.key(key_right, false);
    const Watched watched = viewer.watch(0, patience_s);
    if (watched.first_s > 0) times.push_back(1e3 * watched.first_s);
  }
  return times;
}

}  // namespace

Expected<void> measure_whole(ViewerSession& session) {
  const std::string scene = (std::filesystem::path(TENEBRA_SCENES_DIR) / "city.glb").string();
  const bool tiny = session.effort == Effort::tiny;
  const int rounds = session.effort == Effort::full ? 3 : 1, frames = tiny ? 3 : 40;
  std::vector<double> view, render, key;
  for (int i = 0; i < rounds; ++i) {
    progress("viewer: whole frames and tenebra render");
    const auto before = rendered_ms(session, scene, frames);
    if (!before) return tl::unexpected(before.error());
    WatchedViewer viewer(session.screen, session.program, scene, session.side(),
                         with_library_settings({"--preview-budget", "1000"}));  // whole pictures alone
    if (!viewer.wait_for_first_picture(60) || !viewer.wait_until_whole(60))
      return base::fail("viewer: city has no whole picture in 60 s");
    const auto ms = viewed_ms(viewer, session.screen, tiny ? 1.5 : 4);
    if (!ms) return tl::unexpected(ms.error());
    viewer.wait_until_whole(10);
    const auto presses = key_to_picture_ms(viewer, session.screen, tiny ? 1 : 8, 0.3 + 3e-3 * *ms);
    viewer.quit();
    const auto after = rendered_ms(session, scene, frames);
    if (!after) return tl::unexpected(after.error());
    view.push_back(*ms);
    render.push_back((*before + *after) / 2);
    key.insert(key.end(), presses.begin(), presses.end());
  }
  const double render_ms = median(render), view_ms = median(view);
  session.headline.over_render = view_ms / render_ms;
  if (!key.empty()) session.headline.key_to_picture = median(key) / render_ms;
  const auto add = [&](const char* contestant, const char* quantity, double value) {
    session.report.add({"whole", "city", contestant, "", quantity, value, "ms"});
  };
  add("render", "frame", render_ms);
  add("view", "frame", view_ms);
  if (!key.empty()) add("view", "key_to_picture", median(key));
  print_table("Whole frames of city, ms", {{"tenebra render", "tenebra view, key held", "key to picture"},
                                           {fmt::format("{:.1f}", render_ms), fmt::format("{:.1f}", view_ms),
                                            key.empty() ? "-" : fmt::format("{:.1f}", median(key))}});
  return {};
}

}  // namespace tenebra::bench
