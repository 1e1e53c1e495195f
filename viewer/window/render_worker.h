// The viewer's one other thread: loads scenes and computes pictures, so that the window never waits. It has
// its own OpenGL context, away from the window's.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "options/raster_options.h"
#include "window/frame_maker.h"

namespace tenebra::viewer {

struct WorkerStatus {
  bool loading = false;  ///< a scene
  bool drawing = false;  ///< a picture
  double elapsed_s = 0;  ///< of either
  bool slow = false;     ///< takes long, beside the frame before: time to show progress
  std::string stage;     ///< what takes long, where the method says so
  double done = 0;       ///< 0..1 of the stage
};

struct OpenedScene {
  SceneOptions options;
  Expected<std::shared_ptr<const ScenePlan>> scene;
};

/// What was finished since it was last asked for.
struct WorkerResults {
  std::vector<OpenedScene> opened;
  std::vector<std::shared_ptr<const Picture>> pictures;  ///< in order, none left out
  std::vector<std::optional<glm::vec3>> picked;
  std::vector<std::string> failures;     ///< sentences
  std::vector<std::string> gl_messages;  ///< complaints of a debug context
};

class RenderWorker {
public:
  /// `wake` is called on the worker's thread whenever there are new results.
  RenderWorker(const render::RasterChoice& raster, std::function<void()> wake);
  ~RenderWorker();  ///< stops what is under way and waits for it
  RenderWorker(const RenderWorker&) = delete;
  RenderWorker& operator=(const RenderWorker&) = delete;

  void open(SceneOptions options);
  /// Replaces an earlier request. A frame under way is finished first, so that dragging shows pictures,
  /// unless `at_once`, or it has taken longer than anyone dragging would wait (see stop_if_outdated).
  void request(FrameRequest request, bool at_once);
  void pick(glm::ivec2 pixel);  ///< asks for the visible point of a pixel of the last picture
  void cancel();                ///< drops the request and the frame under way
  /// To be called now and then: stops a frame that a newer request has made useless and that takes long.
  void stop_if_outdated();

  WorkerStatus status() const;
  WorkerResults take_results();
  RasterNames raster() const;

private:
  using Wall = AnimationClock::Wall;
  void run(const render::RasterChoice& raster);
  bool can_draw() const;
  void load(std::unique_lock<std::mutex>& lock);
  void draw(FrameMaker& maker, std::unique_lock<std::mutex>& lock);
  void finish(Expected<std::shared_ptr<Picture>> made, const FrameRequest& drawn, bool newly_asked);
  void publish(std::unique_lock<std::mutex>& lock);

  const std::function<void()> wake_;
  StopFlag stop_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::optional<SceneOptions> to_open_;
  std::optional<FrameRequest> request_;
  bool fresh_ = false;  // request_ has not been begun
  std::optional<glm::ivec2> to_pick_;
  bool quit_ = false;
  WorkerStatus status_;
  Wall begun_{};
  Wall last_picture_{};
  double last_frame_s_ = 0;
  RasterNames raster_;
  WorkerResults results_;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace tenebra::viewer
