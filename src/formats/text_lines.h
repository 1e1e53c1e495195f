// Lines, words and numbers of a text: OBJ, MTL, STL, PLY. Bytes, never characters: names may have any
// encoding.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tenebra::formats {

/// A line that says something: its first word, and what follows up to the end of the line, comments included.
struct Statement {
  std::string_view word;
  std::string_view rest;
  std::size_t line = 0;  ///< its number in the file, from 1; of a continued line the first
};

/// Goes through the statements of a text: lines end with LF, CR or both, a backslash at the end joins the
/// next line, empty lines and comments are passed over, and so is a byte order mark.
class TextLines {
public:
  /// `text` must outlive this.
  explicit TextLines(std::string_view text);

  /// The next statement, whose words are valid until the next call; false at the end.
  bool next(Statement& statement);

private:
  std::string_view take_line();

  std::string_view text_;
  std::string joined_;  ///< a continued line
  std::size_t line_ = 0;
};

/// Blank: between words.
inline bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Whether a word ends at the front of `rest`: nothing, a blank or a comment follows.
inline bool ends_word(std::string_view rest) {
  return rest.empty() || rest[0] == '#' || is_blank(rest[0]);
}

/// Passes over blanks; false: no word is left before the end or a comment.
inline bool skip_blanks(std::string_view& rest) {
  std::size_t blanks = 0;
  while (blanks < rest.size() && is_blank(rest[blanks])) ++blanks;
  rest.remove_prefix(blanks);
  return !rest.empty() && rest[0] != '#';
}

/// `text` without the blanks around it.
std::string_view trim(std::string_view text);

/// `text` up to a # that begins it or follows a blank, so that names may hold one; trimmed, without quotes
/// around it.
std::string_view without_comment(std::string_view text);

/// Takes the word at the front of `rest`, which ends before blanks and comments; empty: none is left.
std::string_view take_word(std::string_view& rest);

/// What take_number found.
enum class NumberFault { none, missing, decimal_comma, not_a_number };

/// Takes the number at the front of `rest`, to the nearest double; beyond its range infinity or zero. What is
/// not finite is a number too: inf, nan, and Microsoft's -1.#IND and its like, which become NaN. A decimal
/// comma is read as a point and reported; what is no number stays in `rest`.
NumberFault take_number(std::string_view& rest, double& value);

}  // namespace tenebra::formats
