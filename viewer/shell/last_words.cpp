#include "shell/last_words.h"

#include <unistd.h>

#include <fmt/core.h>

#include <array>
#include <atomic>
#include <charconv>
#include <csignal>
#include <exception>
#include <initializer_list>
#include <new>
#include <string_view>
#include <system_error>

#include "shell/exit_codes.h"
#include "shell/memory_limit.h"

namespace tenebra::viewer {
namespace {

/// One after the other, whatever memory is left.
void print_without_memory(std::initializer_list<std::string_view> words) {
  for (const std::string_view word : words)
    static_cast<void>(!::write(STDERR_FILENO, word.data(), word.size()));
}

[[noreturn]] void end_now() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::exception& error) {
    if (is_memory_failure(error)) {
      print_no_memory();
      ::_exit(no_memory_code());
    }
    print_without_memory({"tenebra: stopped by an unexpected failure (", error.what(), ").\n"});
  } catch (...) {
    print_without_memory({"tenebra: stopped by an unexpected failure.\n"});
  }
  ::_exit(exit_codes::failed);
}

std::atomic<bool>& memory_has_failed() {
  static std::atomic<bool> failed = false;
  return failed;
}

void end_by_signal(int signal) {
  if (memory_has_failed() || near_memory_limit()) {
    print_no_memory();
    ::_exit(no_memory_code());
  }
  (void)std::signal(signal, SIG_DFL);
  (void)std::raise(signal);
}

}  // namespace

void expect_crashes_without_memory() {
  memory_has_failed() = false;
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) (void)std::signal(signal, end_by_signal);
}

void set_last_words() {
  std::set_terminate(end_now);
}

bool is_memory_failure(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  const bool failed = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                      (system != nullptr && system->code() == std::errc::resource_unavailable_try_again);
  if (failed) memory_has_failed() = true;
  return failed;
}

std::string no_memory_sentence() {
  const auto limit = memory_limit_mb();
  return limit ? fmt::format("not enough memory, {} MB are allowed; expected a larger --memory", *limit)
               : "not enough memory";
}

void print_no_memory() {
  const auto limit = memory_limit_mb();
  if (!limit) return print_without_memory({"tenebra: not enough memory.\n"});
  std::array<char, 24> digits{};
  const char* const end = std::to_chars(digits.begin(), digits.end(), *limit).ptr;
  print_without_memory({"tenebra: not enough memory, ",
                        {digits.data(), static_cast<std::size_t>(end - digits.data())},
                        " MB are allowed; expected a larger --memory.\n"});
}

int no_memory_code() {
  return memory_limit_mb() ? exit_codes::failed : exit_codes::outputs_failed;
}

}  // namespace tenebra::viewer
