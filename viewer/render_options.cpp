#include "render_options.h"

namespace tenebra::viewer {
namespace {

constexpr const char* examples =
    "Examples:\n"
    "  tenebra render scenes/city.glb\n"
    "      the first frame at 800x600, to out/0000.png\n"
    "  tenebra render scenes/city.glb --frames 0:99 -o walk/%04d.png --log walk.csv\n"
    "      a hundred frames and what each took\n"
    "  tenebra render Robot.aff --no-cast city2.aff:69 --frames 160 --size 1024x1024 --mask mask.png -o "
    "none\n"
    "      only the shadow mask: 255 lit, 0 shadowed\n"
    "  tenebra render room.glb --eye 0,1.6,4 --look-at 0,1,0 --fov 50 --light 0\n"
    "      another camera, one light\n"
    "\n"
    "Frames count from 0; A:B includes B; A: and all run to the end. Ctrl-C stops after the frame at hand, "
    "with the\n"
    "log whole. Files are whole or absent; the last folder of a picture's name is made if it is missing.\n"
    "Exit code: 0 done, 1 failed (one sentence says why), 130 or 143 stopped by a signal.";

template <class Value, class Parse>
Expected<Value> from_name(const std::string& text, Parse parse, const char* expected) {
  if (const auto value = parse(text)) return *value;
  return fail("found {}, expected {}", text, expected);
}

Expected<ShadowMode> parse_shadows(const std::string& text) {
  if (text == "hard") return ShadowMode::hard;
  if (text == "none") return ShadowMode::none;
  return fail("found {}, expected hard or none", text);
}

Expected<SampleSource> parse_samples(const std::string& text) {
  if (text == "ids") return SampleSource::ids;
  if (text == "depth") return SampleSource::depth;
  return fail("found {}, expected ids or depth", text);
}

Expected<bool> parse_cull(const std::string& text) {
  if (text == "front") return true;
  if (text == "none") return false;
  return fail("found {}, expected front or none", text);
}

Expected<Variant> parse_variant(const std::string& text) {
  return from_name<Variant>(
      text, variant_from_name,
      "Precise, PreciseSorted, Spheres, SpheresSorted, PreciseSEA, PreciseEATP or PreciseSEATP");
}

Expected<SimdLevel> parse_simd(const std::string& text) {
  const auto level = from_name<SimdLevel>(text, simd_level_from_name, "auto, scalar, sse4, avx2 or avx512");
  if (level && *level != SimdLevel::automatic && !simd_level_supported(*level)) {
    return fail("this machine or build has no {}, its best is {}", text, simd_level_name(best_simd_level()));
  }
  return level;
}

Expected<gl::ContextKind> parse_context(const std::string& text) {
  return from_name<gl::ContextKind>(text, gl::context_kind_from_name, "auto, egl or osmesa");
}

Expected<int> parse_light(const std::string& text) {
  if (text == "all") return -1;
  const auto number = parse_count(text);
  return number ? number : fail("found {}, expected the number of a light, from 0, or all", text);
}

Expected<int> parse_cone_sides(const std::string& text) {
  const auto sides = parse_count(text);
  if (!sides || *sides < 3 || *sides > 4096) return fail("found {}, expected 3 to 4096", text);
  return sides;
}

Expected<int> parse_threads(const std::string& text) {
  const auto threads = parse_count(text);
  if (!threads || *threads > 1024) return fail("found {}, expected 1 to 1024, or 0 for all cores", text);
  return threads;
}

Expected<float> parse_exposure(const std::string& text) {
  const auto exposure = parse_positive(text);
  if (!exposure || static_cast<float>(*exposure) == 0.0f || *exposure > 1e30) {
    return fail("found {}, expected a factor above 0, like 1.5", text);
  }
  return static_cast<float>(*exposure);
}

Expected<std::optional<OutputPattern>> parse_pictures(const std::string& text) {
  if (text == "none") return std::optional<OutputPattern>();
  auto pattern = OutputPattern::parse(text);
  if (!pattern) return tl::unexpected(pattern.error());
  return std::optional<OutputPattern>(std::move(*pattern));
}

void add_scene_options(CLI::App& command, RenderOptions& options) {
  command.add_option("SCENE", options.scene, "Scene file: .gltf .glb .aff .nff .obj")->required();
  command
      .add_option("--no-cast", options.no_cast,
                  "Mesh, material or (AFF) FILE:LINE that casts no shadow; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  add_value(command, "--cone-sides", options.import.cone_sides, parse_cone_sides,
            "AFF: sides of cones and cylinders [64; the paper's count needs 8]")
      ->type_name("N");
}

void add_time_options(CLI::App& command, RenderOptions& options) {
  auto* frames = add_value(command, "--frames", options.frames, parse_frame_range,
                           "Frames to render, 0:99:10 for every tenth [0, the first]")
                     ->type_name("A:B[:STEP]|all");
  add_value(command, "--time", options.time_s, parse_time, "One picture at this time of the animation")
      ->type_name("S")
      ->excludes(frames);
  add_value(command, "--fps", options.fps, parse_positive,
            "Frames a second where the scene does not state\nits frames (glTF) [30]")
      ->type_name("F");
  command.add_option("--clip", options.clip, "Animation, by name or number [the first]")->type_name("NAME|N");
}

void add_camera_options(CLI::App& command, RenderOptions& options) {
  auto* camera =
      command.add_option("--camera", options.camera, "Camera of the scene, by name or number [the first]")
          ->type_name("NAME|N");
  auto* eye =
      add_value(command, "--eye", options.eye, parse_vector, "Camera at this place instead, in world space")
          ->type_name("X,Y,Z")
          ->excludes(camera);
  auto* look_at =
      add_value(command, "--look-at", options.look_at, parse_vector, "What it looks at")->type_name("X,Y,Z");
  auto* up = add_value(command, "--up", options.up, parse_vector, "What is up [0,1,0]")->type_name("X,Y,Z");
  eye->needs(look_at);
  look_at->needs(eye);
  up->needs(eye);
  add_value(command, "--fov", options.fov_deg, parse_field_of_view,
            "Full vertical field of view in degrees [the camera's; 45 with --eye]")
      ->type_name("D");
  add_value(command, "--size", options.size, parse_size,
            "Size in pixels [800x600, or 800 wide with the camera's aspect]")
      ->type_name("WxH");
  add_value(command, "--exposure", options.render.exposure, parse_exposure, "Factor of the light [1]")
      ->type_name("E");
}

void add_shadow_options(CLI::App& command, RenderOptions& options) {
  RenderSettings& render = options.render;
  add_value(command, "--shadows", render.shadows, parse_shadows, "Shadows [hard]")->type_name("hard|none");
  add_value(command, "--variant", render.hard.variant, parse_variant,
            "Precise, PreciseSorted, Spheres, SpheresSorted, PreciseSEA, PreciseEATP or PreciseSEATP: the "
            "same mask "
            "by other work [PreciseSorted]")
      ->type_name("V");
  add_value(
      command, "--samples", render.samples, parse_samples,
      "Where shadow rays start: exact points from triangle\nids, or the paper's from the depth buffer [ids]")
      ->type_name("ids|depth");
  add_value(command, "--cull", options.cull_front, parse_cull,
            "front: only faces turned away from the light cast;\nfor closed meshes [none; front with depth "
            "samples]")
      ->type_name("front|none");
  add_value(command, "--light", render.light, parse_light, "One light, by number, or all [all]")
      ->type_name("N|all");
  add_value(command, "--threads", render.threads, parse_threads, "Threads of the shadow pass [0: all cores]")
      ->type_name("N");
  add_value(command, "--simd", render.hard.simd, parse_simd,
            "Vector instructions: auto, scalar, sse4, avx2 or avx512;\nthe same mask with each [auto]")
      ->type_name("LEVEL");
  add_value(command, "--context", options.context, parse_context, "Offscreen OpenGL [auto: EGL, else OSMesa]")
      ->type_name("auto|egl|osmesa");
}

void add_output_options(CLI::App& command, RenderOptions& options) {
  options.pictures = OutputPattern::parse("out/%04d.png").value();
  add_value(command, "-o,--output", options.pictures, parse_pictures,
            "Pictures, %04d is the frame; none: no pictures [out/%04d.png]")
      ->type_name("FILE.png");
  add_value(command, "--mask", options.masks, OutputPattern::parse,
            "Shadow masks: 255 lit, 0 shadowed, turned away or background;\nseveral lights add _L0, _L1, ...")
      ->type_name("FILE.png");
  command.add_option("--log", options.log, "Time and work of each frame")->type_name("FILE.csv");
  command.add_option("--trace", options.trace, "The same for Perfetto or chrome://tracing")
      ->type_name("FILE.json");
  command.add_flag("--quiet", options.quiet, "No progress, warnings or summary");
}

bool draws_several_frames(const RenderOptions& options) {
  return options.frames && options.frames->last != options.frames->first;
}

Expected<void> check_pattern(const std::optional<OutputPattern>& pattern, const char* option, bool several) {
  if (!pattern || !several || pattern->is_numbered()) return {};
  return fail(
      "{} {} has no frame number, and several frames would overwrite each other; expected one like %04d",
      option, pattern->text());
}

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
  command.footer(examples);
  add_scene_options(command, options);
  add_time_options(command, options);
  add_camera_options(command, options);
  add_shadow_options(command, options);
  add_output_options(command, options);
}

Expected<void> check_render_options(const RenderOptions& options) {
  const bool several = draws_several_frames(options);
  if (auto checked = check_pattern(options.pictures, "-o", several); !checked) return checked;
  if (auto checked = check_pattern(options.masks, "--mask", several); !checked) return checked;
  if (options.masks && options.render.shadows == ShadowMode::none) {
    return fail("--mask needs shadows, and --shadows none makes no mask");
  }
  if (options.masks && options.pictures && options.masks->file(0) == options.pictures->file(0)) {
    return fail("-o and --mask name the same file {}", options.pictures->text());
  }
  if (options.eye && *options.eye == options.look_at) return fail("--eye and --look-at are the same point");
  if (options.eye && options.up == glm::vec3(0.0f)) return fail("--up is 0,0,0, expected a direction");
  return {};
}

}  // namespace tenebra::viewer
