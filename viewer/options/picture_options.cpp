#include "options/picture_options.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "base/fail.h"
#include "settings/choices.h"

namespace tenebra::viewer {
namespace {

constexpr std::array pipe_choices{Choice<PipeFormat>{"png", PipeFormat::png},
                                  Choice<PipeFormat>{"rgb24", PipeFormat::rgb24}};
constexpr std::array exr_type_choices{Choice<io::exr::Precision>{"half", io::exr::Precision::half},
                                      Choice<io::exr::Precision>{"float", io::exr::Precision::full}};
constexpr std::array exr_compression_choices{Choice<io::exr::Compression>{"zip", io::exr::Compression::zip},
                                             Choice<io::exr::Compression>{"piz", io::exr::Compression::piz}};

struct AovName {
  std::string_view name;
  bool& (*wanted)(render::AovChoice&);
};
constexpr std::array aov_names{
    AovName{"depth", [](render::AovChoice& o) -> bool& { return o.depth; }},
    AovName{"id", [](render::AovChoice& o) -> bool& { return o.ids; }},
    AovName{"normal", [](render::AovChoice& o) -> bool& { return o.normal; }},
    AovName{"visibility", [](render::AovChoice& o) -> bool& { return o.visibility; }},
    AovName{"irradiance", [](render::AovChoice& o) -> bool& { return o.irradiance; }},
    AovName{"ao", [](render::AovChoice& o) -> bool& { return o.openness; }},
    AovName{"albedo", [](render::AovChoice& o) -> bool& { return o.albedo; }}};

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

Expected<render::AovChoice> parse_aovs(const std::string& text) {
  render::AovChoice options;
  std::string_view rest = text;
  for (bool last = false; !last;) {
    const std::size_t comma = rest.find(',');
    const std::string word(rest.substr(0, comma));
    last = comma == std::string_view::npos;
    if (!last) rest.remove_prefix(comma + 1);
    const AovName* found = nullptr;
    for (const AovName& aov : aov_names)
      if (is_word(word, aov.name)) found = &aov;
    if (found == nullptr)
      return base::fail(
          "found {}, expected some of depth, id, normal, visibility, irradiance, ao and albedo, like "
          "depth,id",
          text);
    found->wanted(options) = true;
  }
  return options;
}

std::string aov_words(render::AovChoice aovs) {
  std::string words;
  for (const AovName& aov : aov_names)
    if (aov.wanted(aovs)) words += fmt::format("{}{}", words.empty() ? "" : ",", aov.name);
  return words;
}

void add_aov_option(CLI::App& command, render::AovChoice& aovs) {
  add_value(command, "--aov", aovs, parse_aovs,
            "Further layers of OpenEXR pictures: depth, id, normal,\n"
            "visibility, irradiance, ao, albedo (docs/exr.md)")
      .type_name("A,B,...");
}

Expected<void> check_aovs(const render::AovChoice& aovs, const render::RenderSettings& settings) {
  if (aovs.visibility && settings.shadows == render::ShadowMode::none)
    return base::fail("--aov visibility needs shadows, and --shadows none finds none");
  if (aovs.openness && settings.ao.mode == AoMode::none)
    return base::fail("--aov ao needs ambient occlusion; expected --ao adaptive, field or rays with it");
  return {};
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
  render::AovChoice aovs = options.aovs;
  for (const AovName& aov : aov_names)
    if (aov.wanted(aovs)) text += fmt::format(", {}", aov.name);
  return text + ")";
}

}  // namespace tenebra::viewer
