#include "shell/stop_signals.h"

#include <chrono>
#include <ctime>
#include <initializer_list>

namespace tenebra::viewer {

StopSignals::StopSignals() {
  sigemptyset(&held_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held_, signal);
  pthread_sigmask(SIG_BLOCK, &held_, &before_);
  watcher_ = std::jthread([this](const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      take();
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
    caught_ = signal;
    flag_.request();
  }
}

int StopSignals::caught() {
  take();
  return caught_;
}

}  // namespace tenebra::viewer
