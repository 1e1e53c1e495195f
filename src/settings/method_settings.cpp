#include "settings/method_settings.h"

#include <algorithm>

#include "base/fail.h"
#include "settings/tables.h"

namespace tenebra::settings {
namespace {

constexpr std::size_t any_size = ~std::size_t{0};  // of a BSP

/// Why the chosen methods do not look at a setting; empty if they do.
std::string idle_reason(Used used, const render::RenderSettings& render) {
  const bool soft = render.shadows == render::ShadowMode::soft;
  const AoMode ao = render.ao.mode;
  const bool of_ao = used == Used::with_ao || used == Used::with_adaptive || used == Used::with_other_ao ||
                     used == Used::with_fields;
  if (used == Used::with_accuracy && !soft && ao == AoMode::none) return "without --shadows soft or --ao";
  if (used == Used::with_shadows && render.shadows == render::ShadowMode::none) return "with --shadows none";
  if ((used == Used::with_soft || used == Used::with_soft_exact) && !soft) return "without --shadows soft";
  if (used == Used::with_soft_exact && render.soft_points > 0)
    return fmt::format("where lights are {} points", render.soft_points);
  if (of_ao && ao == AoMode::none) return "without --ao";
  if (used == Used::with_adaptive && ao != AoMode::adaptive) return "without --ao adaptive";
  if (used == Used::with_other_ao && ao == AoMode::adaptive) return "with --ao adaptive";
  if (used == Used::with_fields && ao != AoMode::field) return "without --ao field";
  return {};
}

}  // namespace

render::RenderSettings standard_render() {
  render::RenderSettings render;
  render.antialias = standard_antialias;
  render.ao.cache = default_cache_folder();
  return render;
}

bool MethodSettings::operator==(const MethodSettings& other) const {
  const auto table = method_table();
  return std::all_of(table.begin(), table.end(),
                     [&](const auto& setting) { return setting.same(*this, other); });
}

bool is_used(Used used, const render::RenderSettings& render) {
  return idle_reason(used, render).empty();
}

void settle_quality(const Given& given, MethodSettings& method) {
  if (method.quality) apply_quality(*method.quality, given, method);
}

Expected<void> check_method_settings(const MethodSettings& method) {
  const render::RenderSettings& render = method.render;
  const bool soft = render.shadows == render::ShadowMode::soft;
  if (render.samples == render::SampleSource::depth && (soft || render.ao.mode != AoMode::none)) {
    return base::fail("--paper samples=depth has no exact points, and {} needs them; expected samples=ids",
                      soft ? "--shadows soft" : "--ao");
  }
  if (render.samples == render::SampleSource::depth && method.terminator == render::Terminator::smooth) {
    return base::fail(
        "--paper samples=depth has no exact points, and --terminator smooth needs them; expected "
        "samples=ids");
  }
  if (method.light_facing && gives_no_size(method))
    return base::fail(
        "--light-size facing=X,Y,Z is for rectangles, and --light-size 0 makes none; expected a size above 0 "
        "with it");
  if (soft && method.cull_front.value_or(false)) {
    return base::fail("--paper cull=front is for hard shadows, and with --shadows soft every face casts");
  }
  return {};
}

std::vector<std::string> idle_sentences(const Given& given, const MethodSettings& method) {
  std::vector<std::string> sentences;
  for (const Setting<MethodSettings>& setting : method_table()) {
    if (!given.contains(setting.name)) continue;
    if (const std::string lack = idle_reason(setting.used, method.render); !lack.empty())
      sentences.push_back(fmt::format("{} does nothing {}", option_name(setting), lack));
  }
  return sentences;
}

shade::Tone tone_of(const MethodSettings& method, Transfer transfer) {
  return method.tone.value_or(transfer == Transfer::srgb ? shade::Tone::neutral : shade::Tone::none);
}

bool takes_measured_exposure(const MethodSettings& method, const SceneDisplay& display) {
  return display.exposures && (method.auto_exposure || (display.needs_exposure && !method.exposure_given));
}

bool gives_no_size(const MethodSettings& method) {
  return method.light_size && method.light_size->size == glm::vec2(0.0f);
}

bool makes_emissive_lights(const MethodSettings& method) {
  return method.render.area_lights.emissive_quads && method.render.shadows == render::ShadowMode::soft;
}

render::RenderSettings render_settings(const MethodSettings& method, Size size, const SceneDisplay& display) {
  render::RenderSettings render = method.render;
  render.tone = tone_of(method, display.transfer);
  if (takes_measured_exposure(method, display))
    render.exposure = (*display.exposures)[static_cast<std::size_t>(render.tone)];
  render.width = size.width;
  render.height = size.height;
  // Points from the depth buffer lie off their triangles: only the paper's front-face culling keeps those
  // from shadowing their own points.
  const bool from_depth = render.samples == render::SampleSource::depth;
  render.hard.cull_front = method.cull_front.value_or(from_depth);
  render.hard.contact = from_depth ? ContactRule::none : ContactRule::triangle_ids;
  render.terminator =
      from_depth ? render::Terminator::flat : method.terminator.value_or(render::Terminator::smooth);
  render.soft.simd = render.ao.simd = render.hard.simd;
  render.area_lights.emission = method.light_emission;
  render.area_lights.facing.reset();
  if (method.light_facing)
    render.area_lights.facing = glm::vec3(display.frame.to_scene(*method.light_facing));
  const LightSize given = method.light_size.value_or(LightSize{});
  render.area_lights.size = given.size;
  render.area_lights.percent_of_diagonal = given.percent;
  render.area_lights.unsized_percent = gives_no_size(method) ? 0 : unsized_percent;
  render.area_lights.unsized_sun_deg = gives_no_size(method) ? 0 : unsized_sun_deg;
  return render;
}

MethodSettings settled(MethodSettings method, const render::RenderSettings& render) {
  method.render = render;
  method.cull_front = render.hard.cull_front;
  method.terminator = render.terminator;
  method.light_emission = render.area_lights.emission;
  method.tone = render.tone;
  method.auto_exposure = false;
  method.exposure_given = true;
  return method;
}

void set_soft_memory(int mb, SoftShadowConfig& soft) {
  soft.memory_bytes = bytes_of_mb(mb);
  soft.tree_bytes = any_size;
}

std::optional<int> soft_memory_mb(const SoftShadowConfig& soft) {
  if (!soft.memory_bytes || soft.tree_bytes != any_size) return std::nullopt;
  return static_cast<int>(*soft.memory_bytes >> 20);
}

}  // namespace tenebra::settings
