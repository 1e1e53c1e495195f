// What gives lights an area, and how soft shadows are found.
#include "settings/method_rows.h"

namespace tenebra::settings {
namespace {

std::string light_size_text(const LightSize& size) {
  return fmt::format("{}x{}{}", size.size.x, size.size.y, size.percent ? "%" : "");
}

Setting<MethodSettings> light_size() {
  return MethodRow::value(
      {.name = "light-size",
       .value = "W[xH][%]",
       .help =
           "Turns point and spot lights into rectangles of this size, in metres, or (4%) in percent of the "
           "scene's diagonal, of the same brightness; 0: lights without a size keep hard shadows. May be "
           "repeated: facing=X,Y,Z, the point that they "
           "face, in the file's coordinates; emission=point|lambert; sun=DEGREES, the diameter of "
           "directional lights, like 0.53",
       .standard = "1% for lights without a size",
       .used = Used::with_soft,
       .has_keys = true},
      [](auto& method) -> auto& { return method.light_size; }, parse_light_size, light_size_text);
}

void add_light_shapes(MethodRows& rows) {
  rows.push_back(light_size());
  rows.push_back(MethodRow::number(
      {.name = "sun-size",
       .value = "DEGREES",
       .help = "Diameter of directional lights, like 0.53, at the same brightness; 0: hard shadows",
       .standard = "as the scene has it, else 0.53",
       .used = Used::with_soft,
       .range = {0, 90},
       .expected = "degrees from 0 to 90, like 0.53",
       .as = "--light-size sun="},
      [](auto& method) -> auto& { return method.render.area_lights.sun_deg; }));
  rows.push_back(MethodRow::value(
      {.name = "light-facing",
       .value = "X,Y,Z",
       .help = "Point that the rectangles face, in the coordinates of the file",
       .standard = "the scene's centre; spot lights: where they shine",
       .group = Group::shadows,
       .used = Used::with_soft,
       .as = "--light-size facing="},
      [](auto& method) -> auto& { return method.light_facing; }, parse_place, place_text));
  rows.push_back(MethodRow::words(
      {.name = "light-emission",
       .help = "How the rectangles shine. point: in every direction as bright as the point, so soft and hard "
               "shadows have the same light; lambert: to one side, like a lamp's face, as bright as the "
               "point straight ahead",
       .group = Group::shadows,
       .used = Used::with_soft,
       .as = "--light-size emission="},
      [](auto& method) -> auto& { return method.light_emission; }, emission_choices));
  rows.push_back(MethodRow::flag(
      {.name = "emissive-lights",
       .help = "Flat convex meshes with an emissive material are lights too",
       .group = Group::shadows,
       .used = Used::with_soft},
      [](auto& method) -> auto& { return method.render.area_lights.emissive_quads; }));
}

Setting<MethodSettings> soft_memory() {
  const auto read = [](MethodSettings& method, const std::string& text) -> Expected<void> {
    const auto mb = parse_at_least_one(text);
    if (!mb) return tl::unexpected(mb.error());
    set_soft_memory(*mb, method.render.soft);
    return {};
  };
  const auto texts = [](const MethodSettings& method) -> std::vector<std::string> {
    const auto mb = soft_memory_mb(method.render.soft);
    if (!mb) return {};
    return {fmt::format("{}", *mb)};
  };
  return MethodRow::own({.name = "soft-memory",
                         .value = "MB",
                         .help = "Memory for soft shadows, in MB: BSPs, which may have any size within it, "
                                 "candidates, and lists of them; a frame that needs more ends with a message",
                         .standard = "what the system has, and 4 for a BSP",
                         .group = Group::run,
                         .used = Used::with_soft_exact,
                         .as = "--memory soft:"},
                        read, texts);
}

void add_soft_solvers(MethodRows& rows) {
  rows.push_back(MethodRow::words(
      {.name = "soft-solver",
       .help = "How the visible part of a light is found: by the paper's lazy BSP, by clipping, or (auto) "
               "meshes by their silhouettes and the rest by clipping; the picture is the same",
       .audience = Audience::paper,
       .used = Used::with_soft_exact},
      [](auto& method) -> auto& { return method.render.soft.solver; }, solver_choices));
  rows.push_back(MethodRow::words(
      {.name = "soft-grouping",
       .help = "Points that are solved together: neighbours, or as in the paper's Algorithm 2 those of a "
               "triangle",
       .audience = Audience::paper,
       .used = Used::with_soft_exact},
      [](auto& method) -> auto& { return method.render.soft.grouping; }, grouping_choices));
  rows.push_back(MethodRow::words(
      {.name = "soft-choice",
       .help = "Occluder that the BSP takes next; in the paper: random",
       .audience = Audience::paper,
       .used = Used::with_soft_exact},
      [](auto& method) -> auto& { return method.render.soft.choice; }, occluder_choices));
}

void add_soft_accuracy(MethodRows& rows) {
  rows.push_back(soft_memory());
  rows.push_back(MethodRow::number(
      {.name = "soft-points",
       .value = "N",
       .help = "Replaces each area light by N points with exact hard shadows, which leaves steps in the "
               "penumbra and no estimate of the error",
       .standard = "0: as --soft-error says",
       .audience = Audience::paper,
       .used = Used::with_soft,
       .range = {0, 4096},
       .expected = "1 to 4096 points, or 0 for the exact solution",
       .by_quality = {"0", "0", "0"}},
      [](auto& method) -> auto& { return method.render.soft_points; }));
  rows.push_back(MethodRow::number(
      {.name = "soft-error",
       .value = "E",
       .help = "The error aimed at, RMS over the penumbra, in 1/255 of white: dense penumbrae are sampled at "
               "as many places on the light as that takes; the log has the estimate",
       .standard = "0: exact",
       .group = Group::shadows,
       .used = Used::with_soft_exact,
       .range = {.low = 0.1, .high = 255, .or_zero = true},
       .expected = "0 (exact), or 0.1 to 255",
       .by_quality = {"4", "0", "0"}},
      [](auto& method) -> auto& { return method.render.soft.error_255; }));
}

}  // namespace

void add_soft_rows(MethodRows& rows) {
  add_light_shapes(rows);
  add_soft_solvers(rows);
  add_soft_accuracy(rows);
}

}  // namespace tenebra::settings
