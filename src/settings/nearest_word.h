// "Did you mean ...?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tenebra::settings {

/// The word of `known` that is spelled most like `word`; "" if none is: more than a third of its letters
/// would have to be added, dropped, changed or swapped with their neighbours. Of equals the first; case does
/// not count.
std::string nearest_word(std::string_view word, std::span<const std::string> known);
/// " (did you mean --size?)", the nearest word in `form`; empty: none is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> known,
                         std::string_view form = "{}");

}  // namespace tenebra::settings
