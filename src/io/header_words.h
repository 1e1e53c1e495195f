// Words and numbers in the headers of pictures.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace tenebra::io {

/// Takes the next word and the one blank behind it off `text`; empty: none is left.
inline std::string_view take_header_word(std::string_view& text, std::string_view blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(std::min(word.size() + 1, text.size()));
  return word;
}

/// The number that the whole word is; none for anything else, and beyond the range of `T`.
template <class T>
std::optional<T> number_in(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

}  // namespace tenebra::io
