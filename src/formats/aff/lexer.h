// Words and numbers of an AFF text, with the line each stands on. Bytes, never characters: comments hold
// Latin-1.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "base/fail.h"

namespace tenebra::formats {

/// Thrown within the AFF importer only; import_aff turns it into an Error.
struct AffFailure {
  std::string message;
};

class AffLexer {
public:
  /// `text` and `file_name` (for messages, without folder) must outlive the lexer.
  AffLexer(std::string_view text, std::string_view file_name) : text_(text), file_name_(file_name) {}

  /// The next word without taking it, empty at the end of the file. Braces are words of their own.
  std::string_view peek();
  /// Takes a word; `expected` names it for the message at the end of the file.
  std::string_view word(std::string_view expected);
  void expect(std::string_view keyword);
  bool next_is_number();

  double number(std::string_view expected);      ///< finite
  glm::dvec3 vector(std::string_view expected);  ///< three numbers
  float real(std::string_view expected);         ///< beyond the range of floats: infinite
  std::int64_t integer(std::string_view expected);
  /// A count or size: 0 or more. Says nothing about what follows: see most_numbers_left.
  std::size_t count(std::string_view expected);
  /// An index below `size`.
  std::uint32_t index(std::size_t size, std::string_view expected);

  /// No more numbers than this can follow: the bound for reserving by a count in the file.
  std::size_t most_numbers_left() const { return (text_.size() - position_) / 2 + 1; }
  int line() const { return word_line_; }  ///< of the last word taken
  std::string_view file_name() const { return file_name_; }
  std::string place() const;  ///< "file.aff:12" of the last word taken
  [[noreturn]] void fail(std::string_view found, std::string_view expected) const;

private:
  void skip_blanks();
  double finite_number(std::string_view text, std::string_view expected) const;

  std::string_view text_;
  std::string_view file_name_;
  std::size_t position_ = 0;
  int line_ = 1;
  int word_line_ = 1;
};

/// `text` in quotes for a message: cut at 40 bytes, other bytes than printable ASCII as \xNN.
std::string quote_word(std::string_view text);

}  // namespace tenebra::formats
