#include "io/stream_writer.h"

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <system_error>

#include "base/fail.h"

namespace tenebra::io {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_at_flag_ms = 50;
constexpr std::chrono::milliseconds reader_patience{250};

tl::unexpected<Error> stream_failure(int error) {
  if (error == EPIPE) return base::fail("cannot write standard output: its reader is gone");
  return base::fail("cannot write standard output: {}", std::generic_category().message(error));
}

/// What a write does not wait with: a pipe that poll finds ready has room for this much.
std::size_t bytes_at_once() {
  struct stat found {};
  const bool is_file = ::fstat(STDOUT_FILENO, &found) == 0 && S_ISREG(found.st_mode);
  return is_file ? std::size_t{1} << 20 : PIPE_BUF;
}

}  // namespace

Expected<void> write_to_stdout(std::string_view bytes, const StopFlag* stop) {
  const std::size_t at_once = bytes_at_once();
  for (auto taken = Clock::now(); !bytes.empty();) {
    pollfd ready{STDOUT_FILENO, POLLOUT, 0};
    const int found = ::poll(&ready, 1, look_at_flag_ms);
    if (found < 0 && errno != EINTR) return stream_failure(errno);
    if (found <= 0) {
      if (stop_requested(stop) && Clock::now() - taken > reader_patience) return base::stopped();
      continue;
    }
    const ssize_t written = ::write(STDOUT_FILENO, bytes.data(), std::min(bytes.size(), at_once));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return stream_failure(errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    taken = Clock::now();
  }
  return {};
}

bool stdout_is_terminal() {
  return ::isatty(STDOUT_FILENO) == 1;
}

}  // namespace tenebra::io
