// Tries settings on the present view, as `tenebra trade` does, on a thread of its own: the window goes on.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "options/settings_names.h"
#include "trade/trade_run.h"
#include "window/frames/frame_request.h"

namespace tenebra::viewer {

/// Equal where the same scene is seen by the same camera with the same edits.
struct ViewKey {
  const void* scene = nullptr;
  int clip = -1, camera = 0;
  std::optional<FreeCamera> free;  ///< none: the scene's camera
  stage::SceneEdits edits;
  std::optional<settings::AutoExposures> exposures;

  bool operator==(const ViewKey&) const = default;
};

/// What a search is made for: what a reader of its result compares with what is shown then.
struct TradeSubject {
  ViewKey view;
  double time_s = 0;
  Size place;
  MethodOptions method;  ///< without what is tried

  bool operator==(const TradeSubject&) const = default;
};

/// What was found on a view.
struct FoundTrade {
  TradeSubject subject;  ///< as it was given with the request
  TradeResult result;
};

struct TradeStatus {
  bool running = false;
  double done = 0;  ///< 0..1
  double elapsed_s = 0;
  std::shared_ptr<const FoundTrade> found;  ///< the last; null: none yet
};

class TradeSearch {
public:
  /// `wake` is called on the search's thread when it is over.
  TradeSearch(const render::RasterChoice& raster, std::function<void()> wake);
  ~TradeSearch();  ///< stops what is under way and waits for it
  TradeSearch(const TradeSearch&) = delete;
  TradeSearch& operator=(const TradeSearch&) = delete;

  /// Begins anew, at the time that the request's clock shows when it was asked.
  void begin(FrameRequest request, TradeSubject subject);
  void stop();  ///< soon; nothing is found
  TradeStatus status() const;
  /// Why the last search found nothing, once; empty: it was stopped, or it has found something.
  std::string take_failure();

private:
  struct Work {
    FrameRequest request;
    TradeSubject subject;
  };
  void run();
  Expected<TradeResult> search(const FrameRequest& request);

  const render::RasterChoice raster_;
  const std::function<void()> wake_;
  StopFlag stop_;

  mutable std::mutex mutex_;  // of all below
  std::condition_variable changed_;
  std::optional<Work> work_;
  TradeStatus status_;
  std::chrono::steady_clock::time_point begun_{};
  std::string failure_;
  bool quit_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace tenebra::viewer
