// A process that writes until it is killed.
#pragma once

#include <sys/wait.h>
#include <unistd.h>
#include <csignal>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

namespace tenebra::testing {

/// Runs `write`, which should not return, in a process of its own and kills that within 8 ms. False: it had
/// ended by itself. The delays follow from `random`, not the moments within a write.
inline bool kill_while_it_writes(std::mt19937& random, const std::function<void()>& write) {
  const pid_t writer = ::fork();
  if (writer == 0) {
    write();
    ::_exit(1);
  }
  std::this_thread::sleep_for(std::chrono::microseconds(random() % 8000));
  ::kill(writer, SIGKILL);
  int status = 0;
  ::waitpid(writer, &status, 0);
  return WIFSIGNALED(status);
}

}  // namespace tenebra::testing
