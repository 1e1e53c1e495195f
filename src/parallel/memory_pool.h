// A bound on what all threads hold together. It is asked before memory is taken.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>

namespace tenebra::parallel {

/// For any number of threads.
class MemoryPool {
public:
  /// To be called while nothing is held.
  void set_most(std::size_t most) { most_ = most; }
  std::size_t most() const { return most_; }
  bool take(std::size_t bytes) {
    std::size_t used = used_.load();
    do {
      if (bytes > most_ || used > most_ - bytes) return false;
    } while (!used_.compare_exchange_weak(used, used + bytes));
    return true;
  }
  void give_back(std::size_t bytes) { used_ -= bytes; }

private:
  std::size_t most_ = std::numeric_limits<std::size_t>::max();
  std::atomic<std::size_t> used_ = 0;
};

}  // namespace tenebra::parallel
