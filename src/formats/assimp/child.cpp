#include "formats/assimp/child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void cannot_start(const std::filesystem::path& program, int error) {
  refuse("cannot start {} ({})", program.string(), std::generic_category().message(error));
}

/// Both ends of a pipe; -1: closed.
struct Pipe {
  int out = -1, in = -1;

  explicit Pipe(const std::filesystem::path& program) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) cannot_start(program, errno);
    out = ends[0];
    in = ends[1];
  }
  ~Pipe() {
    close_end(out);
    close_end(in);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  static void close_end(int& end) {
    if (end >= 0) close(end);
    end = -1;
  }
};

struct SpawnActions {
  posix_spawn_file_actions_t actions{};
  SpawnActions() { posix_spawn_file_actions_init(&actions); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;
};

/// A process that is killed, if it still runs, where this ends.
class Child {
public:
  Child(const std::filesystem::path& program, const std::vector<std::string>& words, const Pipe& output,
        const Pipe& errors) {
    std::vector<char*> arguments{const_cast<char*>(program.c_str())};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    SpawnActions start;
    posix_spawn_file_actions_addopen(&start.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&start.actions, output.in, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&start.actions, errors.in, STDERR_FILENO);
    posix_spawn_file_actions_addclosefrom_np(&start.actions, STDERR_FILENO + 1);
    const int error = posix_spawn(&id_, program.c_str(), &start.actions, nullptr, arguments.data(), environ);
    if (error != 0) cannot_start(program, error);
  }
  ~Child() {
    if (runs()) stop();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  bool runs() { return !ended_ && !wait(WNOHANG); }
  void stop() {
    kill(id_, SIGKILL);
    wait(0);
  }
  int status() const { return status_; }  ///< as waitpid gives it; 0 where another part of the program waited

private:
  bool wait(int options) {
    pid_t found = 0;
    do found = waitpid(id_, &status_, options);
    while (found < 0 && errno == EINTR);
    return ended_ = found != 0;
  }

  pid_t id_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

/// Reads what is there; closes the pipe at its end. Keeps at most `most` bytes; whether there were no more.
bool read_some(Pipe& pipe, std::size_t most, std::string& bytes) {
  std::array<char, 65536> part;
  const ssize_t count = read(pipe.out, part.data(), part.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return true;
  if (count <= 0) {
    Pipe::close_end(pipe.out);
    return true;
  }
  const std::size_t kept = std::min(static_cast<std::size_t>(count), most - bytes.size());
  bytes.append(part.data(), kept);
  return kept == static_cast<std::size_t>(count);
}

/// Reads both pipes to their ends and waits; how it ended otherwise.
ChildResult::End follow(Child& child, Pipe& output, Pipe& errors, const ChildLimits& limits,
                        ChildResult& result) {
  const auto end = Clock::now() + limits.time;
  constexpr std::size_t most_errors = 65536;
  constexpr int step_ms = 100;
  while (output.out >= 0 || errors.out >= 0) {
    if (Clock::now() >= end) return ChildResult::End::too_long;
    std::array<pollfd, 2> ends{pollfd{output.out, POLLIN, 0}, pollfd{errors.out, POLLIN, 0}};
    if (poll(ends.data(), ends.size(), step_ms) <= 0) continue;
    if (ends[0].revents != 0 && !read_some(output, limits.output_bytes, result.output))
      return ChildResult::End::too_much;
    if (ends[1].revents != 0) read_some(errors, most_errors, result.errors);
  }
  while (child.runs()) {
    if (Clock::now() >= end) return ChildResult::End::too_long;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return WIFSIGNALED(child.status()) ? ChildResult::End::signal : ChildResult::End::exit;
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program, const std::vector<std::string>& words,
                      const ChildLimits& limits) {
  Pipe output(program), errors(program);
  Child child(program, words, output, errors);
  Pipe::close_end(output.in);
  Pipe::close_end(errors.in);
  ChildResult result;
  result.end = follow(child, output, errors, limits, result);
  result.number =
      result.end == ChildResult::End::signal ? WTERMSIG(child.status()) : WEXITSTATUS(child.status());
  return result;
}

}  // namespace tenebra::formats
