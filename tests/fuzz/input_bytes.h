// A fuzzer's bytes, taken one after the other: zeros where they end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

namespace tenebra::fuzz {

class InputBytes {
public:
  InputBytes(const std::uint8_t* bytes, std::size_t size) : next_(bytes), end_(bytes + size) {}

  bool empty() const { return next_ == end_; }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : *next_++; }
  /// 0 .. count - 1
  int below(int count) { return byte() % count; }
  /// -128 .. 127 in each direction, times `unit`: few values, so that edges and planes meet often.
  glm::vec3 vector(float unit) {
    const auto value = [&] { return unit * static_cast<float>(static_cast<std::int8_t>(byte())); };
    const float x = value(), y = value(), z = value();
    return {x, y, z};
  }

private:
  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

}  // namespace tenebra::fuzz
