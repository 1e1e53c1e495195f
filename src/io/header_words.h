// Words and numbers in the headers of pictures.
#pragma once

#include <algorithm>
#include <string_view>

#include "base/number_in.h"

namespace tenebra::io {

/// Takes the next word and the one blank behind it off `text`; empty: none is left.
inline std::string_view take_header_word(std::string_view& text, std::string_view blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(std::min(word.size() + 1, text.size()));
  return word;
}

using base::number_in;

}  // namespace tenebra::io
