// A bound on what all threads hold together, by what each piece of work is known to need.
#pragma once

#include <atomic>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>

namespace tenebra::parallel {

/// Work that needs no more than its thread's part of an eighth of the bound is done at any time, work that
/// needs more one after the other, and what needs more than three quarters is refused. The last eighth is the
/// caller's. What is refused follows from the bound and the work, not from the threads.
class MemoryBound {
public:
  /// Nothing is held, and nothing refused. No bound: everything is done at any time.
  void begin(std::optional<std::size_t> bytes, std::size_t threads) {
    constexpr std::size_t any = std::numeric_limits<std::size_t>::max();
    beside_ = bytes ? *bytes / 8 / threads : any;
    alone_ = bytes ? *bytes - *bytes / 4 : any;
    refused_ = 0;
  }

  std::size_t most_alone() const { return alone_; }
  /// Calls `work`, which needs so many bytes and starts no parallel loop, in its turn, and `release`, which
  /// gives back buffers, after one that was large. Neither, once anything was refused.
  template <class Work, class Release>
  void run(std::size_t bytes, const Work& work, const Release& release) {
    if (bytes > alone_) return refuse(bytes);
    if (refused_ > 0) return;
    if (bytes <= beside_) return work();
    const std::scoped_lock turn(one_large_);
    if (refused_ > 0) return;
    work();
    release();
  }

  /// The bound that the largest of what was refused needs; 0: nothing was.
  std::size_t least_bound() const { return (refused_ + 2) / 3 * 4; }

private:
  void refuse(std::size_t bytes) {
    std::size_t most = refused_;
    while (most < bytes && !refused_.compare_exchange_weak(most, bytes)) {
    }
  }

  std::size_t beside_ = 0, alone_ = 0;
  std::atomic<std::size_t> refused_ = 0;
  std::mutex one_large_;
};

}  // namespace tenebra::parallel
