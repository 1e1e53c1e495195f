// The options of soft shadows.
#include "base/fail.h"
#include "options/method_groups.h"

namespace tenebra::viewer {
namespace {

constexpr int most_soft_points = 4096;
constexpr std::size_t any_size = ~std::size_t{0};  // of a BSP

Expected<int> parse_points(const std::string& text) {
  const auto points = parse_count(text);
  if (!points || *points > most_soft_points) {
    return base::fail("found {}, expected 1 to {} points, or 0 for the exact solution", text,
                      most_soft_points);
  }
  return points;
}

/// What gives lights an area.
void add_light_shapes(CLI::App& command, MethodOptions& options) {
  render::AreaLightSettings& lights = options.render.area_lights;
  const auto size = add_value(command, "--light-size", options.light_size, parse_light_size,
                              "Turns point and spot lights into rectangles of this size,\n"
                              "in metres, or (4%) in percent of the scene's diagonal, of\n"
                              "the same brightness [they stay points]")
                        .type_name("W[xH][%]");
  const auto sun = add_value(command, "--sun-size", lights.sun_deg, parse_sun_size,
                             "Diameter of directional lights, like 0.53, at the same\n"
                             "brightness; 0: hard shadows [as the scene has it]")
                       .type_name("DEGREES");
  const auto facing =
      add_value(command, "--light-facing", lights.facing, parse_vector,
                "Point that those rectangles face [the scene's centre;\nspot lights: where they shine]")
          .type_name("X,Y,Z")
          .needs(size);
  const auto emission = add_choice<emission_choices>(command, "--light-emission", options.light_emission,
                                                     "How those rectangles shine. point: in every direction "
                                                     "as\nbright as the point, so soft and hard shadows have "
                                                     "the\nsame light; lambert: to one side, like a lamp's "
                                                     "face,\nas bright as the point straight ahead [point]");
  const auto emissive = add_flag(command, "--emissive-lights", lights.emissive_quads,
                                 "Flat convex meshes with an emissive material are lights too");
  set_group({size, sun, facing, emission, emissive}, soft_group);
}

void add_soft_solvers(CLI::App& command, SoftShadowConfig& soft) {
  set_group(
      {add_choice<solver_choices>(command, "--soft-solver", soft.solver,
                                  "How the visible part of a light is found: by the paper's\nlazy BSP, by "
                                  "clipping, or (auto) meshes by their\nsilhouettes and the rest by "
                                  "clipping; the picture is\nthe same [auto]"),
       add_choice<precision_choices>(command, "--soft-precision", soft.precision,
                                     "reference: double precision throughout [fast]"),
       add_soft_memory(command, soft,
                       "Memory for soft shadows, in MB: BSPs, which may have any\n"
                       "size within it, candidates, and lists of them; a frame\n"
                       "that needs more ends with a message [what the system\n"
                       "has, and 4 for a BSP]")},
      soft_group);
}

}  // namespace

void add_soft_options(CLI::App& command, MethodOptions& options) {
  SoftShadowConfig& soft = options.render.soft;
  add_light_shapes(command, options);
  add_soft_solvers(command, soft);
  set_group(
      {add_choice<grouping_choices>(command, "--soft-grouping", soft.grouping,
                                    "Points that are solved together: neighbours, or as in\nthe paper's "
                                    "Algorithm 2 those of a triangle\n[neighbourhood]"),
       add_choice<occluder_choices>(command, "--soft-choice", soft.choice,
                                    "Occluder that the BSP takes next; in the paper: random\n[largest]"),
       add_value(command, points_option, options.render.soft_points, parse_points,
                 "Replaces each area light by N points with exact hard\n"
                 "shadows, which leaves steps in the penumbra and no estimate\n"
                 "of the error [0: as --soft-error says]")
           .type_name("N"),
       add_value(command, soft_error_option, soft.error_255, parse_soft_error,
                 "The error aimed at, RMS over the penumbra, in 1/255 of\n"
                 "white: dense penumbrae are sampled at as many places on\n"
                 "the light as that takes; the log has the estimate\n"
                 "[0: exact]")
           .type_name("E")},
      soft_group);
}

void add_soft_tracer_options(CLI::App& command, MethodOptions& options) {
  add_choice<shadow_choices>(
      command, "--shadows", options.render.shadows,
      "hard: masks; soft: visible fractions of lights with an area,\nmasks of the others "
      "[hard]");
  add_light_shapes(command, options);
  add_soft_solvers(command, options.render.soft);
}

AddedOption add_soft_memory(CLI::App& command, SoftShadowConfig& soft, const char* help) {
  const auto read = [&soft](const std::string& text) -> Expected<void> {
    const auto mb = parse_at_least_one(text);
    if (!mb) return tl::unexpected(mb.error());
    set_soft_memory(*mb, soft);
    return {};
  };
  return add_reader(command, "--soft-memory", read, help).type_name("MB");
}

void set_soft_memory(int mb, SoftShadowConfig& soft) {
  soft.memory_bytes = bytes_of_mb(mb);
  soft.tree_bytes = any_size;
}

std::optional<int> soft_memory_mb(const SoftShadowConfig& soft) {
  if (!soft.memory_bytes || soft.tree_bytes != any_size) return std::nullopt;
  return static_cast<int>(*soft.memory_bytes >> 20);
}

}  // namespace tenebra::viewer
