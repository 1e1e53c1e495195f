#include "options/picture_options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/fail.h"
#include "options/settings_names.h"
#include "session/aovs.h"

namespace tenebra::viewer {
namespace {

constexpr std::array pipe_choices{Choice<PipeFormat>{"png", PipeFormat::png},
                                  Choice<PipeFormat>{"rgb24", PipeFormat::rgb24}};
constexpr std::array exr_type_choices{Choice<io::exr::Precision>{"half", io::exr::Precision::half},
                                      Choice<io::exr::Precision>{"float", io::exr::Precision::full}};
constexpr std::array exr_compression_choices{Choice<io::exr::Compression>{"zip", io::exr::Compression::zip},
                                             Choice<io::exr::Compression>{"piz", io::exr::Compression::piz}};

/// Sets what `word` is one of; false: it is none of these.
template <class T, std::size_t N>
bool take_word(const std::string& word, const std::array<Choice<T>, N>& choices, std::optional<T>& target) {
  const auto found = parse_choice(choices, word);
  if (found) target = *found;
  return found.has_value();
}

}  // namespace

Expected<void> read_pictures(const std::string& text, PictureOptions& options) {
  if (text == "none") {
    options.files.reset();
    return {};
  }
  auto pattern = OutputPattern::parse_picture(text);
  if (!pattern) return tl::unexpected(pattern.error());
  options.files = std::move(*pattern);
  return {};
}

Expected<void> read_format(const std::string& text, const std::vector<std::string_view>& known,
                           PictureOptions& options) {
  for (const std::string_view part : split(text, ',')) {
    const std::string word(part);
    const bool is_known =
        std::any_of(known.begin(), known.end(), [&](std::string_view other) { return is_word(word, other); });
    const bool taken = is_known && (take_word(word, exr_type_choices, options.precision) ||
                                    take_word(word, exr_compression_choices, options.compression) ||
                                    take_word(word, pipe_choices, options.pipe_format));
    if (!taken) return base::fail("found {}, expected some of {}", text, fmt::join(known, ", "));
  }
  return {};
}

std::vector<std::string> format_words(const PictureOptions& options) {
  std::string words;
  const auto add = [&](const auto& choices, const auto& value) {
    if (value) words += fmt::format("{}{}", words.empty() ? "" : ",", choice_name(choices, *value));
  };
  add(exr_type_choices, options.precision);
  add(exr_compression_choices, options.compression);
  add(pipe_choices, options.pipe_format);
  return words.empty() ? std::vector<std::string>() : std::vector<std::string>{words};
}

void settle_picture_options(PictureOptions& options) {
  if (!options.files || !options.files->is_pipe()) return;
  options.files.reset();
  options.to_pipe = true;
}

Expected<void> check_picture_options(const PictureOptions& options) {
  if (options.pipe_format && !options.to_pipe)
    return base::fail("--format png and rgb24 are for frames in standard output; expected -o - with it");
  if (options.are_exr()) return {};
  const char* const option = options.aovs.any()                         ? "--aov"
                             : options.precision || options.compression ? "--format"
                                                                        : nullptr;
  if (option != nullptr)
    return base::fail("{} is for OpenEXR pictures; expected -o FILE.exr with it", option);
  return {};
}

std::string pictures_text(const PictureOptions& options) {
  if (options.to_pipe)
    return "-o - (" + choice_name(pipe_choices, options.pipe_format.value_or(PipeFormat::png)) + ")";
  if (!options.files) return "no pictures";
  std::string text = "-o " + std::filesystem::path(options.files->text()).filename().string();
  if (!options.are_exr()) return text;
  text += " (" + choice_name(exr_type_choices, options.precision.value_or(io::exr::Precision::half)) + ", " +
          choice_name(exr_compression_choices, options.compression.value_or(io::exr::Compression::zip));
  if (options.aovs.any()) text += ", " + session::aov_words(options.aovs);
  return text + ")";
}

}  // namespace tenebra::viewer
