// Names of numbered pictures: "out/%04d.png".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/expected.h"

namespace tenebra::viewer {

/// A file name with at most one frame number: %d, or %0Nd padded with zeros to N digits; %% is a percent
/// sign.
class OutputPattern {
public:
  /// Refuses other conversions, two numbers, and names that do not end in .png.
  static Expected<OutputPattern> parse(const std::string& text);

  bool is_numbered() const { return digits_ >= 0; }
  const std::string& text() const { return text_; }
  /// Name for `frame`, with `suffix` before the extension.
  std::filesystem::path file(int frame, std::string_view suffix = "") const;
  /// Makes the folder of the files if only that last folder is missing, so that a mistyped path does not grow
  /// a tree of folders. Fails if it cannot be made or is no folder.
  Expected<void> prepare_folder() const;

private:
  std::string text_;
  std::string before_;
  std::string after_;  // without the extension
  int digits_ = -1;    // -1: no number
};

}  // namespace tenebra::viewer
