// Words and numbers of an AFF text, with the line each stands on. Bytes, never characters: comments hold
// Latin-1.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/fail.h"

namespace tenebra::formats {

/// Thrown within the AFF importer only; import_aff turns it into an Error.
struct AffFailure {
  std::string message;
};

/// Faults that leave the geometry in no doubt: sentences on the first of them, and how many there were.
struct AffFaults {
  std::vector<std::string> first;
  std::size_t count = 0;
};

class AffLexer {
public:
  /// `text`, `file_name` (for messages, without folder) and `faults` must outlive the lexer. A byte order
  /// mark is no word.
  AffLexer(std::string_view text, std::string_view file_name, AffFaults& faults);

  /// The next word without taking it, empty at the end of the file. Braces are words of their own.
  std::string_view peek();
  /// Takes a word; `expected` names it for the message at the end of the file.
  std::string_view word(std::string_view expected);
  void expect(std::string_view keyword);

  double number(std::string_view expected);      ///< finite
  glm::dvec3 vector(std::string_view expected);  ///< three numbers
  float real(std::string_view expected);         ///< beyond the range of floats: infinite
  /// A number that only looks depend on: one that is not finite is a fault, and 0.
  double look(std::string_view expected);
  glm::dvec3 look_vector(std::string_view expected);
  bool next_is_look();                              ///< whether look() would read the next word
  std::int64_t integer(std::string_view expected);  ///< "3.0" is one too
  /// A count or size: 0 or more. Says nothing about what follows: see most_numbers_left.
  std::size_t count(std::string_view expected);
  /// An index below `size`.
  std::uint32_t index(std::size_t size, std::string_view expected);
  /// The same for what only looks depend on: any other is a fault, and `size`.
  std::uint32_t look_index(std::size_t size, std::string_view expected);

  /// No more numbers than this can follow: the bound for reserving by a count in the file.
  std::size_t most_numbers_left() const { return (text_.size() - position_) / 2 + 1; }
  int line() const { return word_line_; }  ///< of the last word taken
  std::string_view file_name() const { return file_name_; }
  std::string place() const;  ///< "file.aff:12" of the last word taken
  /// Adds a fault: what was `made` of it goes behind what was expected.
  void warn(std::string_view found, std::string_view expected, std::string_view made);
  [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

private:
  void skip_blanks();
  double finite_number(std::string_view text, std::string_view expected) const;

  std::string_view text_;
  std::string_view file_name_;
  AffFaults& faults_;
  std::size_t position_ = 0;
  int line_ = 1;
  int word_line_ = 1;
};

/// `text` in quotes for a message: cut at 40 bytes, other bytes than printable ASCII as \xNN.
std::string quote_word(std::string_view text);

}  // namespace tenebra::formats
