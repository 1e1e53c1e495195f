// How much memory fields and surface samples take together. It is asked before memory is taken, and refuses
// what would exceed the limit; what was used least recently is dropped first to make room.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

namespace tenebra::ao {

/// When something that can be made again was last needed: by frames, then by objects, never by a clock.
struct LastUse {
  std::uint64_t frame = 0;
  int object = 0;
  auto operator<=>(const LastUse&) const = default;
};

/// For one thread at a time.
class MemoryBudget {
public:
  /// Gives back the memory of what was used least recently; false if all that is left is needed now.
  using DropOldest = std::function<bool()>;
  void set_drop(DropOldest drop) { drop_ = std::move(drop); }

  /// Makes room where more than `most` is held.
  void begin_frame(std::size_t most) {
    most_ = most;
    refused_ = false;
    make_room(0);
  }
  /// Whether `bytes` more are granted, for what the frame needs.
  bool take(std::size_t bytes) {
    const bool granted = offer(bytes);
    refused_ |= !granted;
    return granted;
  }
  /// The same for what the frame can do without: refused() does not count it.
  bool offer(std::size_t bytes) {
    if (!make_room(bytes)) return false;
    used_ += bytes;
    peak_ = std::max(peak_, used_);
    return true;
  }
  void give_back(std::size_t bytes) { used_ -= bytes; }

  std::size_t used() const { return used_; }
  std::size_t peak() const { return peak_; }
  bool refused() const { return refused_; }  ///< anything that was needed, in this frame

private:
  bool make_room(std::size_t bytes) {
    while (used_ > most_ || bytes > most_ - used_) {
      if (!drop_ || !drop_()) return false;
    }
    return true;
  }

  DropOldest drop_;
  std::size_t most_ = std::numeric_limits<std::size_t>::max();
  std::size_t used_ = 0, peak_ = 0;
  bool refused_ = false;
};

/// The part of a budget that one thing holds; given back when it is destroyed.
class MemoryShare {
public:
  MemoryShare() = default;
  explicit MemoryShare(MemoryBudget& budget) : budget_(&budget) {}
  MemoryShare(MemoryShare&& other) noexcept { swap(other); }
  MemoryShare& operator=(MemoryShare&& other) noexcept {
    swap(other);
    return *this;
  }
  ~MemoryShare() { give_back(bytes_); }

  bool take(std::size_t bytes) { return hold(bytes, budget_ == nullptr || budget_->take(bytes)); }
  bool offer(std::size_t bytes) { return hold(bytes, budget_ == nullptr || budget_->offer(bytes)); }
  void give_back(std::size_t bytes) {
    if (budget_ != nullptr) budget_->give_back(bytes);
    bytes_ -= bytes;
  }
  std::size_t bytes() const { return bytes_; }

private:
  bool hold(std::size_t bytes, bool granted) {
    if (granted) bytes_ += bytes;
    return granted;
  }
  void swap(MemoryShare& other) {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
  }
  MemoryBudget* budget_ = nullptr;  ///< null: there is no limit
  std::size_t bytes_ = 0;
};

}  // namespace tenebra::ao
