#include "stop_signals.h"

#include <ctime>
#include <initializer_list>

namespace tenebra::viewer {

StopSignals::StopSignals() {
  sigemptyset(&held_);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held_, signal);
  pthread_sigmask(SIG_BLOCK, &held_, &before_);
}

StopSignals::~StopSignals() {
  caught();  // taken here, so that lifting the mask does not end the program
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

int StopSignals::caught() {
  const timespec at_once{};
  for (int signal = 0; (signal = sigtimedwait(&held_, nullptr, &at_once)) > 0;) caught_ = signal;
  return caught_;
}

}  // namespace tenebra::viewer
