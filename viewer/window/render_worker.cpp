#include "window/render_worker.h"

#include <algorithm>
#include <iterator>

namespace tenebra::viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// Pictures that may wait to be shown; more would only be late.
constexpr std::size_t most_waiting = 2;
// A hand that drags sees a new picture at least this often where a frame takes less; longer frames are given
// up for the newest request.
constexpr double least_patience_s = 0.25;
constexpr double most_patience_s = 1.0;
// Frames that take as long as the one before show no progress: drawing it would take their processors.
constexpr double least_slow_s = 0.4;
constexpr double most_slow_s = 1.0;

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

RenderWorker::RenderWorker(const render::RasterChoice& raster, std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this, raster] { run(raster); }) {}

RenderWorker::~RenderWorker() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
    stop_.request();
  }
  changed_.notify_all();
  thread_.join();
}

void RenderWorker::open(SceneOptions options) {
  const std::lock_guard lock(mutex_);
  to_open_ = std::move(options);
  changed_.notify_all();
}

void RenderWorker::request(FrameRequest request, bool at_once) {
  const std::lock_guard lock(mutex_);
  request_ = std::move(request);
  fresh_ = true;
  if (at_once && status_.drawing) stop_.request();
  changed_.notify_all();
}

void RenderWorker::pick(glm::ivec2 pixel) {
  const std::lock_guard lock(mutex_);
  to_pick_ = pixel;
  changed_.notify_all();
}

void RenderWorker::cancel() {
  const std::lock_guard lock(mutex_);
  request_.reset();
  fresh_ = false;
  if (status_.drawing) stop_.request();
}

void RenderWorker::stop_if_outdated() {
  const std::lock_guard lock(mutex_);
  const double patience_s = std::clamp(2 * last_frame_s_, least_patience_s, most_patience_s);
  if (status_.drawing && fresh_ && seconds(Clock::now() - begun_) > patience_s) stop_.request();
}

WorkerStatus RenderWorker::status() const {
  const std::lock_guard lock(mutex_);
  WorkerStatus status = status_;
  if (status.loading || status.drawing) status.elapsed_s = seconds(Clock::now() - begun_);
  status.slow = status.elapsed_s > std::clamp(2 * last_frame_s_, least_slow_s, most_slow_s);
  return status;
}

WorkerResults RenderWorker::take_results() {
  const std::lock_guard lock(mutex_);
  WorkerResults results;
  std::swap(results, results_);
  changed_.notify_all();
  return results;
}

RasterNames RenderWorker::raster() const {
  const std::lock_guard lock(mutex_);
  return raster_;
}

/// Something to draw, and room for it.
bool RenderWorker::can_draw() const {
  return request_ && (fresh_ || request_->clock.runs()) && results_.pictures.size() < most_waiting;
}

void RenderWorker::publish(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  wake_();
  lock.lock();
}

void RenderWorker::load(std::unique_lock<std::mutex>& lock) {
  SceneOptions options = std::move(*to_open_);
  to_open_.reset();
  status_ = {.loading = true, .stage = options.file};
  begun_ = Clock::now();
  lock.unlock();
  auto planned = plan_scene(options);
  OpenedScene opened{std::move(options), {}};
  if (planned) {
    opened.scene = std::make_shared<const ScenePlan>(std::move(*planned));
  } else {
    opened.scene = tl::unexpected(planned.error());
  }
  lock.lock();
  status_ = {};
  results_.opened.push_back(std::move(opened));
  publish(lock);
}

void RenderWorker::draw(FrameMaker& maker, std::unique_lock<std::mutex>& lock) {
  begun_ = Clock::now();
  if (!fresh_ && request_->clock.fixed_step()) request_->clock.advance_frame();
  const bool newly_asked = fresh_;
  const FrameRequest request = *request_;
  const bool over = request.clock.is_over(begun_);
  const double time_s = request.clock.time_at(begun_);
  fresh_ = false;
  status_ = {.drawing = true};
  stop_.reset();
  lock.unlock();

  const AoProgress progress = [this](std::string_view stage, double done) {
    const std::lock_guard guard(mutex_);
    status_.stage = stage;
    status_.done = done;
  };
  auto made = maker.make(request, time_s, progress, stop_);
  if (made && request.record) {
    if (auto written =
            base::write_png(request.record->file((*made)->a.record.frame), (*made)->a.result.image);
        !written)
      made = tl::unexpected(written.error());
  }
  auto messages = maker.take_debug_messages();

  lock.lock();
  status_ = {};
  if (maker.raster() != nullptr) raster_ = raster_names(*maker.raster());
  std::move(messages.begin(), messages.end(), std::back_inserter(results_.gl_messages));
  if (over && !fresh_) request_.reset();
  finish(std::move(made), request, newly_asked);
  publish(lock);
}

void RenderWorker::finish(Expected<std::shared_ptr<Picture>> made, const FrameRequest& drawn,
                          bool newly_asked) {
  const Wall now = Clock::now();
  const bool stopped = stop_.requested() && !made;
  if (!made) {
    if (stopped) return;
    results_.failures.push_back(made.error().message);
    if (!fresh_) request_.reset();
    return;
  }
  (*made)->request = drawn.number;
  (*made)->delay_ms = 1e3 * seconds(now - (newly_asked ? drawn.asked : last_picture_));
  last_picture_ = now;
  last_frame_s_ = seconds(now - begun_);
  results_.pictures.push_back(std::move(*made));
}

void RenderWorker::run(const render::RasterChoice& raster) {
  FrameMaker maker(raster);
  std::unique_lock lock(mutex_);
  while (!quit_) {
    if (to_open_) {
      load(lock);
    } else if (to_pick_) {
      const glm::ivec2 pixel = *to_pick_;
      to_pick_.reset();
      lock.unlock();
      const auto point = maker.visible_point(pixel.x, pixel.y);
      lock.lock();
      results_.picked.push_back(point);
      publish(lock);
    } else if (can_draw()) {
      draw(maker, lock);
    } else {
      changed_.wait(lock);
    }
  }
}

}  // namespace tenebra::viewer
