// Settings tried on frames of a scene: how long they take and how far off they are.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shared/render_plan.h"
#include "trade/trade_settings.h"

namespace tenebra::viewer {

/// A setting that was drawn by itself, in a session of its own.
struct TradedSetting {
  TradePoint point;                  ///< ms: median over the frames; error: RMS over all of their pixels
  std::vector<double> frames_ms;     ///< of each frame that was timed: of slow ones not the first
  std::vector<double> frame_errors;  ///< of each, RMS, levels of 255
  double worst_error = 0;            ///< of the frame that is off most, RMS, levels of 255
  double first_frame_ms = 0;         ///< of a session that has drawn none
  double peak_mb =
      0;            ///< memory of the program while it was drawn, 2^20 bytes; 0 where the system does not say
  io::Image8 crop;  ///< of the frame in the middle
};

struct TradeResult {
  TradeAxes axes;
  std::vector<int> frames;              ///< that were drawn
  std::vector<TradedSetting> measured;  ///< from the quickest, not all of them on the front
  std::vector<std::size_t> front;       ///< of these
  double spread = 1;                    ///< errors of the worst frame of all, over the worst of `frames`
  io::Image8 reference_crop;            ///< of the finest setting
  int crop_x = 0, crop_y = 0;           ///< where the crops are, pixels
};

/// What is drawn and how often.
struct TradeRequest {
  std::shared_ptr<const session::StagedScene> scene;
  int clip = -1;
  std::vector<PlannedFrame> frames;
  std::vector<PlannedFrame> more_frames;  ///< not tried: two coarse settings give the spread on them
  render::RenderSettings settings;        ///< what all share, and what is no choice
  render::RasterChoice raster;
  stage::SceneEdits edits;
  std::function<ViewRays(double time_s)> view;
  TradeAxes axes;
  int repeats = 3;                ///< of each frame that is timed; slow ones fewer
  std::size_t most_measured = 8;  ///< settings that are drawn by themselves; at least 4
  double aim_s = 60;              ///< fewer settings are, where it would take longer
};

/// Sweeps each axis, predicts all settings from that, and measures those that promise to be worth it, the
/// standard one and the finest, against which errors are measured. `progress` gets what is done of the whole,
/// 0..1. Fails with "stopped" soon after `stop` is requested.
Expected<TradeResult> run_trade(const TradeRequest& request, const std::function<void(double)>& progress,
                                const StopFlag& stop);

/// The time that a frame takes with a setting: the median of five of `more_frames` at least, of more where by
/// `point.ms` there is time for them; without `more_frames`, of `frames`, again and again. Milliseconds.
Expected<double> time_setting(const TradeRequest& request, const TradePoint& point,
                              const std::function<void(double)>& progress, const StopFlag& stop);

}  // namespace tenebra::viewer
