#include "settings/output_pattern.h"

#include <algorithm>

#include "base/fail.h"

namespace tenebra::settings {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether a frame number stands at `at`, or a percent sign that should be one.
/// Signs ## in names of folders are no number.
bool begins_number(std::string_view text, std::size_t at) {
  if (text[at] == '%') return !text.substr(at).starts_with("%%");
  return text.substr(at).starts_with("##") && text.find('/', at) == std::string_view::npos;
}

/// Digits asked for by the conversion at `at`, which moves past it; -1: not a conversion.
int read_conversion(std::string_view text, std::size_t& at) {
  std::size_t i = at + 1;
  int digits = 0;
  if (text[at] == '#') {
    at = std::min(text.find_first_not_of('#', at), text.size());
    return static_cast<int>(at - i + 1);
  }
  if (i + 1 < text.size() && text[i] == '0' && is_digit(text[i + 1])) {
    digits = text[i + 1] - '0';
    i += 2;
  }
  if (i >= text.size() || text[i] != 'd') return -1;
  at = i + 1;
  return digits;
}

}  // namespace

Expected<OutputPattern> OutputPattern::parse(const std::string& text) {
  if (text.ends_with(".png")) return parse_stem(text, ".png");
  return base::fail("found {}, expected a name that ends in .png, like out/%04d.png", text);
}

Expected<OutputPattern> OutputPattern::parse_picture(const std::string& text) {
  if (text == "-") {
    OutputPattern pipe;
    pipe.text_ = pipe.before_ = text;
    return pipe;
  }
  if (text.ends_with(".exr")) return parse_stem(text, ".exr");
  for (const std::string_view extension : {".png", ".jpg", ".jpeg"})
    if (text.ends_with(extension)) return parse_stem(text, extension);
  return base::fail(
      "found {}, expected a name that ends in .png, .jpg or .exr, like out/%04d.png, or - or none", text);
}

Expected<OutputPattern> OutputPattern::parse_mask(const std::string& text) {
  if (text.ends_with(".pfm")) return parse_stem(text, ".pfm");
  if (text.ends_with(".png")) return parse_stem(text, ".png");
  return base::fail("found {}, expected a name that ends in .png or .pfm, like out/mask_%04d.png", text);
}

Expected<OutputPattern> OutputPattern::parse_stem(const std::string& text, std::string_view extension) {
  OutputPattern pattern;
  pattern.text_ = text;
  pattern.extension_ = extension;
  const std::string_view stem = std::string_view(text).substr(0, text.size() - extension.size());
  for (std::size_t at = 0; at < stem.size();) {
    std::string& part = pattern.is_numbered() ? pattern.after_ : pattern.before_;
    if (!begins_number(stem, at)) {
      at += stem[at] == '%' ? 1 : 0;
      part += stem[at++];
      continue;
    }
    const int digits = read_conversion(stem, at);
    if (digits < 0 || pattern.is_numbered()) {
      return base::fail(
          "found {}, expected one frame number %d, %0Nd or ####, like out/%04d.png (%% is a percent sign)",
          text);
    }
    pattern.digits_ = digits;
  }
  return pattern;
}

fs::path OutputPattern::file(int frame, std::string_view suffix) const {
  const std::string number = is_numbered() ? fmt::format("{:0{}}", frame, digits_) : "";
  return fmt::format("{}{}{}{}{}", before_, number, after_, suffix, extension_);
}

Expected<void> make_folder_of(const fs::path& file) {
  const fs::path folder = file.parent_path();
  std::error_code error;
  if (folder.empty() || fs::is_directory(folder, error)) return {};
  fs::create_directories(folder, error);
  if (error)
    return base::fail("cannot make the folder {} for {}: {}", folder.string(), file.string(),
                      error.message());
  if (!fs::is_directory(folder))
    return base::fail("cannot write {}: {} is not a folder", file.string(), folder.string());
  return {};
}

}  // namespace tenebra::settings
