#include <array>

#include "shadow/shadow_rays.h"

namespace tenebra {

namespace {

// The curve as an automaton over the bits of x and y, highest first. State: bit 0 x and y are swapped from here
// on, bit 1 both are complemented.
struct Step {
  int digit;
  int next;
};
constexpr Step step(int state, int x, int y) {
  const int complement = state >> 1;
  const int rx = ((state & 1) ? y : x) ^ complement, ry = ((state & 1) ? x : y) ^ complement;
  return {(3 * rx) ^ ry, ry != 0 ? state : state ^ (rx != 0 ? 3 : 1)};
}

constexpr int bits = 14;
constexpr int digits_at_once = 2;  // levels of the curve per table look-up
constexpr int entries = 1 << (2 * digits_at_once);

struct Jump {
  std::uint8_t digits;
  std::uint8_t next;
};
constexpr auto jumps = [] {
  std::array<std::array<Jump, entries>, 4> table{};
  for (int state = 0; state < 4; ++state) {
    for (int i = 0; i < entries; ++i) {  // i: x bits, then y bits
      int s = state, digits = 0;
      for (int level = digits_at_once - 1; level >= 0; --level) {
        const int x = (i >> (digits_at_once + level)) & 1, y = (i >> level) & 1;
        const Step taken = step(s, x, y);
        digits = digits * 4 + taken.digit;
        s = taken.next;
      }
      table[state][i] = {static_cast<std::uint8_t>(digits), static_cast<std::uint8_t>(s)};
    }
  }
  return table;
}();

}  // namespace

std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t field = (1u << digits_at_once) - 1;
  std::uint32_t index = 0;
  int state = 0;
  for (int shift = bits - digits_at_once; shift >= 0; shift -= digits_at_once) {
    const Jump jump = jumps[state][((x >> shift) & field) << digits_at_once | ((y >> shift) & field)];
    index = index << (2 * digits_at_once) | jump.digits;
    state = jump.next;
  }
  return index;
}

}  // namespace tenebra
