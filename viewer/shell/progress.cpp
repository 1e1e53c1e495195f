#include "shell/progress.h"

#include <fmt/core.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "shell/console.h"

namespace tenebra::viewer {
namespace {

constexpr const char* clear_line = "\r\x1b[K";

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

}  // namespace

Progress::Progress(int frames, bool quiet)
    : frames_(frames), shown_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_) print_error("{}", clear_line);
}

void Progress::show(int done) {
  if (!shown_ || done < 1) return;
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
  const double seconds_a_frame = spent.count() / done;
  print_error("{}frame {} of {}, {:.0f} ms per frame, {} left", clear_line, done, frames_,
              seconds_a_frame * 1e3, duration(seconds_a_frame * (frames_ - done)));
  (void)std::fflush(stderr);
}

void Progress::show_building(std::string_view what, double done) {
  if (!shown_) return;
  print_error("{}{}: {:.0f} %", clear_line, what, 100.0 * done);
  (void)std::fflush(stderr);
}

void Progress::print_notes(const std::vector<std::string>& notes) {
  if (shown_ && !notes.empty()) print_error("{}", clear_line);
  for (const std::string& note : notes) print_error("note: {}\n", note);
}

}  // namespace tenebra::viewer
