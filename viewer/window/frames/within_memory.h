// Work of the window's threads that may need more memory than there is.
#pragma once

#include <exception>

#include <tenebra/expected.h>

#include "shell/last_words.h"

namespace tenebra::viewer {

/// What `work` gives, an Expected; where memory runs out a sentence, after `give_up`, which lets go of what
/// the work has left half made.
template <class Work, class GiveUp>
auto within_memory(Work work, GiveUp give_up) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& error) {
    if (!is_memory_failure(error)) throw;
  }
  give_up();
  return tl::unexpected(Error{no_memory_sentence()});
}

}  // namespace tenebra::viewer
