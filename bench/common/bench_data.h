// What a user has to know about scenes that do not come with the program before comparing figures with the
// project's.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tenebra::bench {

/// Sentences: that BART is not in `folder` and where it comes from, or which of its files differ from those
/// that the documented figures were made with (tests/reference/bart.sha256; sha256sum compares them). Empty:
/// all are there.
std::vector<std::string> data_sentences(const std::filesystem::path& folder);

}  // namespace tenebra::bench
