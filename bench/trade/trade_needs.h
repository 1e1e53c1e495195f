// Parts of the part `needs` of `tenebra-bench trade`.
#pragma once

#include "bench/common/bench_frame.h"
#include "bench/trade/trade_session.h"

namespace tenebra::bench {

/// Every coordinate moved by the smallest step of a float.
FrameGeometry nudged(FrameGeometry geometry);

/// Fields only of objects that can occlude something visible, built when they first do; samples of surfaces
/// where they are seen; look-ups of what is in reach.
Expected<void> need_fields(TradeSession& session, const std::string& name, const Scene& scene,
                           const BenchFrame& frame);

}  // namespace tenebra::bench
