// Loops that a stop ends.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include <tenebra/stop_flag.h>

namespace tenebra::base {

inline constexpr std::size_t look_after = 4096;  ///< steps of a loop between two looks at a flag

/// Calls body(i) for i in [first, last) in order, until `stop` is requested: false, without the calls that
/// were left.
template <class Body>
bool each_until_stopped(std::size_t first, std::size_t last, const StopFlag* stop, const Body& body) {
  while (first < last) {
    if (stop_requested(stop)) return false;
    for (const std::size_t end = std::min(last, first + look_after); first < end; ++first) body(first);
  }
  return true;
}

/// list.resize(size), until `stop` is requested: false. Memory costs most when it is written to for the first
/// time; with a large list that takes too long to wait for.
template <class Value>
bool resize_until_stopped(std::vector<Value>& list, std::size_t size, const StopFlag* stop) {
  list.reserve(size);
  while (list.size() < size) {
    if (stop_requested(stop)) return false;
    list.resize(std::min(size, list.size() + look_after));
  }
  list.resize(size);
  return true;
}

/// Makes `to` a copy of `from`, until `stop` is requested: false.
template <class Value>
bool copy_until_stopped(std::span<const Value> from, std::vector<Value>& to, const StopFlag* stop) {
  to.clear();
  to.reserve(from.size());
  while (to.size() < from.size()) {
    if (stop_requested(stop)) return false;
    const auto more = from.subspan(to.size(), std::min(look_after, from.size() - to.size()));
    to.insert(to.end(), more.begin(), more.end());
  }
  return true;
}

}  // namespace tenebra::base
