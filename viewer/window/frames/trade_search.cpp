#include "window/frames/trade_search.h"

#include <utility>

#include "trade/trade_choice.h"
#include "window/frames/frame_maker.h"

namespace tenebra::viewer {
namespace {

Expected<TradeResult> try_settings(const FrameRequest& request, const render::RasterChoice& raster,
                                   const TradeSearch::Progress& progress, const StopFlag& stop) {
  const double time_s = request.clock.time_at(request.asked);
  const Size size{request.a.width, request.a.height};
  TradeRequest trade;
  trade.scene = request.scene;
  trade.clip = request.clip;
  trade.frames = {{request.clock.frame_of(time_s), time_s}};
  trade.settings = request.a;
  trade.raster = raster;
  trade.edits = request.edits;
  trade.view = [&](double t) { return view_of_request(request, t, size); };
  trade.axes = axes_of(request.a, {});
  trade.aim_s = 30;  // the user waits for it
  return run_trade(trade, progress, stop);
}

}  // namespace

TradeSearch::Work trade_work(const render::RasterChoice& raster) {
  return [raster](TradeWork work, const TradeSearch::Progress& progress,
                  const StopFlag& stop) -> Expected<FoundTrade> {
    auto result = try_settings(work.request, raster, progress, stop);
    if (!result) return tl::unexpected(result.error());
    return FoundTrade{std::move(work.subject), std::move(*result)};
  };
}

}  // namespace tenebra::viewer
