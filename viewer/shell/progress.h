// Progress on a terminal: one line that says how far a render is and how long it will take.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::viewer {

/// Prints to standard error, and only if that is a terminal.
class Progress {
public:
  Progress(int frames, bool quiet);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` of the frames are drawn.
  void show(int done);
  /// Something long that the current frame needs is being built: `done` of 0..1.
  void show_building(std::string_view what, double done);
  /// "note: ..." on standard error whatever it is, one line each.
  void print_notes(const std::vector<std::string>& notes);

private:
  int frames_;
  bool shown_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace tenebra::viewer
