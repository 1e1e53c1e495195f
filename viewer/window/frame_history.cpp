#include "window/frame_history.h"

#include <vector>

namespace tenebra::viewer {

base::Summary FrameHistory::total_ms() const {
  std::vector<double> totals;
  for (const render::FrameRecord& record : records_) totals.push_back(record.timings.total_ms);
  return base::summarize(totals);
}

}  // namespace tenebra::viewer
