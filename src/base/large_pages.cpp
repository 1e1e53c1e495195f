#include "base/large_pages.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace tenebra::base {

#ifdef __GLIBC__  // before 2.35 it ignores the setting

namespace {

bool given_on_request() {
  std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
  std::string choices;
  return std::getline(file, choices) && choices.find("[madvise]") != std::string::npos;
}

}  // namespace

// First frames, which write to all of their memory for the first time, take 0.2 to 0.9 of the time. mallopt()
// does not have this setting, and thresholds and padding, which it has, gained less and kept more memory. Not
// with LD_PRELOAD: valgrind and the like would lose the program.
void restart_with_large_pages(char** argv) {
  if (std::getenv("GLIBC_TUNABLES") != nullptr || std::getenv("LD_PRELOAD") != nullptr || !given_on_request())
    return;
  std::error_code error;  // the program's own path, so that its name stays what `ps` shows
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error && ::setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0) == 0) ::execv(program.c_str(), argv);
}

#else

void restart_with_large_pages(char**) {}

#endif

}  // namespace tenebra::base
