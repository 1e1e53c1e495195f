// Pages of docs that a measuring command writes anew, section by section.
#pragma once

#include <filesystem>
#include <string>

namespace tenebra::bench {

/// The page as it is; empty if it is not there.
std::string read_page(const std::filesystem::path& path);

/// A section of it, from its title to the next one; empty if it has none of that title.
std::string section_of(const std::string& page, const std::string& title);

}  // namespace tenebra::bench
