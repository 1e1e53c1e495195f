// The viewer's thread that loads scenes and computes pictures, so that the window never waits. It has its own
// OpenGL context, away from the window's.
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
#include "window/frames/frame_maker.h"
#include "window/frames/picture_files.h"
#include "window/frames/preview_times.h"

namespace tenebra::viewer {

struct WorkerStatus {
  bool loading = false;  ///< a scene
  bool drawing = false;  ///< a picture
  bool preview = false;  ///< that is a preview
  bool hurries = false;  ///< a picture within the time for previews is under way, or about to be
  double elapsed_s = 0;  ///< of either
  bool slow = false;     ///< takes long, beside the frame before: time to show progress
  std::string stage;     ///< what takes long, where the method says so
  double done = 0;       ///< 0..1 of the stage
};

struct OpenedScene {
  SceneOptions options;
  Expected<std::shared_ptr<const session::StagedScene>> scene;
};

/// What an automatic exposure of this scene is, as edited.
struct MeteredScene {
  std::shared_ptr<const session::StagedScene> scene;
  stage::SceneEdits edits;
  Expected<settings::AutoExposures> exposures;
};

/// What was finished since it was last asked for.
struct WorkerResults {
  std::vector<OpenedScene> opened;
  std::vector<std::shared_ptr<const Picture>> pictures;  ///< in order, none left out
  std::vector<std::optional<glm::vec3>> picked;
  std::vector<MeteredScene> metered;
  std::vector<std::string> failures;     ///< sentences
  std::vector<std::string> gl_messages;  ///< complaints of a debug context
};

class RenderWorker {
public:
  /// `wake` is called on the worker's thread whenever there are new results. `in_turns`: the window draws on
  /// the same processors, so the next picture waits until the last is on the screen.
  RenderWorker(const render::RasterChoice& raster, bool in_turns, std::function<void()> wake);
  ~RenderWorker();  ///< stops what is under way and waits for it
  RenderWorker(const RenderWorker&) = delete;
  RenderWorker& operator=(const RenderWorker&) = delete;

  void open(SceneOptions options);
  /// Replaces an earlier request. Where a whole picture takes longer than FrameRequest::preview_ms a preview
  /// is drawn first, and refined until it is whole as long as no newer request comes. A preview under way is
  /// finished, so that a user who drags sees pictures; refining stops at once. Without previews a frame under
  /// way is finished, unless `at_once`, or it has taken longer than anyone dragging would wait.
  void request(FrameRequest request, bool at_once);
  /// Asks for what an automatic exposure is, with the edits of the options.
  void meter(std::shared_ptr<const session::StagedScene> scene, SceneOptions options);
  void pick(glm::dvec2 place);  ///< asks for what is seen at a place of the last picture, 0 to 1
  void cancel();                ///< drops the request and the frame under way
  /// To be called whenever look_again_s is over: stops what takes too long.
  void stop_if_outdated();
  double look_again_s() const;

  /// The pictures taken so far are on the screen.
  void presented();
  WorkerStatus status() const;
  WorkerResults take_results();
  RasterNames raster() const;

private:
  using Wall = AnimationClock::Wall;
  void run(const render::RasterChoice& raster);
  /// What is being drawn, and why.
  struct Task {
    int level = 0;          ///< of the preview_levels
    bool hurries = false;   ///< it must keep to the time for previews
    bool refines = false;   ///< a preview of the same request is shown
    bool coarsest = false;  ///< nothing quicker could take its place
  };
  bool has_room(Wall now) const;
  bool can_draw(Wall now) const;
  bool can_refine(Wall now) const;
  bool draws_previews() const;
  Task next_task(PreviewTimes& times);
  void wait(std::unique_lock<std::mutex>& lock);
  void load(std::unique_lock<std::mutex>& lock);
  void meter_scene(std::unique_lock<std::mutex>& lock);
  void pick_place(FrameMaker& maker, std::unique_lock<std::mutex>& lock);
  void draw(FrameMaker& maker, std::unique_lock<std::mutex>& lock);
  void finish(Expected<std::shared_ptr<Picture>> made, const FrameRequest& drawn, bool newly_asked,
              PreviewTimes& times);
  Expected<void> record(const Expected<std::shared_ptr<Picture>>& made, const FrameRequest& request,
                        bool last);
  void give_up(PreviewTimes& times, bool asked_still, double took_ms);
  void publish(std::unique_lock<std::mutex>& lock);

  const std::function<void()> wake_;
  const bool in_turns_;
  StopFlag stop_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::optional<SceneOptions> to_open_;
  std::optional<FrameRequest> request_;
  bool fresh_ = false;  // request_ has not been begun
  std::optional<glm::dvec2> to_pick_;
  std::optional<OpenedScene> to_meter_;
  bool quit_ = false;
  WorkerStatus status_;
  Task task_;                      // that is drawn
  double budget_s_ = 0;            // for it, if it hurries
  bool overran_ = false;           // it was stopped because it took too long
  std::optional<int> shown_;       // level of the preview of request_ that is shown, if it is not whole yet
  Wall asked_{}, asked_before_{};  // the last two requests
  bool unpresented_ = false;       // the last picture is not on the screen
  Wall begun_{};
  Wall last_picture_{};
  double last_frame_s_ = 0;
  RasterNames raster_;
  WorkerResults results_;

  PreviewMemory memory_;  // of the worker's thread alone
  PictureFiles files_;    // likewise
  std::thread thread_;    // last: it uses all of the above
};

}  // namespace tenebra::viewer
