// Progress on a terminal: one line that says how far a render is and how long it will take.
#pragma once

#include <chrono>

namespace tenebra::viewer {

/// Prints to standard error, and only if that is a terminal.
class Progress {
public:
  Progress(int frames, bool quiet);
  ~Progress();  ///< clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` frames are written.
  void show(int done);

private:
  int frames_;
  bool shown_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace tenebra::viewer
