// Held keys and drags, on frames that take seconds and on faster ones; and until there is a picture.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "base/fail.h"
#include "bench/viewer/viewer_session.h"

namespace tenebra::bench {
namespace {

constexpr double repeat_s = 0.4;  // held keys repeat by then
constexpr unsigned long key_w = 'w';
struct ViewCase {
  const char* name;
  const char* scene;
  std::vector<std::string> arguments;
};

std::string file_of(const ViewCase& view) {
  return (std::filesystem::path(TENEBRA_SCENES_DIR) / view.scene).string();
}

std::vector<ViewCase> hand_cases(const ViewerSession& session) {
  std::vector<ViewCase> cases{{"city", "city.glb", {}},
                              {"court soft", "court.glb", {"--shadows", "soft"}},
                              {"city ao", "city.glb", {"--ao", "field"}}};
  if (session.effort == Effort::tiny) cases.resize(1);
  if (session.effort == Effort::full)
    cases.push_back({"court ao soft", "court.glb", {"--shadows", "soft", "--ao", "field"}});
  return cases;
}

/// What a hand does, from its begin to its end.
struct Hand {
  const char* name;
  void (*begin)(const WatchedScreen&);
  void (*move)(const WatchedScreen&, double since_s);  ///< null: the key repeats by itself
  void (*end)(const WatchedScreen&);
};

/// A circle in a corner of the view, away from what is watched.
void drag_on_circle(const WatchedScreen& screen, double since_s) {
  const double angle = 0.5 * 2 * std::numbers::pi * since_s;
  screen.move_to(static_cast<int>(120 + 80 * std::cos(angle)), static_cast<int>(120 + 80 * std::sin(angle)));
}

constexpr std::array hands{
    Hand{"key Right (time)", [](const WatchedScreen& screen) { screen.key(key_right, true); }, nullptr,
         [](const WatchedScreen& screen) { screen.key(key_right, false); }},
    Hand{"key W (flight)", [](const WatchedScreen& screen) { screen.key(key_w, true); }, nullptr,
         [](const WatchedScreen& screen) { screen.key(key_w, false); }},
    Hand{"drag (orbit)",
         [](const WatchedScreen& screen) {
           drag_on_circle(screen, 0);
           screen.button(1, true);
         },
         drag_on_circle, [](const WatchedScreen& screen) { screen.button(1, false); }}};

void measure_hand(ViewerSession& session, const ViewCase& view, const Hand& hand, WatchedViewer& viewer,
                  std::vector<std::vector<std::string>>& rows) {
  const double seconds = session.effort == Effort::full ? 6.4 : session.effort == Effort::quick ? 3.4 : 0.9;
  const WatchedScreen& screen = session.screen;
  const std::size_t from = viewer.event_count();
  hand.begin(screen);
  const Watched watched = viewer.watch(repeat_s, seconds, [&](double since_s) {
    if (hand.move) hand.move(screen, since_s);
  });
  hand.end(screen);
  int previews = 0, whole = 0;
  for (const auto& picture : viewer.events("picture", from)) ++(picture["preview"] == "" ? whole : previews);
  rows.push_back({view.name, hand.name, fmt::format("{:.1f}", watched.a_second()),
                  fmt::format("{:.0f}", 1e3 * watched.first_s),
                  fmt::format("{:.0f}", 1e3 * watched.longest_s), fmt::format("{}", previews),
                  fmt::format("{}", whole)});
  const auto add = [&](const char* quantity, double value, const char* unit) {
    session.report.add({"hands", view.name, "tenebra", hand.name, quantity, value, unit});
  };
  add("pictures_per_second", watched.a_second(), "1/s");
  add("first_picture", 1e3 * watched.first_s, "ms");
  add("longest_still", 1e3 * watched.longest_s, "ms");
  add("previews", previews, "");
  add("whole_pictures", whole, "");
  std::optional<double>& worst = session.headline.pictures_per_second_worst;
  worst = std::min(worst.value_or(INFINITY), watched.a_second());
  session.add_black(watched.black_s);
}

}  // namespace

Expected<void> measure_hands(ViewerSession& session) {
  std::vector<std::vector<std::string>> rows{
      {"view", "hand", "pictures/s", "first, ms", "longest, ms", "previews", "whole"}};
  for (const ViewCase& view : hand_cases(session)) {
    progress(fmt::format("viewer: {}", view.name));
    WatchedViewer viewer(session.screen, session.program, file_of(view), session.side(), view.arguments);
    const auto black_s = viewer.wait_for_first_picture(picture_patience_s);
    if (!black_s) return base::fail("viewer: {} shows no picture in {:g} s", view.name, picture_patience_s);
    for (const Hand& hand : hands) {
      if (!viewer.wait_until_whole(picture_patience_s))
        return base::fail("viewer: {} has no whole picture in {:g} s", view.name, picture_patience_s);
      measure_hand(session, view, hand, viewer, rows);
    }
    viewer.quit();
  }
  print_table("While a hand moves", rows);
  return {};
}

Expected<void> measure_starts(ViewerSession& session) {
  std::vector<ViewCase> cases{{"city", "city.glb", {}},
                              {"gallery", "gallery.glb", {}},
                              {"court soft", "court.glb", {"--shadows", "soft"}},
                              {"square", "square.glb", {}},
                              {"city ao", "city.glb", {"--ao", "field", "--ao-cache", "none"}}};
  if (session.effort == Effort::tiny) cases.resize(1);
  std::vector<std::vector<std::string>> rows{{"view", "window to picture, ms"}};
  const int rounds = session.effort == Effort::full ? 5 : session.effort == Effort::quick ? 2 : 1;
  for (const ViewCase& view : cases) {
    progress(fmt::format("viewer: start of {}", view.name));
    double worst_s = 0;
    for (int i = 0; i < rounds; ++i) {
      WatchedViewer viewer(session.screen, session.program, file_of(view), session.side(), view.arguments);
      const auto black_s = viewer.wait_for_first_picture(picture_patience_s);
      if (!black_s) return base::fail("viewer: {} shows no picture in {:g} s", view.name, picture_patience_s);
      const Watched after = viewer.watch(0, 0.5);  // refining: the picture stays
      worst_s = std::max({worst_s, *black_s, after.black_s});
      viewer.quit();
    }
    session.add_black(worst_s);
    session.report.add({"starts", view.name, "tenebra", "", "black", 1e3 * worst_s, "ms"});
    rows.push_back({view.name, fmt::format("{:.0f}", 1e3 * worst_s)});
  }
  print_table("Time until there is a picture, the longest", rows);
  return {};
}

Expected<void> measure_explain(ViewerSession& session) {
  progress("viewer: why is it dark");
  const ViewCase view{"court", "court.glb", {}};
  WatchedViewer viewer(session.screen, session.program, file_of(view), session.side(), view.arguments);
  if (!viewer.wait_for_first_picture(picture_patience_s) || !viewer.wait_until_whole(picture_patience_s))
    return base::fail("viewer: {} has no whole picture in {:g} s", view.name, picture_patience_s);
  std::vector<double> times_ms;
  const int clicks = session.effort == Effort::tiny ? 1 : 10;
  for (int i = 0; i < clicks; ++i) {
    session.screen.move_to(300 + 40 * i, 600 + 15 * i);
    viewer.watch(0, 0.3);
    const std::size_t from = viewer.event_count();
    session.screen.button(1, true);
    session.screen.button(1, false);
    const auto ms = viewer.wait_for_event("explained", from, 2);
    if (!ms) break;
    times_ms.push_back(*ms);
    session.report.add({"explain", view.name, "tenebra", fmt::format("click={}", i), "time", *ms, "ms"});
  }
  viewer.quit();
  if (times_ms.empty()) {
    session.skipped.push_back("explain: skipped, a click on the picture explains nothing");
    return {};
  }
  session.headline.explain_ms = median(times_ms);
  return {};
}

}  // namespace tenebra::bench
