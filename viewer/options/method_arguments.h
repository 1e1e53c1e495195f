// Method options as the text that gives them on the command line.
#pragma once

#include <string>

#include "options/method_options.h"

namespace tenebra::viewer {

/// "--shadows soft --light-size 0.5x0.5 ...": every option whose value is not the default, in the order of
/// the help. Read by add_method_options it gives the same settings.
std::string method_arguments(const MethodOptions& options);

/// `word` as a POSIX shell and add_method_options take it for one word: quoted where it must be.
std::string shell_word(const std::string& word);

}  // namespace tenebra::viewer
