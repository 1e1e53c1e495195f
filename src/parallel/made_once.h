// Entries of a list that any thread makes when it first needs them, without waiting for another.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tenebra::parallel {

/// Which entries of a list are made. A thread that finds one missing makes its own copy; the one that may
/// claim() the entry stores it and calls publish(); from then on all see ready().
class MadeOnce {
public:
  /// None of `count` is made. Not while other threads ask.
  void reset(std::size_t count) {
    if (states_.size() != count) states_ = std::vector<std::atomic<std::uint8_t>>(count);
    for (std::atomic<std::uint8_t>& state : states_) state.store(missing, std::memory_order_relaxed);
  }
  bool ready(std::size_t i) const { return states_[i].load(std::memory_order_acquire) == made; }
  bool claim(std::size_t i) {
    std::uint8_t expected = missing;
    return states_[i].compare_exchange_strong(expected, claimed, std::memory_order_relaxed);
  }
  void publish(std::size_t i) { states_[i].store(made, std::memory_order_release); }

private:
  enum State : std::uint8_t { missing, claimed, made };
  std::vector<std::atomic<std::uint8_t>> states_;
};

}  // namespace tenebra::parallel
