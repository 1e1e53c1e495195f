// The last frames of a method and what they took: the data of the cost panel.
#pragma once

#include <deque>

#include "base/statistics.h"
#include "render/log/frame_columns.h"

namespace tenebra::viewer {

class FrameHistory {
public:
  static constexpr std::size_t capacity = 240;

  void add(const render::FrameRecord& record) {
    if (records_.size() == capacity) records_.pop_front();
    records_.push_back(record);
  }
  void clear() { records_.clear(); }

  const std::deque<render::FrameRecord>& records() const { return records_; }  ///< oldest first
  base::Summary total_ms() const;                                              ///< of whole frames

private:
  std::deque<render::FrameRecord> records_;
};

}  // namespace tenebra::viewer
