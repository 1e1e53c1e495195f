#include "options/render_options.h"

#include "base/fail.h"
#include "options/config_file.h"
#include "options/memory_option.h"
#include "options/raster_options.h"

namespace tenebra::viewer {
namespace {

constexpr const char* examples =
    "Examples:\n"
    "  tenebra render scenes/city.glb\n"
    "      the first frame at 800x600, to out/0000.png\n"
    "  tenebra render scenes/city.glb --frames 0:99 -o walk/%04d.png --log walk.csv\n"
    "      a hundred frames, and how long each took\n"
    "  tenebra render Robot.aff --no-cast city2.aff:69 --frames 160 --size 1024x1024 --mask mask.png -o "
    "none\n"
    "      the shadow mask alone: 255 lit, 0 in shadow\n"
    "  tenebra render room.glb --eye 0,1.6,4 --look-at 0,1,0 --fov 50 --light 0\n"
    "      another camera, one light\n"
    "  tenebra render scenes/court.glb --shadows soft --mask visible.png --mask visible.pfm\n"
    "      exact soft shadows of its area light, and how much of the light each pixel sees\n"
    "  tenebra render scenes/city.glb -o shot_%04d.exr --aov depth,normal,visibility\n"
    "      OpenEXR: linear colours, and layers for compositing (docs/exr.md)\n"
    "  tenebra render scenes/city.glb --frames all -o - | ffmpeg -f image2pipe -framerate 30 -i - city.mp4\n"
    "      a video; --pipe-format rgb24 for -f rawvideo -pix_fmt rgb24 -s 800x600\n"
    "  tenebra render scenes/city.glb --shadows soft --light-size 2% --ao field --frames 0:9\n"
    "      point lights turned into squares, and ambient occlusion\n"
    "\n"
    "Frames count from 0; A:B includes B; A: and all run to the end. Ctrl-C drops the frame being drawn and\n"
    "keeps those before it. A picture or mask is either whole or absent. The log and the trace grow by a "
    "whole row\n"
    "for each frame whose files are there, and stay, however the program ends. Named pipes, folders and "
    "disks are\n"
    "refused as outputs; /dev/null and /dev/stdout are written to directly. The last folder of a picture's\n"
    "name is made if it is missing.\n"
    "\n"
    "--resume reads a small file beside the pictures, .%04d.png.done, and the log: they say how the frames "
    "were made\n"
    "and which are done. After a render is killed, at most one frame whose picture is there is drawn again. "
    "Any number\n"
    "of processes may render into one folder, each with its own log (docs/farm.md).\n"
    "\n"
    "Exit code: 0 done; 1 failed, and would again (one sentence says why). The others are worth another try "
    "with\n"
    "--resume: 75 a file could not be written (a full disk; the reader of -o - is gone) or no memory was "
    "left, 124 the\n"
    "time of --timeout is up, 129, 130 or 143 stopped by a signal. A second signal ends the program at once; "
    "no file\n"
    "is half written then either.";

Expected<void> read_masks(const std::vector<std::string>& names, std::vector<OutputPattern>& masks) {
  masks.clear();
  for (const std::string& name : names) {
    auto pattern = OutputPattern::parse_mask(name);
    if (!pattern) return tl::unexpected(pattern.error());
    masks.push_back(std::move(*pattern));
  }
  return {};
}

void add_output_options(CLI::App& command, RenderOptions& options) {
  add_picture_options(command, options.pictures);
  add_texts(
      command, "--mask",
      [&options](const std::vector<std::string>& names) { return read_masks(names, options.masks); },
      "Shadow masks: 255 lit; 0 in shadow, facing away or\n"
      "background; soft: values in between, the visible part of the\n"
      "light; .pfm: in 32 bits; several lights add _L0, _L1, ...;\n"
      "may be repeated")
      .type_name("FILE.png|FILE.pfm");
  add_texts(
      command, "--mask-colour",
      [&options](const std::vector<std::string>& names) { return read_masks(names, options.mask_colours); },
      "The same in colour: masks times the shares of red, green\n"
      "and blue that glass and blended surfaces let pass")
      .type_name("FILE.png|FILE.pfm");
  add_texts(
      command, "--mask-mean",
      [&options](const std::vector<std::string>& names) { return read_masks(names, options.mask_means); },
      "The mean of the masks over each pixel's samples\n"
      "(--antialias); --mask is the sample at the pixel's centre")
      .type_name("FILE.png|FILE.pfm");
  add_texts(
      command, "--mask-samples",
      [&options](const std::vector<std::string>& names) { return read_masks(names, options.mask_samples); },
      "The mask of each sample; names add _S0, _S1, ...: the\n"
      "centre's first, then the others; a pixel with one sample\n"
      "has it in all of them")
      .type_name("FILE.png");
  add_texts(
      command, "--error-map",
      [&options](const std::vector<std::string>& names) { return read_masks(names, options.error_maps); },
      "How far off the light at each pixel may be (estimated\n"
      "standard error), in 1/255 of its white: 0 where it is exact;\n"
      ".pfm: in 32 bits, .png: rounded")
      .type_name("FILE.png|FILE.pfm");
  add_text(command, "--log", options.log, "Log: times and counts of each frame").type_name("FILE.csv");
  add_text(command, "--trace", options.trace, "The same times for Perfetto or chrome://tracing")
      .type_name("FILE.json");
  add_flag(command, "--quiet", options.quiet, "No progress, warnings or summary");
  add_raster_options(command, options.raster);
}

bool draws_several_frames(const RenderOptions& options) {
  return options.frames && options.frames->last != options.frames->first;
}

Expected<void> check_pattern(const OutputPattern& pattern, const char* option, bool several) {
  if (!several || pattern.is_numbered()) return {};
  return base::fail(
      "{} {} has no frame number, and several frames would overwrite each other; expected one like %04d",
      option, pattern.text());
}

Expected<void> check_mask(const RenderOptions& options, const OutputPattern& mask, const char* option,
                          bool several) {
  if (auto checked = check_pattern(mask, option, several); !checked) return checked;
  if (options.method.render.shadows == render::ShadowMode::none)
    return base::fail("{} needs shadows, and --shadows none makes no mask", option);
  const auto& pictures = options.pictures.files;
  if (pictures && mask.file(0) == pictures->file(0))
    return base::fail("-o and {} name the same file {}", option, mask.text());
  return {};
}

Expected<void> check_sample_masks(const RenderOptions& options, bool several) {
  const auto check = [&](const std::vector<OutputPattern>& masks, const char* option) -> Expected<void> {
    if (!masks.empty() && options.method.render.antialias == 1)
      return base::fail("{} is for several samples per pixel; expected --antialias 2, 4, 8 or 16 with it",
                        option);
    for (const OutputPattern& mask : masks) {
      if (auto checked = check_mask(options, mask, option, several); !checked) return checked;
      for (const OutputPattern& other : options.masks)
        if (mask.file(0) == other.file(0))
          return base::fail("--mask and {} name the same file {}", option, mask.text());
    }
    return {};
  };
  if (auto checked = check(options.mask_means, "--mask-mean"); !checked) return checked;
  for (const OutputPattern& mask : options.mask_samples)
    if (mask.is_pfm()) return base::fail("--mask-samples {} are masks of 8 bits; expected .png", mask.text());
  return check(options.mask_samples, "--mask-samples");
}

Expected<void> check_masks(const RenderOptions& options, bool several) {
  for (const OutputPattern& mask : options.masks) {
    if (auto checked = check_mask(options, mask, "--mask", several); !checked) return checked;
    if (mask.is_pfm() && options.method.render.shadows != render::ShadowMode::soft) {
      return base::fail("--mask {} has fractions of a light's area, which need --shadows soft", mask.text());
    }
  }
  if (auto checked = check_sample_masks(options, several); !checked) return checked;
  for (const OutputPattern& map : options.error_maps) {
    if (auto checked = check_mask(options, map, "--error-map", several); !checked) return checked;
    if (options.method.render.shadows != render::ShadowMode::soft || options.method.render.soft_points > 0)
      return base::fail("--error-map {} is for soft shadows with an error; expected --shadows soft{}",
                        map.text(), options.method.render.soft_points > 0 ? " without --soft-points" : "");
    for (const OutputPattern& other : options.masks)
      if (map.file(0) == other.file(0))
        return base::fail("--mask and --error-map name the same file {}", map.text());
  }
  for (const OutputPattern& mask : options.mask_colours) {
    if (auto checked = check_mask(options, mask, "--mask-colour", several); !checked) return checked;
    for (const OutputPattern& other : options.masks)
      if (mask.file(0) == other.file(0))
        return base::fail("--mask and --mask-colour name the same file {}", mask.text());
  }
  return {};
}

/// Frames in a pipe are gone: a later run cannot continue them, and nothing else may be written between them.
Expected<void> check_pipe(const RenderOptions& options) {
  if (options.resume)
    return base::fail(
        "--resume looks for what was written, and frames in a pipe are gone; expected files with it");
  const auto is_stdout = [](const std::string& name) { return name == "/dev/stdout" || name == "/dev/fd/1"; };
  for (const auto& [option, name] : {std::pair("--log", options.log), std::pair("--trace", options.trace)})
    if (is_stdout(name)) return base::fail("-o - and {} {} are both standard output", option, name);
  return {};
}

Expected<void> check_pictures(const RenderOptions& options, bool several) {
  const PictureOptions& pictures = options.pictures;
  if (auto checked = check_picture_options(pictures); !checked) return checked;
  if (pictures.to_pipe) return check_pipe(options);
  if (auto checked = check_aovs(pictures.aovs, options.method.render); !checked) return checked;
  return pictures.files ? check_pattern(*pictures.files, "-o", several) : Expected<void>();
}

/// The options that say which of the frames are drawn by this run.
void add_progress_options(CLI::App& command, RenderOptions& options) {
  add_value(command, "--chunk", options.chunk, parse_chunk,
            "Draw only part I of N of the frames, counted from 1, for\n"
            "N processes")
      .type_name("I/N");
  add_flag(command, "--resume", options.resume,
           "Continue a render of the same scene, settings and program\n"
           "where it ended; fails if these differ");
  add_value(command, "--timeout", options.timeout_s, parse_positive,
            "Stop after this many seconds, as Ctrl-C does")
      .type_name("S");
  add_memory_option(command, options.memory_mb);
}

void add_budget_option(CLI::App& command, RenderOptions& options) {
  add_value(command, "--budget", options.budget_ms, parse_positive,
            "Time for a frame, in ms: each gets the smallest errors of a\n"
            "fixed ladder that fit, as --soft-error and --ao-error; none\n"
            "smaller than those of --quality. The log has them")
      .type_name("MS")
      .excludes(option_of(command, "--soft-error"))
      .excludes(option_of(command, "--ao-error"))
      .excludes(option_of(command, "--soft-points"));
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  set_examples(command, examples);
  add_scene_options(command, options.scene);
  option_of(command, "SCENE").required();
  add_value(command, "--frames", options.frames, parse_frame_range,
            "Frames to render; 0:99:10 for every tenth [0, the first]")
      .type_name("A:B[:STEP]|all")
      .excludes(option_of(command, "--time"));
  add_progress_options(command, options);
  add_method_options(command, options.method);
  add_budget_option(command, options);
  add_output_options(command, options);
  add_config_option(command);
}

void settle_render_options(RenderOptions& options) {
  settle_picture_options(options.pictures);
  const bool masks = !options.masks.empty() || !options.mask_colours.empty() || !options.mask_means.empty() ||
                     !options.mask_samples.empty() || !options.error_maps.empty();
  if (masks && !options.method.terminator) options.method.terminator = render::Terminator::flat;
}

Expected<void> check_render_options(const RenderOptions& options) {
  const bool several = draws_several_frames(options);
  if (auto checked = check_pictures(options, several); !checked) return checked;
  if (auto checked = check_masks(options, several); !checked) return checked;
  const bool files = options.pictures.files || !options.masks.empty() || !options.mask_colours.empty() ||
                     !options.mask_means.empty() || !options.mask_samples.empty() ||
                     !options.error_maps.empty();
  if (options.resume && !files && options.log.empty())
    return base::fail("--resume goes by pictures, masks or the log; expected -o, --mask or --log");
  if (auto checked = check_scene_options(options.scene); !checked) return checked;
  return check_method_options(options.method);
}

}  // namespace tenebra::viewer
