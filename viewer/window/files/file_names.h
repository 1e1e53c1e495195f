// Names of files that the window writes by itself: none replaces an earlier one.
#pragma once

#include <filesystem>
#include <string>

#include "options/settings_names.h"

namespace tenebra::viewer {

/// `name`, or with a number the first that no file has.
std::string unused_name(const std::filesystem::path& name);
/// The first name of `pattern` after `number` that no file has; `number` becomes its number.
std::filesystem::path next_unused(const OutputPattern& pattern, int& number);

}  // namespace tenebra::viewer
