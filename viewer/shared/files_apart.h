// Outputs that would overwrite what they are made of, or each other, are refused before anything is done.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::viewer {

/// A file that will be written, and the option that named it.
struct OutputName {
  std::string option;
  std::filesystem::path file;
};

/// Fails if two of them are one file, however they are named (links, `..`), if an output is an input, or is
/// something that open_stream refuses. Devices like /dev/null may be named any number of times.
Expected<void> check_files_apart(const std::vector<std::filesystem::path>& inputs,
                                 const std::vector<OutputName>& outputs);

}  // namespace tenebra::viewer
