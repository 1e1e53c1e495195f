// Shadows and picture; ao_rows.cpp and soft_rows.cpp have the rest of the table.
#include "base/fail.h"
#include "settings/method_rows.h"
#include "settings/tables.h"

namespace tenebra::settings {
namespace {

constexpr std::array antialias_choices{Choice<int>{"1", 1}, Choice<int>{"2", 2}, Choice<int>{"4", 4},
                                       Choice<int>{"8", 8}, Choice<int>{"16", 16}};
constexpr std::array quality_choices{Choice<Quality>{"fast", Quality::fast},
                                     Choice<Quality>{"balanced", Quality::balanced},
                                     Choice<Quality>{"exact", Quality::exact}};

Setting<MethodSettings> exposure() {
  const auto read = [](MethodSettings& method, const std::string& text) -> Expected<void> {
    method.auto_exposure = is_word(text, "auto");
    method.exposure_given = false;
    if (method.auto_exposure) return {};
    const auto factor = parse_factor(text);
    if (!factor) return base::fail("{}, or auto", factor.error().message);
    method.render.exposure = *factor;
    method.exposure_given = true;
    return {};
  };
  const auto texts = [](const MethodSettings& method) -> std::vector<std::string> {
    if (method.auto_exposure) return {"auto"};
    if (!method.exposure_given) return {};
    return {fmt::format("{}", method.render.exposure)};
  };
  return MethodRow::own({.name = "exposure",
                         .value = "E|auto",
                         .help = "Multiplies all light by this factor; auto: by one that leaves at most a "
                                 "hundredth of the pixels too bright, the same for the whole animation",
                         .standard = "1; auto where lights have units, or 1 shows too much or too little"},
                        read, texts);
}

Setting<MethodSettings> variant() {
  About about{.name = "variant",
              .help =
                  "Method of hard shadows: Tiles, or one of the seven of the paper's Table 1; the mask is "
                  "the same with each",
              .audience = Audience::paper,
              .used = Used::with_shadows};
  for (int i = 0; i <= static_cast<int>(Variant::precise_seatp); ++i)
    about.words.push_back(variant_name(static_cast<Variant>(i)));
  const auto parse = [](const std::string& text) -> Expected<Variant> {
    for (int i = 0; i <= static_cast<int>(Variant::precise_seatp); ++i)
      if (is_word(text, variant_name(static_cast<Variant>(i)))) return static_cast<Variant>(i);
    return base::fail(
        "found {}, expected Tiles, Precise, PreciseSorted, Spheres, SpheresSorted, PreciseSEA, PreciseEATP "
        "or PreciseSEATP",
        text);
  };
  return MethodRow::value(
      about, [](auto& method) -> auto& { return method.render.hard.variant; }, parse,
      [](Variant variant) { return std::string(variant_name(variant)); });
}

void add_accuracy(MethodRows& rows) {
  rows.push_back(MethodRow::words(
      {.name = "quality",
       .help =
           "Accuracy of soft shadows and ambient occlusion. fast: --soft-error 4 --ao-error 5 (penumbrae off "
           "by 0 to 4/255 RMS), with --ao field --ao-rays 16 and --paper ao-downscale=2 (occlusion off by 1 "
           "to 7); balanced: the defaults (exact; 2.5; fields 1 to 6); exact: --ao-error 1, fields --ao-rays "
           "256 (1 to 5); docs/trade.md has all figures. Settings that are given themselves win",
       .standard = "balanced",
       .used = Used::with_accuracy},
      [](auto& method) -> auto& { return method.quality; }, quality_choices));
  rows.push_back(MethodRow::words(
      {.name = "shadows",
       .help = "hard: each light as a point; soft: with its area; both exact and without noise"},
      [](auto& method) -> auto& { return method.render.shadows; }, shadow_choices));
}

void add_surfaces(MethodRows& rows) {
  rows.push_back(MethodRow::words(
      {.name = "see-through",
       .help = "Glass and blended surfaces colour the light behind them, cast black shadows, or none",
       .group = Group::shadows},
      [](auto& method) -> auto& { return method.render.see_through; }, see_through_choices));
  rows.push_back(MethodRow::words(
      {.name = "terminator",
       .help = "Where grazing light ends: on the smooth surface that normals describe, from where shadows "
               "then start; or (flat) at the planes of the triangles, which shows teeth",
       .standard = "smooth; render with a mask of any kind: flat",
       .group = Group::shadows},
      [](auto& method) -> auto& { return method.terminator; }, terminator_choices));
  rows.push_back(MethodRow::value(
      {.name = "light",
       .value = "N|all",
       .help = "Light with this light alone, by number, or with all",
       .group = Group::shadows},
      [](auto& method) -> auto& { return method.render.light; }, parse_light,
      [](int light) { return light < 0 ? std::string("all") : fmt::format("{}", light); }));
}

void add_picture(MethodRows& rows) {
  rows.push_back(exposure());
  rows.push_back(MethodRow::words(
      {.name = "tone",
       .help = "How bright colours are fitted into a picture: cut off (none), by Khronos PBR Neutral, or "
               "like film by a fit to ACES",
       .standard = "neutral; none for AFF and NFF and with --transfer display",
       .group = Group::picture},
      [](auto& method) -> auto& { return method.tone; }, tone_choices));
  rows.push_back(MethodRow::words(
      {.name = "antialias",
       .help = "Samples of pixels with an edge, a shadow's edge or a fine texture: 1, 2, 4, 8 or 16; all "
               "others have one",
       .group = Group::picture},
      [](auto& method) -> auto& { return method.render.antialias; }, antialias_choices));
}

void add_machine(MethodRows& rows) {
  rows.push_back(MethodRow::number(
      {.name = "threads",
       .value = "N",
       .help = "Threads for shadows and ambient occlusion; the pictures are the same with each",
       .standard = "0: all cores",
       .group = Group::run,
       .affects = Affects::speed,
       .range = {0, 1024},
       .expected = "1 to 1024, or 0 for all cores"},
      [](auto& method) -> auto& { return method.render.threads; }));
  rows.push_back(MethodRow::value(
      {.name = "simd",
       .value = "LEVEL",
       .help = "Vector instructions: auto, scalar, sse4, avx2, avx512 or, on ARM, neon; the pictures are the "
               "same with each",
       .group = Group::run,
       .affects = Affects::speed},
      [](auto& method) -> auto& { return method.render.hard.simd; }, parse_simd,
      [](SimdLevel level) { return std::string(simd_level_name(level)); }));
}

void add_hard(MethodRows& rows) {
  rows.push_back(variant());
  rows.push_back(MethodRow::words(
      {.name = "samples",
       .help = "Where shadow rays start: at exact points, from triangle ids, or as in the paper from the "
               "depth buffer",
       .audience = Audience::paper,
       .used = Used::with_shadows},
      [](auto& method) -> auto& { return method.render.samples; }, sample_choices));
  rows.push_back(MethodRow::words(
      {.name = "cull",
       .help = "front: only faces turned away from the light cast shadows; for closed meshes",
       .standard = "none; front with samples=depth",
       .audience = Audience::paper,
       .used = Used::with_shadows},
      [](auto& method) -> auto& { return method.cull_front; }, cull_choices));
}

MethodRows method_rows() {
  MethodRows rows;
  add_accuracy(rows);
  add_surfaces(rows);
  add_picture(rows);
  add_machine(rows);
  add_hard(rows);
  add_soft_rows(rows);
  add_ao_rows(rows);
  return rows;
}

}  // namespace

std::span<const Setting<MethodSettings>> method_table() {
  static const MethodRows rows = method_rows();
  return rows;
}

}  // namespace tenebra::settings
