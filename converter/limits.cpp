#include "limits.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace tenebra::converter {
namespace {

void limit(int what, std::uint64_t most) {
  rlimit bounds{};
  getrlimit(static_cast<__rlimit_resource>(what), &bounds);
  bounds.rlim_cur = bounds.rlim_max = std::min<rlim_t>(bounds.rlim_max, most);
  setrlimit(static_cast<__rlimit_resource>(what), &bounds);
}

}  // namespace

void limit_this_process(std::uint64_t file_bytes) {
  constexpr std::uint64_t gib = std::uint64_t{1} << 30, mib = std::uint64_t{1} << 20;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // these map terabytes
  limit(RLIMIT_AS, std::min(gib + 32 * std::min(file_bytes, gib), 16 * gib));
#endif
  limit(RLIMIT_CPU, 60 + file_bytes / mib);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CORE, 0);
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGKILL);         // sent when the thread ends that started this, which waits for it
  if (getppid() != parent) raise(SIGKILL);  // it ended just before
}

}  // namespace tenebra::converter
