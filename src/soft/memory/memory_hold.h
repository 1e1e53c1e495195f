// The memory that candidates and trees of soft shadows take, all threads together. It is asked before memory
// is taken. What does not fit beside what other threads hold is put aside and done alone once they are done:
// so what a group gets does not depend on them, but on the bound alone.
#pragma once

#include <cstddef>

#include "parallel/memory_pool.h"

namespace tenebra::soft {

using parallel::MemoryPool;

/// Lists of candidates that wait to be solved take one part in so many of SoftShadowConfig::memory_bytes; the
/// pool has the rest.
inline constexpr std::size_t share_of_lists = 8;

/// What one thread holds of a pool: as much as its largest group so far needed, since its buffers stay as
/// large, until release().
class MemoryHold {
public:
  explicit MemoryHold(MemoryPool* pool) : pool_(pool) {}  ///< null: no bound
  MemoryHold(const MemoryHold&) = delete;
  MemoryHold& operator=(const MemoryHold&) = delete;
  ~MemoryHold() { release(); }

  /// Begins another group.
  void begin_group() { group_ = 0, refused_ = false; }
  /// Whether the group's candidates, and what is made of them, may take so many bytes more.
  bool add_candidates(std::size_t bytes) {
    group_ += bytes;
    return reach(candidates_, group_, group_);
  }
  /// Another group begins with what was taken before for all of a family.
  void back_to(std::size_t group_bytes) { group_ = group_bytes; }
  /// Whether its tree may take so many bytes. A vector that grows holds its old and its new memory, at most
  /// three times what is used.
  bool tree(std::size_t bytes) {
    const std::size_t needed = growing * bytes;
    return needed <= tree_ || reach(tree_, needed, needed + needed / 4);
  }
  /// The largest tree() that the group gets where no other thread holds anything.
  std::size_t largest_tree() const { return group_ < most() ? (most() - group_) / growing : 0; }

  bool refused() const { return refused_; }  ///< anything, to this group
  std::size_t group_bytes() const { return group_; }
  std::size_t bytes() const { return candidates_ + tree_; }
  std::size_t most() const { return pool_ != nullptr ? pool_->most() : ~std::size_t{0}; }
  void release() {
    if (pool_ != nullptr) pool_->give_back(bytes());
    candidates_ = tree_ = 0;
  }

private:
  static constexpr std::size_t growing = 3;

  /// Makes `held` at least `needed`, better `wanted`.
  bool reach(std::size_t& held, std::size_t needed, std::size_t wanted) {
    if (pool_ == nullptr || held >= needed) return true;
    for (const std::size_t to : {wanted, needed}) {
      if (!pool_->take(to - held)) continue;
      held = to;
      return true;
    }
    refused_ = true;
    return false;
  }

  MemoryPool* pool_;
  std::size_t candidates_ = 0, tree_ = 0;  ///< held
  std::size_t group_ = 0;                  ///< what the candidates of the group at hand take
  bool refused_ = false;
};

}  // namespace tenebra::soft
