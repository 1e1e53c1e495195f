#include "options/method_options.h"

#include "base/fail.h"
#include "options/choices.h"
#include "options/method_groups.h"
#include "render/antialias/pattern.h"

namespace tenebra::viewer {
namespace {

constexpr int most_downscale = 8;

constexpr const char* quality_option = "--quality";
constexpr const char* error_option = "--ao-error";
constexpr const char* rays_option = "--ao-rays";
constexpr const char* downscale_option = "--ao-downscale";

Expected<Variant> parse_variant(const std::string& text) {
  for (int i = 0; i <= static_cast<int>(Variant::precise_seatp); ++i)
    if (is_word(text, variant_name(static_cast<Variant>(i)))) return static_cast<Variant>(i);
  return base::fail(
      "found {}, expected Tiles, Precise, PreciseSorted, Spheres, SpheresSorted, PreciseSEA, PreciseEATP or "
      "PreciseSEATP",
      text);
}

Expected<int> parse_samples(const std::string& text) {
  const auto samples = parse_count(text);
  if (!samples || *samples > 16 || !render::is_sample_count(*samples))
    return base::fail("found {}, expected 1, 2, 4, 8 or 16 samples per pixel", text);
  return samples;
}

Expected<int> parse_downscale(const std::string& text) {
  const auto scale = parse_count(text);
  if (!scale || *scale < 1 || *scale > most_downscale)
    return base::fail("found {}, expected 1 (every pixel) to {}", text, most_downscale);
  return scale;
}

Expected<render::Quality> parse_quality(const std::string& text) {
  if (const auto quality = render::quality_from_name(lower_case(text))) return *quality;
  return base::fail("found {}, expected fast, balanced or exact", text);
}

Expected<int> parse_bits(const std::string& text) {
  const auto bits = parse_count(text);
  if (!bits || (*bits != 1 && *bits != 8 && *bits != 32))
    return base::fail("found {}, expected 1, 8 or 32", text);
  return bits;
}

Expected<std::filesystem::path> parse_cache(const std::string& text) {
  if (text.empty()) return base::fail("found an empty name, expected a folder or none");
  return text == "none" ? std::filesystem::path() : std::filesystem::path(text);
}

AddedOption add_exposure(CLI::App& command, MethodOptions& options) {
  const auto read = [&options](const std::string& text) -> Expected<void> {
    options.auto_exposure = is_word(text, "auto");
    if (options.auto_exposure) return {};
    const auto factor = parse_factor(text);
    if (!factor) return base::fail("{}, or auto", factor.error().message);
    options.render.exposure = *factor;
    return {};
  };
  return add_reader(command, "--exposure", read,
                    "Multiplies all light by this factor; auto: by one that\nleaves at most a hundredth of "
                    "the pixels too bright,\nthe same for the whole animation [1]")
      .type_name("E|auto");
}

void add_common(CLI::App& command, MethodOptions& options) {
  render::RenderSettings& render = options.render;
  render.antialias = standard_antialias;
  set_group(
      {add_value(command, quality_option, options.quality, parse_quality,
                 "Accuracy of soft shadows and ambient occlusion.\n"
                 "fast: --soft-error 4 --ao-error 5 (penumbrae off by\n"
                 "0 to 4/255 RMS), with --ao field --ao-rays 16\n"
                 "--ao-downscale 2 (occlusion off by 1 to 7);\n"
                 "balanced: the defaults (exact; 2.5; fields 1 to 6);\n"
                 "exact: --ao-error 1, fields --ao-rays 256 (1 to 5);\n"
                 "docs/trade.md has all figures. These options win if\n"
                 "they are given themselves")
           .type_name("fast|balanced|exact"),
       add_choice<shadow_choices>(command, "--shadows", render.shadows,
                                  "hard: each light as a point; soft: with its area;\nboth exact and "
                                  "without noise [hard]"),
       add_choice<see_through_choices>(command, "--see-through", render.see_through,
                                       "Glass and blended surfaces colour the light behind them,\ncast black "
                                       "shadows, or none [tint]"),
       add_choice<terminator_choices>(command, "--terminator", options.terminator,
                                      "Where grazing light ends: on the smooth surface that\n"
                                      "normals describe, from where shadows then start; or (flat)\n"
                                      "at the planes of the triangles, which shows teeth\n"
                                      "[smooth; render with a mask of any kind: flat]"),
       add_value(command, "--light", render.light, parse_light,
                 "Light with this light alone, by number, or with all [all]")
           .type_name("N|all"),
       add_exposure(command, options),
       add_choice<tone_choices>(
           command, "--tone", options.tone,
           "How bright colours are fitted into a picture: cut off\n(none), by Khronos PBR "
           "Neutral, or like film by a fit to\nACES [neutral; none for AFF and NFF and with\n"
           "--transfer display]"),
       add_value(command, "--antialias", render.antialias, parse_samples,
                 "Samples of pixels with an edge, a shadow's edge or a fine\ntexture: 1, 2, 4, 8 or 16; all "
                 "others have one [4]")
           .type_name("N"),
       add_value(command, "--threads", render.threads, parse_threads,
                 "Threads for shadows and ambient occlusion [0: all cores]")
           .type_name("N"),
       add_value(command, "--simd", render.hard.simd, parse_simd,
                 "Vector instructions: auto, scalar, sse4, avx2, avx512 or, on\n"
                 "ARM, neon; the masks are the same with each [auto]")
           .type_name("LEVEL")},
      shadow_group);
}

void add_hard(CLI::App& command, MethodOptions& options) {
  set_group(
      {add_value(command, "--variant", options.render.hard.variant, parse_variant,
                 "Method: Tiles, or the paper's Precise, PreciseSorted, Spheres,\nSpheresSorted, PreciseSEA, "
                 "PreciseEATP or PreciseSEATP;\nthe mask is the same with each [Tiles]")
           .type_name("V"),
       add_choice<sample_choices>(command, "--samples", options.render.samples,
                                  "Where shadow rays start: at exact points, from triangle\nids, or as in "
                                  "the paper from the depth buffer [ids]"),
       add_choice<cull_choices>(command, "--cull", options.cull_front,
                                "front: only faces turned away from the light cast\nshadows; for closed "
                                "meshes [none; front with\n--samples depth]")},
      hard_group);
}

void add_ao(CLI::App& command, AoConfig& ao) {
  ao.cache = default_cache_folder();
  set_group(
      {add_choice<ao_choices>(command, "--ao", ao.mode,
                              "adaptive: by rays where the picture needs them, as many\n"
                              "as --ao-error takes, filtered; field: by displacement\n"
                              "fields of the rigid objects; rays: by casting rays\n"
                              "everywhere, for comparison [none]"),
       add_value(command, error_option, ao.error_255, parse_positive,
                 "adaptive: the error aimed at, RMS over the picture, in\n"
                 "1/255; the log has the estimate [2.5]")
           .type_name("E"),
       add_choice<place_choices>(command, "--ao-at", ao.place,
                                 "Where occlusion is computed; in the paper: at vertices\n"
                                 "[pixels]"),
       add_choice<layout_choices>(command, "--ao-layout", ao.layout,
                                  "What a field stores: chords from entry to exit, or as in\nthe paper "
                                  "positions x directions [chords]"),
       add_value(command, rays_option, ao.rays, parse_at_least_one, "Rays per point [64]").type_name("N"),
       add_value(command, downscale_option, ao.downscale, parse_downscale,
                 "Computes one of N x N pixels and blurs the others from\nsimilar ones [1: every pixel]")
           .type_name("N"),
       add_value(
           command, "--ao-distance", ao.distance_m, parse_positive,
           "Reach D in metres: occlusion is the mean of\nmax(0, 1 - d / D) over rays distributed by the "
           "cosine to\nthe normal, each of which first meets a triangle at d\n[a twentieth of the "
           "scene's diagonal]")
           .type_name("D"),
       add_value(command, "--ao-positions", ao.positions, parse_at_least_one,
                 "Samples on an object's bounding sphere [4225]")
           .type_name("P"),
       add_value(command, "--ao-directions", ao.directions, parse_square_count,
                 "Directions per sample, 1024 or 32x32 [1024]")
           .type_name("D"),
       add_value(command, "--ao-bits", ao.bits, parse_bits, "Bits per stored distance [8]")
           .type_name("1|8|32"),
       add_choice<deforming_choices>(command, "--ao-deforming", ao.deforming,
                                     "Objects that deform have no field: cast rays at them, or\n"
                                     "leave them out [rays]"),
       add_value(command, "--ao-cache", ao.cache, parse_cache,
                 "Folder that keeps trees of triangles, fields and surface\nsamples for the next run; any "
                 "number of "
                 "processes may\nshare it [$XDG_CACHE_HOME/tenebra or ~/.cache/tenebra]")
           .type_name("FOLDER|none"),
       add_value(command, "--ao-memory", ao.memory_mb, parse_at_least_one,
                 "Memory for fields and surface samples, in MB; the least\n"
                 "recently used are dropped first. For bodies without room\n"
                 "rays are cast, which takes longer [512]")
           .type_name("MB")},
      ao_group);
}

/// Why the mode of ambient occlusion does not look at its option `name`; empty if it does.
std::string idle_in(AoMode mode, const std::string& name) {
  const bool of_all =
      name == "--ao" || name == "--ao-distance" || name == "--ao-deforming" || name == "--ao-cache";
  if (of_all || (mode == AoMode::adaptive) == (name == error_option)) return {};
  return mode == AoMode::adaptive ? "with --ao adaptive" : "without --ao adaptive";
}

/// Why the chosen methods do not look at `option`; empty if they do.
std::string idle_for(const GivenOption& option, const render::RenderSettings& render) {
  const auto& [name, group] = option;
  const bool soft = render.shadows == render::ShadowMode::soft, ao = render.ao.mode != AoMode::none;
  if (name == quality_option && !soft && !ao) return "without --shadows soft or --ao";
  if (group == hard_group && render.shadows == render::ShadowMode::none) return "with --shadows none";
  if (group == soft_group && !soft) return "without --shadows soft";
  // --soft-solver, --soft-precision and their like.
  if (name.starts_with("--soft-") && name != points_option && render.soft_points > 0)
    return fmt::format("where lights are {} points", render.soft_points);
  if (group == ao_group && !ao && name != "--ao") return "without --ao";
  if (group == ao_group && ao) return idle_in(render.ao.mode, name);
  return {};
}

}  // namespace

void add_method_options(CLI::App& command, MethodOptions& options) {
  add_common(command, options);
  add_hard(command, options);
  add_soft_options(command, options);
  add_ao(command, options.render.ao);
}

void add_tracer_options(CLI::App& command, MethodOptions& options) {
  render::RenderSettings& render = options.render;
  add_value(command, "--light", render.light, parse_light, "This light alone, by number, or all [all]")
      .type_name("N|all");
  add_value(command, "--variant", render.hard.variant, parse_variant,
            "Method: Tiles, or one of the paper's, like PreciseSorted\n[Tiles]")
      .type_name("V");
  add_choice<cull_choices>(command, "--cull", options.cull_front,
                           "front: only faces turned away from the light cast\nshadows [none]");
  add_value(command, "--threads", render.threads, parse_threads, "Threads [0: all cores]").type_name("N");
  add_value(command, "--simd", render.hard.simd, parse_simd,
            "Vector instructions: auto, scalar, sse4, avx2, avx512 or, on\nARM, neon [auto]")
      .type_name("LEVEL");
}

void settle_quality(const CLI::App& command, MethodOptions& options) {
  if (!options.quality) return;
  const render::RenderSettings given = options.render;
  render::apply_quality(*options.quality, options.render);
  const bool points = was_given(command, points_option);
  if (points) options.render.soft_points = given.soft_points;
  if (points || was_given(command, soft_error_option)) options.render.soft.error_255 = given.soft.error_255;
  if (was_given(command, error_option)) options.render.ao.error_255 = given.ao.error_255;
  if (was_given(command, rays_option)) options.render.ao.rays = given.ao.rays;
  if (was_given(command, downscale_option)) options.render.ao.downscale = given.ao.downscale;
}

Expected<void> check_method_options(const MethodOptions& options) {
  const render::RenderSettings& render = options.render;
  const bool soft = render.shadows == render::ShadowMode::soft;
  if (render.samples == render::SampleSource::depth && (soft || render.ao.mode != AoMode::none)) {
    return base::fail("--samples depth has no exact points, and {} needs them; expected --samples ids",
                      soft ? "--shadows soft" : "--ao");
  }
  if (render.samples == render::SampleSource::depth && options.terminator == render::Terminator::smooth) {
    return base::fail(
        "--samples depth has no exact points, and --terminator smooth needs them; expected "
        "--samples ids");
  }
  if (soft && options.cull_front.value_or(false)) {
    return base::fail("--cull front is for hard shadows, and with --shadows soft every face casts");
  }
  return {};
}

std::vector<std::string> idle_method_options(const CLI::App& command, const MethodOptions& options) {
  std::vector<std::string> sentences;
  for (const GivenOption& option : given_options(command)) {
    if (const std::string lack = idle_for(option, options.render); !lack.empty())
      sentences.push_back(fmt::format("{} does nothing {}", option.name, lack));
  }
  return sentences;
}

shade::Tone tone_of(const MethodOptions& options, Transfer transfer) {
  return options.tone.value_or(transfer == Transfer::srgb ? shade::Tone::neutral : shade::Tone::none);
}

render::RenderSettings method_settings(const MethodOptions& options, Size size, const SceneDisplay& display) {
  render::RenderSettings settings = options.render;
  settings.tone = tone_of(options, display.transfer);
  if (options.auto_exposure && display.exposures)
    settings.exposure = (*display.exposures)[static_cast<std::size_t>(settings.tone)];
  settings.width = size.width;
  settings.height = size.height;
  // Points from the depth buffer lie off their triangles: only the paper's front-face culling keeps those
  // from shadowing their own points.
  const bool from_depth = settings.samples == render::SampleSource::depth;
  settings.hard.cull_front = options.cull_front.value_or(from_depth);
  settings.hard.contact = from_depth ? ContactRule::none : ContactRule::triangle_ids;
  settings.terminator =
      from_depth ? render::Terminator::flat : options.terminator.value_or(render::Terminator::smooth);
  settings.soft.simd = settings.ao.simd = settings.hard.simd;
  settings.area_lights.emission = options.light_emission;
  if (options.light_size) {
    settings.area_lights.size = options.light_size->size;
    settings.area_lights.percent_of_diagonal = options.light_size->percent;
  }
  return settings;
}

}  // namespace tenebra::viewer
