#include "shell/stop_signals.h"

#include <unistd.h>

#include <atomic>
#include <ctime>
#include <initializer_list>
#include <string_view>

#include "shell/exit_codes.h"

namespace tenebra::viewer {
namespace {

/// So that everything ends within a second: to give back a few GB takes the system some tenths of it.
constexpr std::chrono::milliseconds patience{500};

/// Whatever other threads do, and without their destructors: they may be blocked.
[[noreturn]] void end_at_once(int code) {
  static std::atomic_flag ending;
  if (ending.test_and_set())
    for (;;) ::pause();  // the other thread that came here ends this one too
  const std::string_view why = code == exit_codes::timed_out
                                   ? "tenebra: stopped, as the time of --timeout is up.\n"
                                   : "tenebra: stopped at once.\n";
  static_cast<void>(!::write(STDERR_FILENO, why.data(), why.size()));
  ::_exit(code);
}

}  // namespace

StopSignals::StopSignals(double timeout_s, Start start)
    : timeout_s_(timeout_s), orderly_(start == Start::orderly) {
  sigemptyset(&held_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held_, signal);
  pthread_sigmask(SIG_BLOCK, &held_, &before_);
  watcher_ = std::jthread([this](const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      take();
      watch_time();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
}

StopSignals::~StopSignals() {
  watcher_.request_stop();
  watcher_.join();
  take();  // so that lifting the mask does not end the program
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

void StopSignals::take() {
  const timespec at_once{};
  for (int signal = 0; (signal = sigtimedwait(&held_, nullptr, &at_once)) > 0;) {
    if (caught_ != 0) end_at_once(exit_codes::of_signal(signal));
    caught_ = signal;
    request(exit_codes::of_signal(signal));
  }
}

void StopSignals::watch_time() {
  const Clock::duration now = Clock::now() - begin_;
  if (code_ == 0 && std::chrono::duration<double>(now).count() >= timeout_s_) request(exit_codes::timed_out);
  if (now.count() > last_moment_) end_at_once(code_);
}

void StopSignals::request(int code) {
  if (!orderly_) end_at_once(code);
  int none = 0;
  if (code_.compare_exchange_strong(none, code))
    last_moment_ = (Clock::now() - begin_ + Clock::duration(patience)).count();
  flag_.request();
}

int StopSignals::caught() {
  take();
  return caught_;
}

int StopSignals::exit_code() {
  take();
  return code_;
}

}  // namespace tenebra::viewer
