// A file opened in a window that shows another: from the key that chooses it to its first picture.
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "base/fail.h"
#include "bench/viewer/viewer_session.h"

namespace tenebra::bench {
namespace {

struct Opened {
  double first_s = 0;  ///< until a picture of the new file is on the screen
  double black_s = 0;  ///< longest time without a picture until then
};

/// The recent files of a window that showed `opened` before; the present one comes first.
std::string write_settings(const testing::TemporaryFolder& folder, const std::string& opened) {
  const std::string file = folder / "settings.json";
  testing::write_text(file, nlohmann::json{{"recent", {opened}}}.dump());
  return file;
}

/// Ctrl+O, then Down to the file below the present one; Enter is still to come.
void choose_recent(const WatchedScreen& screen, WatchedViewer& viewer) {
  screen.key(key_control, true);
  screen.key('o', true);
  screen.key('o', false);
  screen.key(key_control, false);
  viewer.watch(0, 0.5);
  screen.key(key_down, true);
  screen.key(key_down, false);
  viewer.watch(0, 0.5);
}

/// The number of the first picture of the file that was opened after event `from`; none: it has not come.
std::optional<std::uint64_t> first_picture(WatchedViewer& viewer, std::size_t from) {
  bool opened = false;
  for (const auto& event : viewer.events_from(from)) {
    opened = opened || event["event"] == "opened";
    if (opened && event["event"] == "picture") return event["number"].get<std::uint64_t>();
  }
  return std::nullopt;
}

Expected<Opened> open_next(const WatchedScreen& screen, WatchedViewer& viewer) {
  choose_recent(screen, viewer);
  const std::size_t from = viewer.event_count();
  screen.key(key_enter, true);
  screen.key(key_enter, false);
  Opened opened;
  const Watched watched = viewer.watch_until(picture_patience_s, [&](double since_s) {
    const auto first = first_picture(viewer, from);
    const auto shown = viewer.events("shown", from);
    if (!first || shown.empty()) return false;
    if (std::stoull(shown.back()["text"].get<std::string>()) < *first) return false;
    opened.first_s = since_s;
    return true;
  });
  if (opened.first_s == 0) return base::fail("viewer: found no picture of a file that was opened");
  opened.black_s = watched.black_s;
  return opened;
}

}  // namespace

Expected<void> measure_opens(ViewerSession& session) {
  std::vector<std::array<const char*, 2>> cases{
      {"gallery.glb", "city.glb"}, {"city.glb", "gallery.glb"}, {"city.glb", "square.glb"}};
  if (session.effort == Effort::tiny) cases.resize(1);
  const int rounds = session.effort == Effort::full ? 5 : session.effort == Effort::quick ? 2 : 1;
  std::vector<std::vector<std::string>> rows{{"from", "to", "Enter to picture, ms", "black, ms"}};
  const std::filesystem::path scenes(TENEBRA_SCENES_DIR);
  for (const auto& [from, to] : cases) {
    progress(fmt::format("viewer: {} is opened", to));
    Opened worst;
    for (int i = 0; i < rounds; ++i) {
      const testing::TemporaryFolder folder;
      WatchedViewer viewer(session.screen, session.program, (scenes / from).string(), session.side(),
                           {"--settings", write_settings(folder, (scenes / to).string())});
      if (!viewer.wait_for_first_picture(picture_patience_s) || !viewer.wait_until_whole(picture_patience_s))
        return base::fail("viewer: {} has no whole picture in {:g} s", from, picture_patience_s);
      const auto opened = open_next(session.screen, viewer);
      if (!opened) return tl::unexpected(opened.error());
      worst.first_s = std::max(worst.first_s, opened->first_s);
      worst.black_s = std::max({worst.black_s, opened->black_s, viewer.watch(0, 0.5).black_s});
      viewer.quit();
    }
    session.add_black(worst.black_s);
    const std::string name = fmt::format("{} to {}", from, to);
    session.report.add({"opens", name, "tenebra", "", "first_picture", 1e3 * worst.first_s, "ms"});
    session.report.add({"opens", name, "tenebra", "", "black", 1e3 * worst.black_s, "ms"});
    rows.push_back(
        {from, to, fmt::format("{:.0f}", 1e3 * worst.first_s), fmt::format("{:.0f}", 1e3 * worst.black_s)});
  }
  print_table("A file opened in the window, the longest", rows);
  return {};
}

}  // namespace tenebra::bench
