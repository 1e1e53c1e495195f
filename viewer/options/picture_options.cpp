#include "options/picture_options.h"

#include <array>
#include <string_view>

#include "base/fail.h"
#include "options/choices.h"

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

Expected<std::optional<OutputPattern>> parse_pictures(const std::string& text) {
  if (text == "none") return std::optional<OutputPattern>();
  auto pattern = OutputPattern::parse_picture(text);
  if (!pattern) return tl::unexpected(pattern.error());
  return std::optional<OutputPattern>(std::move(*pattern));
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

template <const auto& choices>
constexpr auto parse_word = +[](const std::string& text) { return parse_choice(choices, text); };

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
  options.files = OutputPattern::parse_picture("out/%04d.png").value();
  add_value(command, "-o,--output", options.files, parse_pictures,
            "Names of the pictures; %04d or #### is the frame. .exr:\n"
            "OpenEXR with linear colours; -: to standard output, for a\n"
            "pipe; none: no pictures [out/%04d.png]")
      .type_name("FILE.png|FILE.exr|-");
  add_aov_option(command, options.aovs);
  add_value(command, "--exr-type", options.precision, parse_word<exr_type_choices>,
            "Floats of 16 or 32 bits in OpenEXR; depth and ids always\nhave 32 [half]")
      .type_name("half|float");
  add_value(command, "--exr-compression", options.compression, parse_word<exr_compression_choices>,
            "How OpenEXR is compressed, without loss; piz is smaller\nwhere pictures are noisy [zip]")
      .type_name("zip|piz");
  add_value(command, "--pipe-format", options.pipe_format, parse_word<pipe_choices>,
            "What -o - writes: PNG files one after another, or rows of\nred, green and blue bytes [png]")
      .type_name("png|rgb24");
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
    return base::fail("--pipe-format is for frames in standard output; expected -o - with it");
  if (options.are_exr()) return {};
  const char* const option = options.aovs.any()    ? "--aov"
                             : options.precision   ? "--exr-type"
                             : options.compression ? "--exr-compression"
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
