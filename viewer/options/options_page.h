// docs/options.md: every setting, from the tables.
#pragma once

#include <string>

namespace tenebra::viewer {

/// The page as Markdown; a test holds docs/options.md to it.
std::string options_page();

}  // namespace tenebra::viewer
