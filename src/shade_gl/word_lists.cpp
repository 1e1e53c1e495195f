#include "shade_gl/word_lists.h"

#include <limits>

#include "base/fail.h"

namespace tenebra::shade_gl {

Expected<void> WordLists::send(std::size_t& sent_bytes) {
  constexpr std::size_t most_words = std::numeric_limits<std::uint32_t>::max() / 8;
  if (words_ > most_words)
    return base::fail("OpenGL: found {} numbers for samples, expected at most {}", words_, most_words);
  if (auto room = buffer_.reserve(4 * words_); !room) return room;
  for (const List& list : lists_) {
    if (list.bytes.empty()) continue;
    buffer_.update(4 * list.first_word, list.bytes);
    sent_bytes += list.bytes.size();
  }
  return {};
}

}  // namespace tenebra::shade_gl
