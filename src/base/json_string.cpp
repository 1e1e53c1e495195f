#include "base/json_string.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

namespace tenebra::base {
namespace {

/// Length of the well-formed UTF-8 sequence at the start of `text` (RFC 3629); 0 if there is none.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  const auto continues = [&](std::size_t i) { return (byte(i) & 0xc0) == 0x80; };
  const int first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0 && continues(1)) return 2;
  const int second = byte(1);
  const bool second_is_short = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool second_is_beyond = (first == 0xed && second > 0x9f) || (first == 0xf4 && second > 0x8f);
  if (second_is_short || second_is_beyond || !continues(1) || !continues(2)) return 0;
  if (first >= 0xe0 && first < 0xf0) return 3;
  return first >= 0xf0 && first < 0xf5 && continues(3) ? 4 : 0;
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0) {
      json += '?';
    } else if (c == '"' || c == '\\') {
      json.append({'\\', c});
    } else if (static_cast<unsigned char>(c) < 0x20) {
      json += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      json.append(text.substr(0, length));
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return json + "\"";
}

}  // namespace tenebra::base
