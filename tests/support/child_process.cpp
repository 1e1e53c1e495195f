#include "support/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <stdexcept>

namespace tenebra::testing {
namespace {

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
    read_end = ends[0];
    write_end = ends[1];
  }
  int read_end = -1;
  int write_end = -1;
};

/// Reads what there is; false at the end.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 65536> buffer{};
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0;
}

[[noreturn]] void start(const std::vector<std::string>& arguments, const Pipe& output, const Pipe& errors,
                        const std::function<void()>& prepare) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(output.write_end, STDOUT_FILENO);
  ::dup2(errors.write_end, STDERR_FILENO);
  if (prepare) prepare();
  std::vector<char*> pointers;
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  ::execv(pointers[0], pointers.data());
  ::_exit(127);
}

}  // namespace

int run_in_child(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return exit_code_of(status);
}

ChildProgram::ChildProgram(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  const Pipe output;
  const Pipe errors;
  child_ = ::fork();
  if (child_ == 0) start(arguments, output, errors, prepare);
  ::close(output.write_end);
  ::close(errors.write_end);
  output_ = output.read_end;
  errors_ = errors.read_end;
}

ChildProgram::~ChildProgram() {
  if (child_ > 0) {
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  if (output_ >= 0) ::close(output_);
  if (errors_ >= 0) ::close(errors_);
}

void ChildProgram::send(int signal) const {
  ::kill(child_, signal);
}

ProgramResult ChildProgram::wait(double timeout_s) {
  ProgramResult result;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  std::array<pollfd, 2> sources{pollfd{output_, POLLIN, 0}, pollfd{errors_, POLLIN, 0}};
  while (sources[0].fd >= 0 || sources[1].fd >= 0) {
    if (std::chrono::steady_clock::now() > end) send(SIGKILL);
    ::poll(sources.data(), sources.size(), 100);
    if (sources[0].revents != 0 && !read_some(output_, result.output)) sources[0].fd = -1;
    if (sources[1].revents != 0 && !read_some(errors_, result.errors)) sources[1].fd = -1;
  }
  int status = 0;
  ::waitpid(child_, &status, 0);
  child_ = -1;
  result.exit_code = exit_code_of(status);
  return result;
}

ProgramResult run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  return ChildProgram(arguments, prepare).wait();
}

}  // namespace tenebra::testing
