// A picture's bytes from linear colours: an invocation makes four pixels, three words.
layout(std430, binding = 6) readonly buffer Colours { vec4 colours[]; };
layout(std430, binding = 5) writeonly buffer Bytes { uint words[]; };

uint levels_at(uint pixel) { return pixel < u_count ? levels_of(shown(colours[pixel].rgb)) : 0u; }

void main() {
  uint first = 4 * own_number();
  if (first >= u_count) return;
  uint a = levels_at(first), b = levels_at(first + 1), c = levels_at(first + 2), d = levels_at(first + 3);
  uint to = first / 4 * 3;
  words[to] = a | b << 24;
  words[to + 1] = b >> 8 | c << 16;
  words[to + 2] = c >> 16 | d << 8;
}
