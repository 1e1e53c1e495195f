#include "shell/last_words.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "shell/exit_codes.h"
#include "shell/memory_limit.h"

namespace tenebra::viewer {
namespace {

template <class... Args>
void print_without_memory(fmt::format_string<Args...> format, Args&&... args) {
  std::array<char, 512> text{};
  const auto end = fmt::format_to_n(text.data(), text.size(), format, std::forward<Args>(args)...);
  const std::size_t size = std::min(end.size, text.size());
  static_cast<void>(!::write(STDERR_FILENO, text.data(), size));
}

[[noreturn]] void end_now() {
  try {
    if (std::current_exception()) throw;
  } catch (const std::exception& error) {
    if (is_memory_failure(error)) {
      print_no_memory();
      ::_exit(no_memory_code());
    }
    print_without_memory("tenebra: stopped by an unexpected failure ({}).\n", error.what());
  } catch (...) {
    print_without_memory("tenebra: stopped by an unexpected failure.\n");
  }
  ::_exit(exit_codes::failed);
}

}  // namespace

void set_last_words() {
  std::set_terminate(end_now);
}

bool is_memory_failure(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
         (system != nullptr && system->code() == std::errc::resource_unavailable_try_again);
}

void print_no_memory() {
  if (const auto limit = memory_limit_mb())
    print_without_memory("tenebra: not enough memory, {} MB are allowed; expected a larger --memory.\n",
                         *limit);
  else
    print_without_memory("tenebra: not enough memory.\n");
}

int no_memory_code() {
  return memory_limit_mb() ? exit_codes::failed : exit_codes::outputs_failed;
}

}  // namespace tenebra::viewer
