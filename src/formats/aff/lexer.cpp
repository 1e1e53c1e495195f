#include "formats/aff/lexer.h"

#include "base/fail.h"
#include "base/lower_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

namespace tenebra::formats {
namespace {

bool is_blank(char c) {
  constexpr char end_of_text = '\x1a';  // of files from DOS
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v' || c == end_of_text;
}
bool starts_comment(char c) {
  return c == '#' || c == '%';
}
bool is_brace(char c) {
  return c == '{' || c == '}';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// `word` without its sign, and whether it looks like a number at all (not "inf" or "nan").
bool looks_like_number(std::string_view word) {
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  if (!word.empty() && word[0] == '.') word.remove_prefix(1);
  return !word.empty() && is_digit(word[0]);
}

/// Whether `word` is what programs write for a number that is not finite: "-inf", "NaN", "-nan(ind)".
bool is_not_finite(std::string_view word) {
  if (!word.empty() && (word[0] == '+' || word[0] == '-')) word.remove_prefix(1);
  const std::string lower = base::lower_case(word.substr(0, 9));
  return lower == "nan" || lower.starts_with("nan(") || lower == "inf" || lower == "infinity";
}

}  // namespace

AffLexer::AffLexer(std::string_view text, std::string_view file_name, AffFaults& faults)
    : text_(text),
      file_name_(file_name),
      faults_(faults),
      position_(text.starts_with("\xEF\xBB\xBF") ? 3 : 0) {}

std::string quote_word(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string out = "'";
  for (const char c : text.substr(0, longest)) {
    const bool printable = c >= ' ' && c <= '~';
    printable ? out.push_back(c) : void(out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c)));
  }
  return out + (text.size() > longest ? "...'" : "'");
}

void AffLexer::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '\n') {
      ++line_;
    } else if (starts_comment(c)) {
      position_ = std::min(text_.find('\n', position_), text_.size());
      continue;
    } else if (!is_blank(c)) {
      return;
    }
    ++position_;
  }
}

std::string_view AffLexer::peek() {
  skip_blanks();
  if (position_ == text_.size()) return {};
  std::size_t end = position_;
  if (is_brace(text_[end])) return text_.substr(position_, 1);
  while (end < text_.size() && !is_blank(text_[end]) && !is_brace(text_[end]) &&
         !starts_comment(text_[end])) {
    ++end;
  }
  return text_.substr(position_, end - position_);
}

std::string_view AffLexer::word(std::string_view expected) {
  const std::string_view found = peek();
  word_line_ = line_;
  if (found.empty()) fail("the end of the file", expected);
  position_ += found.size();
  return found;
}

void AffLexer::expect(std::string_view keyword) {
  const std::string_view found = word(quote_word(keyword));
  if (found != keyword) fail(quote_word(found), quote_word(keyword));
}

double AffLexer::finite_number(std::string_view text, std::string_view expected) const {
  if (!looks_like_number(text)) fail(quote_word(text), expected);
  const std::string_view digits = text[0] == '+' ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size()) fail(quote_word(text), expected);
  if (error == std::errc::result_out_of_range) {
    if (digits.find("e-") == std::string_view::npos && digits.find("E-") == std::string_view::npos)
      fail(quote_word(text), expected);
    value = 0;  // too small to tell from zero
  }
  return value;
}

double AffLexer::number(std::string_view expected) {
  return finite_number(word(expected), expected);
}

glm::dvec3 AffLexer::vector(std::string_view expected) {
  const double x = number(expected);
  const double y = number(expected);
  return {x, y, number(expected)};
}

float AffLexer::real(std::string_view expected) {
  return static_cast<float>(number(expected));
}

bool AffLexer::next_is_look() {
  return looks_like_number(peek()) || is_not_finite(peek());
}

double AffLexer::look(std::string_view expected) {
  const std::string_view found = word(expected);
  if (looks_like_number(found) || !is_not_finite(found)) return finite_number(found, expected);
  warn(quote_word(found), expected, "made 0");
  return 0;
}

glm::dvec3 AffLexer::look_vector(std::string_view expected) {
  const double x = look(expected);
  const double y = look(expected);
  return {x, y, look(expected)};
}

std::int64_t AffLexer::integer(std::string_view expected) {
  const std::string_view found = word(expected);
  const std::string_view digits = found[0] == '+' ? found.substr(1) : found;
  std::int64_t value = 0;
  const char *const end = digits.data() + digits.size(), *read = digits.data();
  const auto [after, error] = std::from_chars(read, end, value);
  read = after;
  if (error == std::errc() && read != end && *read == '.')
    for (++read; read != end && *read == '0';) ++read;
  if (error != std::errc() || read != end) fail(quote_word(found), expected);
  return value;
}

std::size_t AffLexer::count(std::string_view expected) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  const std::int64_t value = integer(expected);
  if (value < 0 || value > most) fail(fmt::to_string(value), fmt::format("{} from 0 to {}", expected, most));
  return static_cast<std::size_t>(value);
}

std::uint32_t AffLexer::index(std::size_t size, std::string_view expected) {
  const std::int64_t value = integer(expected);
  if (value < 0 || static_cast<std::uint64_t>(value) >= size) {
    fail(fmt::to_string(value), fmt::format("{} below {}", expected, size));
  }
  return static_cast<std::uint32_t>(value);
}

std::uint32_t AffLexer::look_index(std::size_t size, std::string_view expected) {
  const std::int64_t value = integer(expected);
  if (value >= 0 && static_cast<std::uint64_t>(value) < size) return static_cast<std::uint32_t>(value);
  warn(fmt::to_string(value), fmt::format("{} below {}", expected, size), "left out");
  return static_cast<std::uint32_t>(size);
}

std::string AffLexer::place() const {
  return fmt::format("{}:{}", file_name_, word_line_);
}

void AffLexer::warn(std::string_view found, std::string_view expected, std::string_view made) {
  constexpr std::size_t most = 20;
  if (++faults_.count <= most)
    faults_.first.push_back(fmt::format("{}: found {}, expected {}; {}.", place(), found, expected, made));
}

void AffLexer::fail(std::string_view found, std::string_view expected) const {
  throw AffFailure{fmt::format("{}: found {}, expected {}.", place(), found, expected)};
}

}  // namespace tenebra::formats
