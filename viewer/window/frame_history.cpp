#include "window/frame_history.h"

#include <vector>

namespace tenebra::viewer {

Summary FrameHistory::total_ms() const {
  std::vector<double> totals;
  for (const FrameRecord& record : records_) totals.push_back(record.timings.total_ms);
  return summarize(totals);
}

}  // namespace tenebra::viewer
