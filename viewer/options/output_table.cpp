#include "options/output_table.h"

#include "session/aovs.h"
#include "settings/rows.h"
#include "settings/tables.h"

namespace tenebra::viewer {
namespace {

using settings::About;
using settings::Affects;
using settings::Group;
using OutputRow = settings::Rows<RenderOptions>;
using OutputRows = std::vector<settings::Setting<RenderOptions>>;

std::string frames_text(const FrameRange& range) {
  if (!range.last) return fmt::format("{}::{}", range.first, range.step);
  return fmt::format("{}:{}:{}", range.first, *range.last, range.step);
}

/// A further mask: a list of names.
template <class Get>
settings::Setting<RenderOptions> masks(About about, Get get) {
  about.group = Group::output;
  about.affects = Affects::files;
  about.several = true;
  const auto read = [get](RenderOptions& options, const std::string& text) -> Expected<void> {
    auto pattern = OutputPattern::parse_mask(text);
    if (!pattern) return tl::unexpected(pattern.error());
    get(options).push_back(std::move(*pattern));
    return {};
  };
  const auto texts = [get](const RenderOptions& options) {
    std::vector<std::string> names;
    for (const OutputPattern& pattern : get(options)) names.push_back(pattern.text());
    return names;
  };
  return OutputRow::own(std::move(about), read, texts);
}

/// A name of a file; none if it is empty.
template <class Get>
settings::Setting<RenderOptions> file(About about, Get get) {
  about.group = Group::output;
  about.affects = Affects::files;
  return OutputRow::text(std::move(about), get);
}

/// Which words of --format choose what; the old options had two each.
settings::Setting<RenderOptions> format(About about, std::initializer_list<std::string_view> words) {
  about.group = Group::output;
  about.affects = Affects::files;
  const std::vector<std::string_view> known(words);
  const auto read = [known](RenderOptions& options, const std::string& text) {
    return read_format(text, known, options.pictures);
  };
  const auto texts = [](const RenderOptions& options) { return format_words(options.pictures); };
  auto row = OutputRow::own(std::move(about), read, texts);
  if (known.size() == 2) row.words = known;
  return row;
}

settings::Setting<RenderOptions> output() {
  const auto read = [](RenderOptions& options, const std::string& text) {
    return read_pictures(text, options.pictures);
  };
  const auto texts = [](const RenderOptions& options) -> std::vector<std::string> {
    return {options.pictures.files ? options.pictures.files->text() : "none"};
  };
  return OutputRow::own({.name = "output",
                         .value = "FILE.png|.jpg|.exr|-",
                         .help = "Names of the pictures; %04d or #### is the frame. .exr: OpenEXR with "
                                 "linear colours; -: to standard output, for a pipe; none: no pictures",
                         .affects = Affects::files,
                         .letter = "o"},
                        read, texts);
}

settings::Setting<RenderOptions> aov() {
  const auto read = [](RenderOptions& options, const std::string& text) -> Expected<void> {
    const auto aovs = session::parse_aovs(text);
    if (!aovs) return tl::unexpected(aovs.error());
    options.pictures.aovs = *aovs;
    return {};
  };
  const auto texts = [](const RenderOptions& options) -> std::vector<std::string> {
    const std::string words = session::aov_words(options.pictures.aovs);
    return words.empty() ? std::vector<std::string>() : std::vector<std::string>{words};
  };
  return OutputRow::own({.name = "aov",
                         .value = "A,B,...",
                         .help = "Further layers of OpenEXR pictures: depth, id, normal, visibility, "
                                 "irradiance, ao, albedo (docs/exr.md)",
                         .group = Group::output,
                         .affects = Affects::files},
                        read, texts);
}

void add_frames(OutputRows& rows) {
  rows.push_back(OutputRow::value(
      {.name = "frames",
       .value = "A:B[:STEP]|all",
       .help = "Frames to render; 0:99:10 for every tenth",
       .standard = "0, the first",
       .affects = Affects::files,
       .excludes = "time"},
      [](auto& options) -> auto& { return options.frames; }, settings::parse_frame_range, frames_text));
  rows.push_back(OutputRow::value(
      {.name = "chunk",
       .value = "I/N",
       .help = "Draw only part I of N of the frames, counted from 1, for N processes",
       .standard = "all",
       .group = Group::run,
       .affects = Affects::files},
      [](auto& options) -> auto& { return options.chunk; }, settings::parse_chunk,
      [](const Chunk& chunk) { return fmt::format("{}/{}", chunk.index, chunk.count); }));
  rows.push_back(OutputRow::flag(
      {.name = "resume",
       .help =
           "Continue a render of the same scene, settings and program where it ended; fails if these differ",
       .group = Group::run,
       .affects = Affects::files},
      [](auto& options) -> auto& { return options.resume; }));
}

void add_files(OutputRows& rows) {
  rows.push_back(output());
  rows.push_back(aov());
  rows.push_back(
      format({.name = "format",
              .value = "WORDS",
              .help = "How pictures are written: of OpenEXR half or float (bits; depth and ids always have "
                      "32) and zip or piz (without loss; piz is smaller where pictures are noisy), of -o - "
                      "png or rgb24 (rows of red, green and blue bytes)",
              .standard = "half,zip; png",
              .has_keys = true},
             {"half", "float", "zip", "piz", "png", "rgb24"}));
  rows.push_back(
      format({.name = "exr-type", .help = "Floats of 16 or 32 bits", .as = "--format "}, {"half", "float"}));
  rows.push_back(format({.name = "exr-compression", .help = "How OpenEXR is compressed", .as = "--format "},
                        {"zip", "piz"}));
  rows.push_back(
      format({.name = "pipe-format", .help = "What -o - writes", .as = "--format "}, {"png", "rgb24"}));
  rows.push_back(masks(
      {.name = "mask",
       .value = "[KIND:]FILE",
       .help = "Shadow masks, .png or .pfm: 255 lit; 0 in shadow, facing away or background; soft: values in "
               "between, the visible part of the light; .pfm: in 32 bits; several lights add _L0, _L1, ...; "
               "may be repeated. KIND colour: times the shares of red, green and blue that glass lets pass; "
               "mean: over each pixel's samples; samples: each of them, _S0, _S1, ...; error: how far off "
               "the light at each pixel may be, in 1/255",
       .has_keys = true},
      [](auto& options) -> auto& { return options.masks; }));
  rows.push_back(masks(
      {.name = "mask-colour",
       .value = "FILE",
       .help = "Masks times the shares of red, green and blue that glass and blended surfaces let pass",
       .as = "--mask colour:"},
      [](auto& options) -> auto& { return options.mask_colours; }));
  rows.push_back(masks(
      {.name = "mask-mean",
       .value = "FILE",
       .help = "The mean of the masks over each pixel's samples",
       .as = "--mask mean:"},
      [](auto& options) -> auto& { return options.mask_means; }));
  rows.push_back(masks(
      {.name = "mask-samples",
       .value = "FILE",
       .help = "The mask of each sample, the centre's first; a pixel with one sample has it in all of them",
       .as = "--mask samples:"},
      [](auto& options) -> auto& { return options.mask_samples; }));
  rows.push_back(masks(
      {.name = "error-map",
       .value = "FILE",
       .help = "How far off the light at each pixel may be (estimated standard error), in 1/255 of its "
               "white: 0 where it is exact; .pfm: in 32 bits, .png: rounded",
       .as = "--mask error:"},
      [](auto& options) -> auto& { return options.error_maps; }));
  rows.push_back(file(
      {.name = "log",
       .value = "[trace:]FILE",
       .help = "Log, .csv: times and counts of each frame. May be repeated: trace:FILE.json, the same times "
               "for Perfetto or chrome://tracing",
       .has_keys = true},
      [](auto& options) -> auto& { return options.log; }));
  rows.push_back(file(
      {.name = "trace",
       .value = "FILE.json",
       .help = "The times of the log for Perfetto or chrome://tracing",
       .as = "--log trace:"},
      [](auto& options) -> auto& { return options.trace; }));
}

void add_limits(OutputRows& rows) {
  rows.push_back(OutputRow::number(
      {.name = "budget",
       .value = "MS",
       .help = "Time for a frame, in ms: each gets the smallest errors of a fixed ladder that fit, as "
               "--soft-error and --ao-error; none smaller than those of --quality. The log has them",
       .group = Group::run,
       .range = {1e-300, 1e300},
       .expected = "a number above 0"},
      [](auto& options) -> auto& { return options.budget_ms; }));
  rows.push_back(OutputRow::number(
      {.name = "timeout",
       .value = "S",
       .help = "Stop after this many seconds, as Ctrl-C does",
       .standard = "never",
       .group = Group::run,
       .affects = Affects::speed,
       .range = {1e-300, 1e300},
       .expected = "a number above 0"},
      [](auto& options) -> auto& { return options.timeout_s; }));
  rows.push_back(OutputRow::number(
      {.name = "memory",
       .value = "[soft:|ao:]MB",
       .help = "Memory for the whole program, in MB; if it needs more, it ends with a message. May be "
               "repeated: soft:MB is the part of soft shadows (else half), ao:MB that of fields and surface "
               "samples (else a quarter, at most 512)",
       .standard = "what the system has",
       .group = Group::run,
       .affects = Affects::speed,
       .range = {1, 1e6},
       .expected = "a whole number from 1 to 1000000",
       .has_keys = true},
      [](auto& options) -> auto& { return options.memory_mb; }));
  rows.push_back(OutputRow::flag(
      {.name = "quiet",
       .help = "No progress, warnings or summary",
       .group = Group::run,
       .affects = Affects::files},
      [](auto& options) -> auto& { return options.quiet; }));
}

OutputRows output_rows() {
  OutputRows rows;
  add_frames(rows);
  add_files(rows);
  add_limits(rows);
  return rows;
}

}  // namespace

std::span<const settings::Setting<RenderOptions>> output_table() {
  static const OutputRows rows = output_rows();
  return rows;
}

const About* about_of(std::string_view written) {
  if (const About* found = settings::find_about(written)) return found;
  return settings::find(output_table(), std::string_view(settings::dashed(written)));
}

}  // namespace tenebra::viewer
