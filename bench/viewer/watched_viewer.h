// `tenebra view` on a watched screen: what a person sees of it, and when.
#pragma once

#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/viewer/watched_screen.h"

namespace tenebra::bench {

/// What the screen showed over a while.
struct Watched {
  int pictures = 0;      ///< how often the view changed
  double seconds = 0;    ///< that it was watched
  double first_s = 0;    ///< until the first change; 0: there was none
  double longest_s = 0;  ///< without a change
  double black_s = 0;    ///< longest time without a picture in the view

  double a_second() const { return seconds > 0 ? pictures / seconds : 0; }
};

class WatchedViewer {
public:
  using Json = nlohmann::json;

  /// Starts the program on `scene` with a picture of `side` x `side`.
  WatchedViewer(const WatchedScreen& screen, const std::string& program, const std::string& scene, int side,
                const std::vector<std::string>& arguments);

  /// Seconds from the window's first sign to the first picture on the screen; none: there is no picture in
  /// `patience_s`.
  std::optional<double> wait_for_first_picture(double patience_s);
  /// Until the picture is whole and stands still; false if it does not in `patience_s`.
  bool wait_until_whole(double patience_s);
  /// Watches the screen while `act`, called again and again, moves; `still_s`: not counted at the start, as a
  /// held key does not repeat yet then.
  Watched watch(double still_s, double seconds, const std::function<void(double since_s)>& act = {});

  /// The same until `ends`, called now and then, is true, or for as long as patience lasts.
  Watched watch_until(double patience_s, const std::function<bool(double since_s)>& ends);

  /// All events of the report from number `from` on.
  std::vector<Json> events_from(std::size_t from);
  /// Events of the report from number `from` on whose "event" is `name`.
  std::vector<Json> events(const std::string& name, std::size_t from = 0);
  std::size_t event_count();
  /// Milliseconds until such an event comes; none in `patience_s`.
  std::optional<double> wait_for_event(const std::string& name, std::size_t from, double patience_s);
  void quit();

private:
  Watched watch_while(double still_s, double seconds, const std::function<bool(double since_s)>& goes_on);
  void read_events();
  bool is_black();
  ScreenArea watched_area() const;  ///< the middle of the picture: no mark or message lies there

  const WatchedScreen& screen_;
  int side_;
  testing::TemporaryFolder folder_;
  std::unique_ptr<testing::ChildProgram> program_;
  std::vector<Json> events_;
  std::streamoff read_ = 0;
  std::vector<std::uint8_t> sample_;
};

}  // namespace tenebra::bench
