// Text as JSON has it.
#pragma once

#include <string>
#include <string_view>

namespace tenebra::base {

/// A JSON string; bytes that are not UTF-8 (file names may hold any) become question marks.
std::string json_string(std::string_view text);

}  // namespace tenebra::base
