// Text for the user. Never throws: a failed write to standard output is found by main at the end, and with
// standard error gone there is no one left to tell.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace tenebra::viewer {

inline void write_text(std::FILE* stream, const std::string& text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

template <class... Args>
void print_out(fmt::format_string<Args...> format, Args&&... args) {
  write_text(stdout, fmt::format(format, std::forward<Args>(args)...));
}

template <class... Args>
void print_error(fmt::format_string<Args...> format, Args&&... args) {
  write_text(stderr, fmt::format(format, std::forward<Args>(args)...));
}

/// What went wrong, as every failure is reported: one line, "tenebra: sentence."
inline void print_failure(const std::string& sentence) {
  print_error("tenebra: {}{}\n", sentence, sentence.ends_with('.') ? "" : ".");
}

/// "warning: ..." on standard error, one line each.
inline void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error("warning: {}\n", warning);
}

}  // namespace tenebra::viewer
