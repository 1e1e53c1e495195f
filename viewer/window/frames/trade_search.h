// Tries settings on the present view, as `tenebra trade` does, on a thread of its own: the window goes on.
#pragma once

#include <optional>

#include "options/settings_names.h"
#include "trade/trade_run.h"
#include "window/frames/frame_request.h"
#include "window/frames/one_job.h"

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

/// What is tried, and for what.
struct TradeWork {
  FrameRequest request;  ///< the time is what its clock shows when it was asked
  TradeSubject subject;
};

using TradeStatus = JobStatus<FoundTrade>;
using TradeSearch = OneJob<TradeWork, FoundTrade>;

/// The work of a search, on contexts of `raster`.
TradeSearch::Work trade_work(const render::RasterChoice& raster);

}  // namespace tenebra::viewer
