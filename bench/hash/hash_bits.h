// Sixty-four bits that stand for many: XXH3 over the values as they lie in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace tenebra::bench {

/// Gathers values of types without padding; their order counts, and so does how many of them come in a span.
class BitHash {
public:
  BitHash();
  ~BitHash();
  BitHash(const BitHash&) = delete;
  BitHash& operator=(const BitHash&) = delete;

  template <class T>
  BitHash& add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(std::as_bytes(std::span(values)));
    return *this;
  }
  template <class T>
  BitHash& add_value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(std::as_bytes(std::span(&value, 1)));
    return *this;
  }
  std::uint64_t value() const;

private:
  void add_bytes(std::span<const std::byte> bytes);

  struct State;
  std::unique_ptr<State> state_;
};

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) {
  return BitHash().add(values).value();
}

}  // namespace tenebra::bench
