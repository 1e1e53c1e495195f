// How the program ends: what a script or a farm reads. The help of `tenebra render` lists them.
#pragma once

namespace tenebra::viewer::exit_codes {

inline constexpr int failed = 1;             ///< would fail again: a wrong option, a broken scene
inline constexpr int comparison_failed = 2;  ///< `tenebra compare` says with 1 that pictures differ
/// A file could not be written, or no memory is left: try again once there is room.
inline constexpr int outputs_failed = 75;
inline constexpr int timed_out = 124;    ///< as timeout(1) has it
inline constexpr int reader_gone = 141;  ///< as if by SIGPIPE: `tenebra info SCENE | head`

/// By convention: 130 for SIGINT, 143 for SIGTERM.
constexpr int of_signal(int signal) {
  return 128 + signal;
}

}  // namespace tenebra::viewer::exit_codes
