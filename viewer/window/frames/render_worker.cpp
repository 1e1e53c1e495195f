#include "window/frames/render_worker.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "session/auto_exposure.h"
#include "window/frames/within_memory.h"

namespace tenebra::viewer {
namespace {

using Clock = std::chrono::steady_clock;

/// Pictures that may wait to be shown; more would only be late.
constexpr std::size_t most_waiting = 2;
// A user who drags sees a new picture at least this often where a frame takes less; longer frames are given
// up for the newest request.
constexpr double least_patience_s = 0.25;
constexpr double most_patience_s = 1.0;
// Frames that take as long as the one before show no progress: drawing it would take their processors.
constexpr double least_slow_s = 0.4;
constexpr double most_slow_s = 1.0;
// A preview that takes this many times what it may is stopped for a coarser one.
constexpr double most_overrun = 2.0;
// Requests that follow each other this closely come from a drag or a held key, which has ended when none has
// come for a while. Keys that are held repeat 25 to 30 times a second.
constexpr double moving_s = 0.25;
constexpr double rest_s = 0.06;
// A window that is hidden brings nothing to the screen: no picture waits longer for it.
constexpr double most_turn_s = 0.1;

double seconds(Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

RenderWorker::RenderWorker(const render::RasterChoice& raster, bool in_turns, std::function<void()> wake)
    : wake_(std::move(wake)), in_turns_(in_turns), thread_([this, raster] { run(raster); }) {}

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
  if (status_.drawing && task_.refines) stop_.request();
  changed_.notify_all();
}

void RenderWorker::request(FrameRequest request, bool at_once) {
  const std::lock_guard lock(mutex_);
  request_ = std::move(request);
  fresh_ = true;
  shown_.reset();
  asked_before_ = std::exchange(asked_, Clock::now());
  const bool gives_way = task_.refines || (at_once && !task_.hurries);
  if (status_.drawing && gives_way) stop_.request();
  changed_.notify_all();
}

void RenderWorker::pick(glm::dvec2 place) {
  const std::lock_guard lock(mutex_);
  to_pick_ = place;
  changed_.notify_all();
}

void RenderWorker::meter(std::shared_ptr<const session::StagedScene> scene, SceneOptions options) {
  const std::lock_guard lock(mutex_);
  to_meter_ = OpenedScene{std::move(options), std::move(scene)};
  changed_.notify_all();
}

void RenderWorker::cancel() {
  const std::lock_guard lock(mutex_);
  request_.reset();
  fresh_ = false;
  shown_.reset();
  if (status_.drawing) stop_.request();
}

void RenderWorker::stop_if_outdated() {
  const std::lock_guard lock(mutex_);
  if (!status_.drawing) return;
  const double took_s = seconds(Clock::now() - begun_);
  if (task_.hurries) {
    if (task_.coarsest || took_s <= most_overrun * budget_s_) return;
    overran_ = true;
    return stop_.request();
  }
  const double patience_s = std::clamp(2 * last_frame_s_, least_patience_s, most_patience_s);
  if (fresh_ && took_s > patience_s) stop_.request();
}

double RenderWorker::look_again_s() const {
  constexpr double least_s = 0.005, most_s = 0.1;
  const std::lock_guard lock(mutex_);
  if (!status_.drawing || !task_.hurries || task_.coarsest) return most_s;
  return std::clamp(most_overrun * budget_s_ - seconds(Clock::now() - begun_), least_s, most_s);
}

WorkerStatus RenderWorker::status() const {
  const std::lock_guard lock(mutex_);
  WorkerStatus status = status_;
  status.hurries = (status_.drawing && task_.hurries) || (fresh_ && request_ && request_->preview_ms > 0);
  if (status.loading || status.drawing) status.elapsed_s = seconds(Clock::now() - begun_);
  status.slow = status.elapsed_s > std::clamp(2 * last_frame_s_, least_slow_s, most_slow_s);
  return status;
}

void RenderWorker::presented() {
  const std::lock_guard lock(mutex_);
  if (!results_.pictures.empty()) return;
  unpresented_ = false;
  changed_.notify_all();
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

bool RenderWorker::has_room(Wall now) const {
  if (in_turns_ && unpresented_ && seconds(now - last_picture_) < most_turn_s) return false;
  return results_.pictures.size() < most_waiting;
}

bool RenderWorker::can_draw(Wall now) const {
  return request_ && (fresh_ || request_->clock.runs()) && has_room(now);
}

/// A preview is shown, and no drag or held key changes it.
bool RenderWorker::can_refine(Wall now) const {
  if (!request_ || !shown_ || fresh_ || !has_room(now)) return false;
  const bool moves = seconds(asked_ - asked_before_) < moving_s;
  return !moves || seconds(now - asked_) >= rest_s;
}

/// Frames that are counted one by one are whole.
bool RenderWorker::draws_previews() const {
  const bool counted = request_->record || (request_->clock.runs() && request_->clock.fixed_step());
  return request_->preview_ms > 0 && !counted;
}

RenderWorker::Task RenderWorker::next_task(PreviewTimes& times) {
  if (!draws_previews()) return {};
  if (!fresh_ && shown_) return {.level = times.refine(*shown_), .refines = true};
  const int level = times.choose(request_->preview_ms);
  return {.level = level, .hurries = true, .coarsest = level == times.coarsest()};
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
  auto planned = within_memory([&] { return session::stage_scene(options); }, [] {});
  OpenedScene opened{std::move(options), {}};
  if (planned) {
    opened.scene = std::make_shared<const session::StagedScene>(std::move(*planned));
  } else {
    opened.scene = tl::unexpected(planned.error());
  }
  lock.lock();
  status_ = {};
  results_.opened.push_back(std::move(opened));
  publish(lock);
}

void RenderWorker::meter_scene(std::unique_lock<std::mutex>& lock) {
  const OpenedScene asked = std::move(*to_meter_);
  to_meter_.reset();
  lock.unlock();
  auto exposures =
      within_memory([&] { return session::meter_exposures(**asked.scene, asked.options); }, [] {});
  lock.lock();
  results_.metered.push_back({*asked.scene, asked.options.edits, std::move(exposures)});
  publish(lock);
}

void RenderWorker::pick_place(FrameMaker& maker, std::unique_lock<std::mutex>& lock) {
  const glm::dvec2 place = *to_pick_;
  to_pick_.reset();
  lock.unlock();
  const auto point =
      within_memory([&]() -> Expected<std::optional<glm::vec3>> { return maker.visible_point(place); }, [] {})
          .value_or(std::nullopt);
  lock.lock();
  results_.picked.push_back(point);
  publish(lock);
}

void RenderWorker::draw(FrameMaker& maker, std::unique_lock<std::mutex>& lock) {
  begun_ = Clock::now();
  const FrameRequest& asked = *request_;
  PreviewTimes& times = memory_.of(
      preview_subject(asked.scene.get(), asked.a, asked.b.has_value(), asked.overlay != Overlay::none));
  task_ = next_task(times);
  budget_s_ = asked.preview_ms / 1e3;
  overran_ = false;
  if (!fresh_ && !task_.refines && request_->clock.fixed_step()) request_->clock.advance_frame();
  const bool newly_asked = fresh_ || task_.refines;
  const PreviewLevel level = times.levels()[static_cast<std::size_t>(task_.level)];
  const FrameRequest request = *request_;
  const bool over = request.clock.is_over(begun_);
  const double time_s = request.clock.time_at(begun_);
  fresh_ = false;
  status_ = {.drawing = true, .preview = task_.level > 0};
  stop_.reset();
  lock.unlock();

  const AoProgress progress = [this](std::string_view stage, double done) {
    const std::lock_guard guard(mutex_);
    status_.stage = stage;
    status_.done = done;
  };
  auto made = within_memory([&] { return maker.make(request, level, time_s, progress, stop_); },
                            [&] { maker.forget(); });
  if (auto recorded = record(made, request, over); !recorded) made = tl::unexpected(recorded.error());
  auto messages = maker.take_debug_messages();

  lock.lock();
  status_ = {};
  if (maker.raster() != nullptr) raster_ = raster_names(*maker.raster());
  std::move(messages.begin(), messages.end(), std::back_inserter(results_.gl_messages));
  if (over && !fresh_) request_.reset();
  finish(std::move(made), request, newly_asked, times);
  publish(lock);
}

/// The file is written beside the next picture; the last one, or one that is not recorded, waits for all
/// files.
Expected<void> RenderWorker::record(const Expected<std::shared_ptr<Picture>>& made,
                                    const FrameRequest& request, bool last) {
  if (made && request.record) {
    if (auto added = files_.add(request.record->file((*made)->a.record.frame), *made); !added) return added;
    if (!last) return {};
  }
  return files_.finish();
}

/// What was drawn is stopped or has failed, and something coarser takes its place.
void RenderWorker::give_up(PreviewTimes& times, bool asked_still, double took_ms) {
  overran_ ? times.overran(task_.level, took_ms) : times.failed(task_.level);
  if (asked_still && !task_.refines) fresh_ = true;
}

void RenderWorker::finish(Expected<std::shared_ptr<Picture>> made, const FrameRequest& drawn,
                          bool newly_asked, PreviewTimes& times) {
  const Wall now = Clock::now();
  const bool stopped = stop_.requested() && !made;
  const bool asked_still = request_ && request_->number == drawn.number;
  if (!made) {
    if (stopped && !overran_) return;
    // A preview by a method that this build or scene lacks is no failure: a failure of the whole picture is
    // reported.
    if (stopped || task_.level > 0) return give_up(times, asked_still, 1e3 * seconds(now - begun_));
    results_.failures.push_back(made.error().message);
    shown_.reset();
    if (!fresh_) request_.reset();
    return;
  }
  const Picture& picture = **made;
  times.drew(task_.level,
             picture.a.record.timings.total_ms + (picture.b ? picture.b->record.timings.total_ms : 0));
  shown_.reset();
  if (asked_still && task_.level > 0 && !drawn.clock.runs()) shown_ = task_.level;
  (*made)->request = drawn.number;
  (*made)->delay_ms = 1e3 * seconds(now - (newly_asked ? drawn.asked : last_picture_));
  last_picture_ = now;
  unpresented_ = true;
  if (task_.level == 0) last_frame_s_ = seconds(now - begun_);
  results_.pictures.push_back(std::move(*made));
}

void RenderWorker::wait(std::unique_lock<std::mutex>& lock) {
  const bool wanted = request_ && (fresh_ || request_->clock.runs());
  const bool time_will_do = (request_ && shown_) || (wanted && unpresented_);
  if (!time_will_do) return changed_.wait(lock);
  changed_.wait_for(lock, std::chrono::duration<double>(std::min(rest_s, most_turn_s) / 4));
}

void RenderWorker::run(const render::RasterChoice& raster) {
  FrameMaker maker(raster);
  std::unique_lock lock(mutex_);
  while (!quit_) {
    if (to_open_) {
      load(lock);
    } else if (to_meter_) {
      meter_scene(lock);
    } else if (to_pick_) {
      pick_place(maker, lock);
    } else if (const Wall now = Clock::now(); can_draw(now) || can_refine(now)) {
      draw(maker, lock);
    } else {
      wait(lock);
    }
  }
}

}  // namespace tenebra::viewer
