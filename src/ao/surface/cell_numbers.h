// Numbers of divided cells: a table of keys, quick enough to be searched for every point of a frame.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tenebra::ao {

class CellNumbers {
public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// `none` if the key was not added. Keys are below 2^63.
  std::uint32_t find(std::uint64_t key) const {
    if (slots_.empty()) return none;
    for (std::size_t at = home(key);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].key == key) return slots_[at].number;
      if (slots_[at].key == empty) return none;
    }
  }
  /// A new key with the next number, from 0 on.
  void add(std::uint64_t key) {
    if (keys_.size() == capacity_) reserve(std::max<std::size_t>(least, 2 * capacity_));
    insert(key, static_cast<std::uint32_t>(keys_.size()));
    keys_.push_back(key);
  }
  /// Room for this many keys: until there are more, add() takes no memory.
  void reserve(std::size_t count) {
    if (count <= capacity_) return;
    capacity_ = count;
    keys_.reserve(count);
    slots_.assign(slots_for(count), {});
    for (std::size_t i = 0; i < keys_.size(); ++i) insert(keys_[i], static_cast<std::uint32_t>(i));
  }
  std::size_t capacity() const { return capacity_; }
  const std::vector<std::uint64_t>& keys() const { return keys_; }  ///< by number
  std::size_t bytes() const { return bytes_for(capacity_); }
  static std::size_t bytes_for(std::size_t count) {
    return count == 0 ? 0 : slots_for(count) * sizeof(Slot) + count * sizeof(std::uint64_t);
  }

private:
  static constexpr std::uint64_t empty = ~std::uint64_t{0};
  static constexpr std::size_t least = 32;
  static std::size_t slots_for(std::size_t count) { return std::bit_ceil(count + count / 2 + 1); }
  struct Slot {
    std::uint64_t key = empty;
    std::uint32_t number = none;
  };
  std::size_t home(std::uint64_t key) const {  // the upper bits of the product: they mix all of the key's
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15u) >> (64 - std::countr_zero(slots_.size())));
  }
  void insert(std::uint64_t key, std::uint32_t number) {
    std::size_t at = home(key);
    while (slots_[at].key != empty) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = {key, number};
  }

  std::vector<Slot> slots_;  ///< a power of two; a third or more are empty
  std::vector<std::uint64_t> keys_;
  std::size_t capacity_ = 0;
};

}  // namespace tenebra::ao
