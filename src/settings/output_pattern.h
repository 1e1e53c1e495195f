// Names of numbered pictures: "out/%04d.png".
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::settings {

/// Makes the folder of a file, and those that it lies in. Fails if it cannot be made or is no folder.
Expected<void> make_folder_of(const std::filesystem::path& file);

/// A file name with at most one frame number: %d, or %0Nd padded with zeros to N digits, or two # or more,
/// one for each digit; %% is a percent sign.
class OutputPattern {
public:
  /// Refuses other conversions, two numbers, and names that do not end in .png.
  static Expected<OutputPattern> parse(const std::string& text);
  /// The same for names that end in .png, .jpg, .jpeg or .exr, and for "-", which is standard output.
  static Expected<OutputPattern> parse_picture(const std::string& text);
  /// The same for names that end in .png or .pfm.
  static Expected<OutputPattern> parse_mask(const std::string& text);

  bool is_numbered() const { return digits_ >= 0; }
  bool is_pfm() const { return extension_ == ".pfm"; }
  bool is_exr() const { return extension_ == ".exr"; }
  bool is_jpeg() const { return extension_ == ".jpg" || extension_ == ".jpeg"; }
  bool is_pipe() const { return extension_.empty(); }
  const std::string& text() const { return text_; }
  /// Name for `frame`, with `suffix` before the extension.
  std::filesystem::path file(int frame, std::string_view suffix = "") const;
  Expected<void> prepare_folder() const { return make_folder_of(file(0)); }

private:
  static Expected<OutputPattern> parse_stem(const std::string& text, std::string_view extension);

  std::string text_;
  std::string before_;
  std::string after_;  // without the extension
  std::string extension_;
  int digits_ = -1;  // -1: no number
};

}  // namespace tenebra::settings
