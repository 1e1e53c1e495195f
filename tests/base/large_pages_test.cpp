// Programs that start again for large pages: once, and not where the user has a say in it.
#include "base/large_pages.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace tenebra::base {
namespace {

constexpr int returned = 7;

/// The exit code of a process with this variable alone that asks for large pages: 0 if that starts this
/// program again, which then lists none of its tests; else `returned`.
int code_of_process_with(const char* variable) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::string program = "tests", list = "--gtest_list_tests", none = "--gtest_filter=None.*";
    char* arguments[]{program.data(), list.data(), none.data(), nullptr};
    ::unsetenv("GLIBC_TUNABLES");
    ::unsetenv("LD_PRELOAD");
    if (variable != nullptr) ::setenv(variable, "", 1);
    restart_with_large_pages(arguments);
    std::_Exit(returned);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  return WEXITSTATUS(status);
}

bool system_waits_to_be_asked() {
#ifdef __GLIBC__
  std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.find("[madvise]") != std::string::npos;
#else
  return false;
#endif
}

TEST(LargePages, StartTheProgramAgainWhereTheSystemWaitsToBeAsked) {
  EXPECT_EQ(code_of_process_with(nullptr), system_waits_to_be_asked() ? 0 : returned);
}

TEST(LargePages, LeaveAProgramAloneThatIsSetUpAlready) {
  EXPECT_EQ(code_of_process_with("GLIBC_TUNABLES"), returned);
  EXPECT_EQ(code_of_process_with("LD_PRELOAD"), returned);
}

}  // namespace
}  // namespace tenebra::base
