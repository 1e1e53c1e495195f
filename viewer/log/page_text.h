// Texts and pictures as parts of a page.
#pragma once

#include <string>
#include <string_view>

namespace tenebra::viewer {

/// `text` as HTML, within elements or quoted attributes; bytes that are not UTF-8 become U+FFFD.
std::string page_text(std::string_view text);

/// `bytes` in base64 (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace tenebra::viewer
