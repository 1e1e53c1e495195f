// The last frames of a method and what they took: the data of the cost panel.
#pragma once

#include <deque>

#include "base/frame_columns.h"
#include "base/statistics.h"

namespace tenebra::viewer {

class FrameHistory {
public:
  static constexpr std::size_t capacity = 240;

  void add(const FrameRecord& record) {
    if (records_.size() == capacity) records_.pop_front();
    records_.push_back(record);
  }
  void clear() { records_.clear(); }

  const std::deque<FrameRecord>& records() const { return records_; }  ///< oldest first
  Summary total_ms() const;                                            ///< of whole frames

private:
  std::deque<FrameRecord> records_;
};

}  // namespace tenebra::viewer
