#include "window/frames/trade_search.h"

#include <utility>

#include "trade/trade_choice.h"
#include "window/frames/frame_maker.h"
#include "window/frames/within_memory.h"

namespace tenebra::viewer {

TradeSearch::TradeSearch(const render::RasterChoice& raster, std::function<void()> wake)
    : raster_(raster), wake_(std::move(wake)), thread_([this] { run(); }) {}

TradeSearch::~TradeSearch() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    stop_.request();
  }
  changed_.notify_all();
  thread_.join();
}

void TradeSearch::begin(FrameRequest request, TradeSubject subject) {
  const std::lock_guard lock(mutex_);
  work_ = Work{std::move(request), std::move(subject)};
  failure_.clear();
  begun_ = std::chrono::steady_clock::now();
  if (status_.running) stop_.request();
  changed_.notify_all();
}

void TradeSearch::stop() {
  const std::lock_guard lock(mutex_);
  work_.reset();
  if (status_.running) stop_.request();
}

TradeStatus TradeSearch::status() const {
  const std::lock_guard lock(mutex_);
  TradeStatus status = status_;
  status.running = status_.running || work_;
  if (status.running)
    status.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  return status;
}

std::string TradeSearch::take_failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, {});
}

Expected<TradeResult> TradeSearch::search(const FrameRequest& request) {
  const double time_s = request.clock.time_at(request.asked);
  const Size size{request.a.width, request.a.height};
  TradeRequest trade;
  trade.scene = request.scene;
  trade.clip = request.clip;
  trade.frames = {{request.clock.frame_of(time_s), time_s}};
  trade.settings = request.a;
  trade.raster = raster_;
  trade.edits = request.edits;
  trade.view = [&](double t) { return view_of_request(request, t, size); };
  trade.axes = axes_of(request.a, {});
  trade.aim_s = 30;  // the user waits for it
  const auto progress = [this](double done) {
    const std::lock_guard lock(mutex_);
    status_.done = done;
  };
  return run_trade(trade, progress, stop_);
}

void TradeSearch::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return quit_ || work_; });
    if (quit_) return;
    Work work = std::move(*work_);
    work_.reset();
    status_.running = true;
    status_.done = 0;
    stop_.reset();
    lock.unlock();
    auto result = within_memory([&] { return search(work.request); }, [] {});
    lock.lock();
    status_.running = false;
    if (result)
      status_.found = std::make_shared<FoundTrade>(FoundTrade{std::move(work.subject), std::move(*result)});
    else if (!stop_.requested())
      failure_ = result.error().message;
    lock.unlock();
    wake_();
    lock.lock();
  }
}

}  // namespace tenebra::viewer
