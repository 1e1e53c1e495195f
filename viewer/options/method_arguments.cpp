#include "options/method_arguments.h"

#include <fmt/core.h>

#include <algorithm>

#include "options/choices.h"

namespace tenebra::viewer {
namespace {

/// Collects arguments that differ from their defaults.
class Arguments {
public:
  template <class T, std::size_t N>
  void choice(const char* name, const std::array<Choice<T>, N>& choices, T value, T standard) {
    if (value != standard) add(name, choice_name(choices, value));
  }
  template <class T>
  void value(const char* name, const T& value, const T& standard) {
    if (value != standard) add(name, fmt::format("{}", value));
  }
  void add(const char* name, const std::string& value = "") {
    text_ += fmt::format("{}{}{}{}", text_.empty() ? "" : " ", name, value.empty() ? "" : " ", value);
  }
  std::string text() && { return std::move(text_); }

private:
  std::string text_;
};

void add_soft(Arguments& arguments, const MethodOptions& options) {
  const SoftShadowConfig& soft = options.render.soft;
  const render::AreaLightSettings& lights = options.render.area_lights;
  if (options.light_size) {
    const glm::vec2 size = options.light_size->size;
    arguments.add("--light-size",
                  fmt::format("{}x{}{}", size.x, size.y, options.light_size->percent ? "%" : ""));
    if (const auto& facing = lights.facing) {
      arguments.add("--light-facing", fmt::format("{},{},{}", facing->x, facing->y, facing->z));
    }
  }
  if (lights.sun_deg) arguments.add("--sun-size", fmt::format("{}", *lights.sun_deg));
  arguments.choice("--light-emission", emission_choices, options.light_emission,
                   MethodOptions{}.light_emission);
  if (lights.emissive_quads) arguments.add("--emissive-lights");
  arguments.choice("--soft-solver", solver_choices, soft.solver, SoftShadowConfig{}.solver);
  arguments.choice("--soft-grouping", grouping_choices, soft.grouping, SoftShadowConfig{}.grouping);
  arguments.choice("--soft-choice", occluder_choices, soft.choice, SoftShadowConfig{}.choice);
  arguments.choice("--soft-precision", precision_choices, soft.precision, SoftShadowConfig{}.precision);
  if (const auto mb = soft_memory_mb(soft)) arguments.value("--soft-memory", *mb, 0);
  arguments.value("--soft-points", options.render.soft_points, render::RenderSettings{}.soft_points);
  arguments.value("--soft-error", soft.error_255, SoftShadowConfig{}.error_255);
}

void add_ao(Arguments& arguments, const AoConfig& ao) {
  const AoConfig standard;
  arguments.choice("--ao", ao_choices, ao.mode, standard.mode);
  arguments.choice("--ao-at", place_choices, ao.place, standard.place);
  arguments.choice("--ao-layout", layout_choices, ao.layout, standard.layout);
  arguments.value("--ao-error", ao.error_255, standard.error_255);
  arguments.value("--ao-rays", ao.rays, standard.rays);
  arguments.value("--ao-downscale", ao.downscale, standard.downscale);
  arguments.value("--ao-distance", ao.distance_m, standard.distance_m);
  arguments.value("--ao-positions", ao.positions, standard.positions);
  arguments.value("--ao-directions", ao.directions, standard.directions);
  arguments.value("--ao-bits", ao.bits, standard.bits);
  arguments.choice("--ao-deforming", deforming_choices, ao.deforming, standard.deforming);
  if (ao.cache != default_cache_folder()) {
    arguments.add("--ao-cache", ao.cache.empty() ? "none" : shell_word(ao.cache.string()));
  }
  arguments.value("--ao-memory", ao.memory_mb, standard.memory_mb);
}

}  // namespace

std::string shell_word(const std::string& word) {
  const auto is_plain = [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || std::string_view("_-+=.,:/%@").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string method_arguments(const MethodOptions& options) {
  const render::RenderSettings& render = options.render;
  const render::RenderSettings standard;
  Arguments arguments;
  arguments.choice("--shadows", shadow_choices, render.shadows, standard.shadows);
  arguments.choice("--see-through", see_through_choices, render.see_through, standard.see_through);
  if (options.terminator) arguments.add("--terminator", choice_name(terminator_choices, *options.terminator));
  arguments.value("--light", render.light, standard.light);
  if (options.auto_exposure) {
    arguments.add("--exposure", "auto");
  } else {
    arguments.value("--exposure", render.exposure, standard.exposure);
  }
  if (options.tone) arguments.add("--tone", choice_name(tone_choices, *options.tone));
  arguments.value("--antialias", render.antialias, standard_antialias);
  arguments.value("--threads", render.threads, standard.threads);
  if (render.hard.simd != standard.hard.simd) {
    arguments.add("--simd", std::string(simd_level_name(render.hard.simd)));
  }
  if (render.hard.variant != standard.hard.variant) {
    arguments.add("--variant", std::string(variant_name(render.hard.variant)));
  }
  arguments.choice("--samples", sample_choices, render.samples, standard.samples);
  if (options.cull_front) arguments.add("--cull", choice_name(cull_choices, *options.cull_front));
  add_soft(arguments, options);
  add_ao(arguments, render.ao);
  return std::move(arguments).text();
}

}  // namespace tenebra::viewer
