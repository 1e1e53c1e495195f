#include "options/bake_options.h"
#include "options/memory_option.h"

#include <filesystem>

#include "base/fail.h"
#include "options/settings_names.h"

namespace tenebra::viewer {
namespace {

constexpr const char* bake_light_group = "Light";
constexpr const char* bake_map_group = "Lightmap";
constexpr int least_map_px = 16, largest_map_px = 8192, most_per_side = 8, most_rings = 1024;
constexpr int most_places = 32768;  // along a side of the map: 4 GiB of them

constexpr std::array target_choices{Choice<BakeTarget>{"vertices", BakeTarget::vertices},
                                    Choice<BakeTarget>{"lightmap", BakeTarget::lightmap}};
constexpr std::array content_choices{Choice<BakeContent>{"light", BakeContent::light},
                                     Choice<BakeContent>{"ao", BakeContent::ao},
                                     Choice<BakeContent>{"both", BakeContent::both}};

template <const auto& choices, class Target>
AddedOption add_word(CLI::App& command, const char* name, Target& target, const char* help) {
  const auto parse = +[](const std::string& text) { return parse_choice(choices, text); };
  return add_value(command, name, target, parse, help).type_name(choice_list(choices, "|"));
}

/// A whole number from `low` to `high`, of what `unit` says.
Expected<int> parse_within(const std::string& text, int low, int high, const char* unit) {
  const auto number = parse_count(text);
  if (!number || *number < low || *number > high)
    return base::fail("found {}, expected {} to {} {}", text, low, high, unit);
  return number;
}

Expected<int> parse_map_size(const std::string& text) {
  return parse_within(text, least_map_px, largest_map_px, "texels");
}
Expected<int> parse_per_side(const std::string& text) {
  return parse_within(text, 1, most_per_side, "samples each way");
}
Expected<int> parse_rings(const std::string& text) {
  return parse_within(text, 0, most_rings, "texels");
}

Expected<glm::vec3> parse_ambient(const std::string& text) {
  const auto color = parse_vector(text);
  if (!color || std::min({color->x, color->y, color->z}) < 0)
    return base::fail("found {}, expected R,G,B of 0 or more, like 0.3,0.3,0.4", text);
  return color;
}

void add_light_options(CLI::App& command, BakeOptions& options) {
  add_value(command, "--ambient", options.ambient, parse_ambient,
            "Ambient light, which --what both multiplies by openness\n"
            "[the scene's]")
      .type_name("R,G,B")
      .group(bake_light_group);
  add_settings(command, settings::method_table(), options.method,
               {"shadows", "light", "light-size", "sun-size", "emissive-lights", "soft-error", "soft-memory",
                "ao-error", "ao-distance", "threads", "simd"});
}

void add_map_options(CLI::App& command, BakeOptions& options) {
  const AddedOption added[] = {
      add_value(command, "--size", options.size, parse_map_size, "Texels along each side of the map [1024]")
          .type_name("N"),
      add_value(
          command, "--samples", options.per_side, parse_per_side,
          "Samples each way in a texel, so 2 are four in all; each\nlies strictly inside a triangle [2]")
          .type_name("N"),
      add_value(command, "--dilate", options.rings, parse_rings,
                "Texels by which covered areas are widened, so that\n"
                "filtering mixes no black in [16]")
          .type_name("N"),
      add_text(command, "--map", options.map,
               "File of the map: .exr (linear, half) or .png (encoded)\n[OUT with .exr]")
          .type_name("FILE")};
  for (const AddedOption option : added) option.group(bake_map_group);
}

}  // namespace

void add_bake_options(CLI::App& command, BakeOptions& options) {
  options.method.render.ao.error_255 = 1;
  add_text(command, "-o,--output", options.output,
           "The scene to write, .glb: with baked vertex colours, or\n"
           "with the lightmap's texture coordinates")
      .type_name("OUT.glb")
      .required();
  add_word<target_choices>(command, "--to", options.target,
                           "vertices: vertex colours (COLOR_0); lightmap: a picture in\n"
                           "the second set of texture coordinates (TEXCOORD_1)\n"
                           "[vertices]");
  add_word<content_choices>(command, "--what", options.content,
                            "light: that of the scene's lights; ao: openness alone;\n"
                            "both: that light plus ambient light times openness [both]");
  add_value(command, "--exposure", options.exposure, parse_factor,
            "Multiplies light in vertex colours and PNG, which are cut\n"
            "off at 1 [1]")
      .type_name("E");
  add_value(command, "--frame", options.frame, parse_count, "Frame of the animation to bake [0]")
      .type_name("N");
  add_value(command, "--timeout", options.timeout_s, parse_positive,
            "Stop after this many seconds, as Ctrl-C does")
      .type_name("S");
  add_memory_option(command, options.memory_mb);
  add_flag(command, "--quiet", options.quiet, "No progress, no summary and no warnings");
  add_map_options(command, options);
  add_light_options(command, options);
  add_content_options(command, options.scene);
  option_of(command, "SCENE").required();
}

Expected<void> settle_bake_options(const CLI::App& command, BakeOptions& options) {
  settle_memory(command, options.memory_mb, options.method);
  if (!options.output.ends_with(".glb"))
    return base::fail("-o: found {}, expected a name that ends in .glb", options.output);
  if (options.frame && options.scene.time_s) return base::fail("--frame excludes --time");
  const bool map = options.target == BakeTarget::lightmap;
  for (const char* name : {"--size", "--samples", "--dilate", "--map"})
    if (!map && was_given(command, name)) return base::fail("{} is for --to lightmap", name);
  if (!map) return {};
  if (options.size * options.per_side > most_places)
    return base::fail("--size times --samples: found {}, expected at most {}",
                      options.size * options.per_side, most_places);
  if (options.map.empty()) options.map = std::filesystem::path(options.output).replace_extension(".exr");
  if (!options.map.ends_with(".exr") && !options.map.ends_with(".png"))
    return base::fail("--map: found {}, expected a name that ends in .exr or .png", options.map);
  return {};
}

render::RenderSettings bake_settings(const BakeOptions& options, const SceneDisplay& display) {
  MethodOptions method = options.method;
  method.terminator = render::Terminator::flat;
  render::RenderSettings settings = render_settings(method, {}, display);
  settings.ao.mode = options.content == BakeContent::light ? AoMode::none : AoMode::adaptive;
  return settings;
}

}  // namespace tenebra::viewer
