#include "bench/viewer/watched_viewer.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

namespace tenebra::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double look_again_s = 0.002;
constexpr int window_height = 1098, window_width = 1368;  // a picture of 1024x1024 beside the panel

double since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace

WatchedViewer::WatchedViewer(const WatchedScreen& screen, const std::string& program,
                             const std::string& scene, int side, const std::vector<std::string>& arguments)
    : screen_(screen), side_(side) {
  std::vector<std::string> all{program, "view", scene, "--size", fmt::format("{0}x{0}", side)};
  all.insert(all.end(), {"--window", fmt::format("{}x{}", window_width, window_height)});
  all.insert(all.end(), {"--report", (folder_ / "report.jsonl").string()});
  all.insert(all.end(), arguments.begin(), arguments.end());
  screen.move_to(5, 5);
  program_ = std::make_unique<testing::ChildProgram>(
      all, [display = screen.name()] { ::setenv("DISPLAY", display.c_str(), 1); });
}

/// The view is 1024 high and wide, or more, at the window's left and top; the picture is in its middle.
ScreenArea WatchedViewer::watched_area() const {
  const int middle = 512, reach = std::min(side_, 1024) / 4;
  return {middle - reach, middle - reach, middle + reach, middle + reach};
}

bool WatchedViewer::is_black() {
  constexpr int dark = 20;  // of 255; the view without a picture is darker
  screen_.sample(watched_area(), sample_);
  const auto bright = std::count_if(sample_.begin(), sample_.end(), [](int value) { return value > dark; });
  return bright * 10 < static_cast<std::ptrdiff_t>(sample_.size());
}

std::optional<double> WatchedViewer::wait_for_first_picture(double patience_s) {
  const auto begin = Clock::now();
  std::optional<Clock::time_point> window;
  std::vector<std::uint8_t> panel;
  for (; since(begin) < patience_s; sleep(look_again_s)) {
    if (!window) {
      screen_.sample({window_width - 300, 8, window_width - 8, window_height - 100}, panel);
      if (std::any_of(panel.begin(), panel.end(), [](int value) { return value > 8; })) window = Clock::now();
    }
    if (!is_black()) return window ? since(*window) : 0;
  }
  return std::nullopt;
}

bool WatchedViewer::wait_until_whole(double patience_s) {
  const auto begin = Clock::now();
  for (; since(begin) < patience_s; sleep(0.02)) {
    read_events();
    const auto last = [&](const char* name) {
      return std::find_if(events_.rbegin(), events_.rend(),
                          [&](const Json& event) { return event["event"] == name; });
    };
    const auto request = last("request"), picture = last("picture"), shown = last("shown");
    if (request == events_.rend() || picture == events_.rend() || shown == events_.rend()) continue;
    if ((*picture)["request"] == (*request)["number"] && (*picture)["preview"] == "" &&
        std::stoull((*shown)["text"].get<std::string>()) >= (*picture)["number"])
      return true;
  }
  return false;
}

Watched WatchedViewer::watch(double still_s, double seconds, const std::function<void(double)>& act) {
  return watch_while(still_s, seconds, [&](double since_s) {
    if (act) act(since_s);
    return true;
  });
}

Watched WatchedViewer::watch_until(double patience_s, const std::function<bool(double)>& ends) {
  return watch_while(0, patience_s, [&](double since_s) { return !ends(since_s); });
}

Watched WatchedViewer::watch_while(double still_s, double seconds,
                                   const std::function<bool(double)>& goes_on) {
  Watched watched;
  const auto begin = Clock::now();
  std::vector<std::uint8_t> shown, before;
  screen_.sample(watched_area(), shown);
  before = shown;
  double changed_s = 0, seen_s = 0, now_s = 0;
  while ((now_s = since(begin)) < seconds && goes_on(now_s)) {
    if (!is_black()) seen_s = now_s;
    watched.black_s = std::max(watched.black_s, now_s - seen_s);
    // A picture on its way to the screen is half the old one: it counts when it stands still.
    if (sample_ != shown && sample_ == before) {
      shown = sample_;
      if (watched.first_s == 0) watched.first_s = now_s;
      if (now_s >= still_s) {
        ++watched.pictures;
        watched.longest_s = std::max(watched.longest_s, now_s - std::max(still_s, changed_s));
      }
      changed_s = now_s;
    }
    std::swap(before, sample_);
    sleep(look_again_s);
  }
  watched.seconds = seconds - still_s;
  watched.longest_s = std::max(watched.longest_s, seconds - std::max(still_s, changed_s));
  return watched;
}

void WatchedViewer::read_events() {
  std::ifstream file(folder_ / "report.jsonl", std::ios::binary);
  file.seekg(read_);
  for (std::string line; std::getline(file, line) && !file.eof(); read_ += std::streamoff(line.size() + 1)) {
    events_.push_back(Json::parse(line, nullptr, false));
  }
}

std::vector<WatchedViewer::Json> WatchedViewer::events(const std::string& name, std::size_t from) {
  read_events();
  std::vector<Json> found;
  for (std::size_t i = from; i < events_.size(); ++i) {
    if (events_[i].value("event", "") == name) found.push_back(events_[i]);
  }
  return found;
}

std::vector<WatchedViewer::Json> WatchedViewer::events_from(std::size_t from) {
  read_events();
  return {events_.begin() + static_cast<std::ptrdiff_t>(std::min(from, events_.size())), events_.end()};
}

std::size_t WatchedViewer::event_count() {
  read_events();
  return events_.size();
}

std::optional<double> WatchedViewer::wait_for_event(const std::string& name, std::size_t from,
                                                    double patience_s) {
  const auto begin = Clock::now();
  for (; since(begin) < patience_s; sleep(look_again_s)) {
    if (!events(name, from).empty()) return 1e3 * since(begin);
  }
  return std::nullopt;
}

void WatchedViewer::quit() {
  program_->send(SIGTERM);
  program_->wait(10);
}

}  // namespace tenebra::bench
