// Refuses outputs that would overwrite their own input or each other, before anything is done.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::viewer {

/// A file that will be written, and the option that named it.
struct OutputName {
  std::string option;
  std::filesystem::path file;
};

/// Any number of them, made one after the other: hands each to `use`, until that fails. May be called again,
/// for the same ones in the same order.
using OutputNames =
    std::function<Expected<void>(const std::function<Expected<void>(const OutputName&)>& use)>;

/// Fails if two of them are one file, however they are named (links, `..`), if an output is an input, or is
/// something that open_stream refuses. Devices like /dev/null may be named any number of times. Holds eight
/// bytes for each output, not its name.
Expected<void> check_files_apart(const std::vector<std::filesystem::path>& inputs,
                                 const OutputNames& outputs);
/// That check for one output.
Expected<void> check_files_apart(const std::vector<std::filesystem::path>& inputs, const OutputName& output);

}  // namespace tenebra::viewer
