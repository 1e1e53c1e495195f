#include "formats/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>

namespace tenebra::formats {
namespace {

/// A number out of the range of doubles: infinity, or zero where it is too small. Which of them says the
/// decimal place of its first digit that is not 0.
double out_of_range(std::string_view number) {
  const std::string_view digits = number.substr(0, number.find_first_of("eE"));
  std::string_view exponent = number.substr(std::min(digits.size() + 1, number.size()));
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t place = 0;
  const auto [end, error] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), place);
  constexpr std::int64_t beyond = std::int64_t{1} << 62;  // any number of digits
  if (error == std::errc::result_out_of_range) place = exponent.starts_with('-') ? -beyond : beyond;
  const std::size_t point = std::min(digits.find('.'), digits.size());
  place += static_cast<std::int64_t>(point) - static_cast<std::int64_t>(digits.find_first_of("123456789"));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  return place < 0 ? 0 : number.starts_with('-') ? -infinity : infinity;
}

/// -1.#IND and its like: a # that belongs to a number.
bool is_microsoft_nan(const char* at, const char* stop, const char* end) {
  return stop != at && stop != end && stop[-1] == '.' && *stop == '#' && stop + 1 != end && stop[1] >= 'A' &&
         stop[1] <= 'Z';
}

}  // namespace

TextLines::TextLines(std::string_view text) : text_(text) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);
}

std::string_view TextLines::take_line() {
  const auto ends_line = [](char c) { return c == '\n' || c == '\r'; };
  const auto end =
      static_cast<std::size_t>(std::find_if(text_.begin(), text_.end(), ends_line) - text_.begin());
  const std::string_view line = text_.substr(0, end);
  const bool both = text_.substr(end).starts_with("\r\n");
  text_.remove_prefix(std::min(text_.size(), end + (both ? 2 : 1)));
  ++line_;
  return line;
}

bool TextLines::next(Statement& statement) {
  while (!text_.empty()) {
    std::string_view line = trim(take_line());
    statement.line = line_;
    if (line.empty() || line[0] == '#') continue;
    if (line.back() == '\\') {
      joined_.clear();
      for (; line.ends_with('\\') && !text_.empty(); line = trim(take_line()))
        joined_.append(line.substr(0, line.size() - 1)).push_back(' ');
      line = joined_.append(line);
    }
    statement.rest = line;
    statement.word = take_word(statement.rest);
    statement.rest = trim(statement.rest);
    if (!statement.word.empty()) return true;
  }
  return false;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view without_comment(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '#' && (i == 0 || is_blank(text[i - 1]))) text = text.substr(0, i);
  text = trim(text);
  const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::string_view take_word(std::string_view& rest) {
  skip_blanks(rest);
  std::size_t size = 0;
  while (!ends_word(rest.substr(size))) ++size;
  const std::string_view word = rest.substr(0, size);
  rest.remove_prefix(size);
  return word;
}

NumberFault take_number(std::string_view& rest, double& value) {
  if (!skip_blanks(rest)) return NumberFault::missing;
  const char *const at = rest.data() + (rest[0] == '+' ? 1 : 0), *const end = rest.data() + rest.size();
  const auto [stop, error] = std::from_chars(at, end, value);
  if (error == std::errc::invalid_argument) return NumberFault::not_a_number;
  if (error == std::errc::result_out_of_range) value = out_of_range({at, stop});
  const std::string_view behind(stop, static_cast<std::size_t>(end - stop));
  if (is_microsoft_nan(at, stop, end)) {
    value = std::numeric_limits<double>::quiet_NaN();
    rest = {std::find_if(stop, end, is_blank), end};
    return NumberFault::none;
  }
  if (ends_word(behind)) {
    rest = behind;
    return NumberFault::none;
  }
  if (*stop != ',') return NumberFault::not_a_number;
  std::string_view after = rest;
  std::string word(take_word(after));
  std::replace(word.begin(), word.end(), ',', '.');
  const char* const word_end = word.data() + word.size();
  if (std::from_chars(word.data(), word_end, value).ptr != word_end) return NumberFault::not_a_number;
  rest = after;
  return NumberFault::decimal_comma;
}

}  // namespace tenebra::formats
