// Code and programs in a child process: for limits, users and signals that must not touch the test itself.
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "support/patience.h"

namespace tenebra::testing {

/// Exit code of `body` in a forked child; 128 + signal if a signal ended it. The child runs no exit handlers.
int run_in_child(const std::function<int()>& body);

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal if a signal ended it
  std::string output;  ///< standard output
  std::string errors;  ///< standard error
};

/// A program started with `arguments` (the first is its path), output and errors caught, input empty. Signals
/// have their default actions.
class ChildProgram {
public:
  /// `prepare` runs in the child before the program starts.
  explicit ChildProgram(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
  ~ChildProgram();  ///< kills it if it still runs
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;

  void send(int signal) const;
  /// Waits until it ends; kills it after `timeout_s` seconds (exit code 128 + 9).
  ProgramResult wait(double timeout_s = 300 * patience);

private:
  pid_t child_ = -1;
  int output_ = -1;
  int errors_ = -1;
};

ProgramResult run_program(const std::vector<std::string>& arguments,
                          const std::function<void()>& prepare = {});

}  // namespace tenebra::testing
