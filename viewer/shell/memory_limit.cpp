#include "shell/memory_limit.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "base/fail.h"
#include "parallel/parallel.h"

namespace tenebra::viewer {
namespace {

constexpr rlim_t megabyte = rlim_t{1} << 20;

}  // namespace

// RLIMIT_DATA rather than RLIMIT_AS: libraries and drivers map far more addresses than they use. A first loop
// before it: oneTBB 2022.1 waits for itself without end if memory fails while it starts.
Expected<void> limit_memory(std::optional<int> memory_mb) {
  if (!memory_mb) return {};
  parallel::parallel_tasks(2, [](int) {});
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) == 0) {
    limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(*memory_mb) * megabyte);
    if (::setrlimit(RLIMIT_DATA, &limit) == 0) return {};
  }
  return base::fail("cannot set --memory {}: {}", *memory_mb, std::generic_category().message(errno));
}

bool near_memory_limit() {
  constexpr rlim_t little = 32 * megabyte;
  rlimit limit{};
  const int file = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return false;
  std::array<char, 256> text{};
  const auto length = ::read(file, text.data(), text.size());
  ::close(file);
  rlim_t pages = 0;  // of data and stacks: the sixth number of seven
  int spaces = 0;
  for (long i = 0; i < length && spaces < 6; ++i) {
    const char c = text[static_cast<std::size_t>(i)];
    if (c == ' ')
      ++spaces;
    else if (spaces == 5)
      pages = 10 * pages + static_cast<rlim_t>(c - '0');
  }
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + little > limit.rlim_cur;
}

std::optional<long> memory_limit_mb() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_DATA, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  return static_cast<long>(limit.rlim_cur / megabyte);
}

}  // namespace tenebra::viewer
