// Numbers as text.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace tenebra::base {

/// The number that the whole word is, by no locale; none for anything else, and beyond the range of `T`.
template <class T>
std::optional<T> number_in(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

/// The same but for infinities and NaN.
inline std::optional<double> finite_in(std::string_view word) {
  const auto value = number_in<double>(word);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace tenebra::base
