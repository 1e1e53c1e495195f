#include "options/render_options.h"

#include "base/fail.h"
#include "options/config_file.h"
#include "options/output_table.h"
#include "options/raster_options.h"
#include "session/aovs.h"

namespace tenebra::viewer {
namespace {

constexpr const char* examples =
    "Examples:\n"
    "  tenebra render scenes/city.glb -o city.png --size 1280x720\n"
    "      a picture of the first frame\n"
    "  tenebra render scenes/city.glb --frames 0:99 -o walk/%04d.png --log walk.csv\n"
    "      a hundred frames, and how long each took\n"
    "  tenebra render model.glb --shadows soft --light-size 2% --ao adaptive -o soft.png\n"
    "      lights with a size, and ambient occlusion\n"
    "\n"
    "More examples:\n"
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
    "      a video; --format rgb24 for -f rawvideo -pix_fmt rgb24 -s 800x600\n"
    "\n"
    "Frames count from 0; A:B includes B; A: and all run to the end. Ctrl-C drops the frame being drawn and\n"
    "keeps those before it. A picture or mask is either whole or absent. The log and the trace grow by a "
    "whole row\n"
    "for each frame whose files are there, and stay, however the program ends. Named pipes, folders and "
    "disks are\n"
    "refused as outputs; /dev/null and /dev/stdout are written to directly. Folders of pictures are made "
    "where "
    "they\n"
    "are missing.\n"
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
  if (auto checked = check(options.mask_means, "--mask mean"); !checked) return checked;
  for (const OutputPattern& mask : options.mask_samples)
    if (mask.is_pfm()) return base::fail("--mask samples:{} are masks of 8 bits; expected .png", mask.text());
  return check(options.mask_samples, "--mask samples");
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
    if (auto checked = check_mask(options, map, "--mask error", several); !checked) return checked;
    if (options.method.render.shadows != render::ShadowMode::soft || options.method.render.soft_points > 0)
      return base::fail("--mask error:{} is for soft shadows with an error; expected --shadows soft{}",
                        map.text(),
                        options.method.render.soft_points > 0 ? " without --paper soft-points" : "");
    for (const OutputPattern& other : options.masks)
      if (map.file(0) == other.file(0))
        return base::fail("--mask and --mask error name the same file {}", map.text());
  }
  for (const OutputPattern& mask : options.mask_colours) {
    if (auto checked = check_mask(options, mask, "--mask colour", several); !checked) return checked;
    for (const OutputPattern& other : options.masks)
      if (mask.file(0) == other.file(0))
        return base::fail("--mask and --mask colour name the same file {}", mask.text());
  }
  return {};
}

/// Frames in a pipe are gone: a later run cannot continue them, and nothing else may be written between them.
Expected<void> check_pipe(const RenderOptions& options) {
  if (options.resume)
    return base::fail(
        "--resume looks for what was written, and frames in a pipe are gone; expected files with it");
  const auto is_stdout = [](const std::string& name) { return name == "/dev/stdout" || name == "/dev/fd/1"; };
  for (const auto& [option, name] :
       {std::pair("--log", options.log), std::pair("--log trace", options.trace)})
    if (is_stdout(name)) return base::fail("-o - and {} {} are both standard output", option, name);
  return {};
}

Expected<void> check_pictures(const RenderOptions& options, bool several) {
  const PictureOptions& pictures = options.pictures;
  if (auto checked = check_picture_options(pictures); !checked) return checked;
  if (pictures.to_pipe) return check_pipe(options);
  if (auto checked = session::check_aovs(pictures.aovs, options.method.render); !checked) return checked;
  return pictures.files ? check_pattern(*pictures.files, "-o", several) : Expected<void>();
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  const std::string run(settings::group_title(settings::Group::run));
  set_examples(command, examples);
  options.pictures.files = OutputPattern::parse("out/%04d.png").value();
  add_scene_options(command, options.scene);
  option_of(command, "SCENE").required();
  add_settings(command, output_table(), options);
  add_method_options(command, options.method);
  for (const char* errors : {"--soft-error", "--ao-error", "--soft-points"})
    option_of(command, "--budget").excludes(option_of(command, errors));
  for (const AddedOption option : add_raster_options(command, options.raster)) option.group(run);
  add_config_option(command);
  option_of(command, "--config").group(run);
}

void settle_render_options(RenderOptions& options) {
  settle_picture_options(options.pictures);
  options.scene.shows = options.pictures.files || options.pictures.to_pipe || !options.error_maps.empty();
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
  if (auto checked = check_scene_settings(options.scene); !checked) return checked;
  return check_method_settings(options.method);
}

}  // namespace tenebra::viewer
