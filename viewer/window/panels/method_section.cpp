// Scene and method: what is looked at, how its light is computed.
#include <fmt/core.h>
#include <cmath>
#include <filesystem>

#include "window/panels/panels.h"
#include "window/panels/setting_rows.h"

namespace tenebra::viewer {
namespace {

constexpr std::array variants{Variant::tiles,        Variant::precise,        Variant::precise_sorted,
                              Variant::spheres,      Variant::spheres_sorted, Variant::precise_sea,
                              Variant::precise_eatp, Variant::precise_seatp};
constexpr std::array levels{SimdLevel::automatic, SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2,
                            SimdLevel::avx512};

void edit_hard(Ui& ui, MethodOptions& method) {
  HardShadowConfig& hard = method.render.hard;
  setting_row(ui, "Variant", "variant");
  if (ImGui::BeginCombo("##variant", std::string(variant_name(hard.variant)).c_str())) {
    for (const Variant variant : variants) {
      const std::string name =
          std::string(variant_name(variant)) + (variant == HardShadowConfig{}.variant ? "  (default)" : "");
      if (ImGui::Selectable(name.c_str(), variant == hard.variant)) hard.variant = variant;
      ui.mark("variant." + std::string(variant_name(variant)));
    }
    ImGui::EndCombo();
  }
  ui.mark("variant");
  edit_words(ui, method, "Samples", "samples", "samples");
  if (method.render.samples == render::SampleSource::depth && method.render.ao.mode != AoMode::none) {
    method.render.ao.mode = AoMode::none;
  }
  setting_row(ui, "Cull", "cull");
  bool cull = method.cull_front.value_or(method.render.samples == render::SampleSource::depth);
  if (choose(ui, "cull", cull_choices, cull)) method.cull_front = cull;
}

void edit_light_size(Ui& ui, MethodOptions& method) {
  setting_row(ui, "Light size", "light-size");
  LightSize size = method.light_size.value_or(LightSize{glm::vec2(settings::unsized_percent), true});
  float metres[2] = {size.size.x, size.size.y};
  bool changed =
      ImGui::DragFloat2("##light size", metres, 0.01f, 0, 1000, size.percent ? "%.2f %%" : "%.2f m");
  ui.mark("light size");
  row(ui, "");
  changed |= ImGui::Checkbox("% of the scene's diagonal", &size.percent);
  if (changed) {
    size.size = {std::max(metres[0], 0.0f), std::max(metres[1], 0.0f)};
    if (!(size.size.x > 0 && size.size.y > 0)) size.size = glm::vec2(0.0f);
    method.light_size = size;
    if (gives_no_size(method)) method.light_facing.reset();
  }
  setting_row(ui, "Sun size", "sun-size");
  std::optional<float>& sun = method.render.area_lights.sun_deg;
  bool own_sun = sun.has_value();
  if (ImGui::Checkbox("of all##sun", &own_sun)) {
    sun.reset();
    if (own_sun) sun = 0.53f;
  }
  ui.mark("sun size of all");
  if (sun) {
    ImGui::SameLine(0, ui.px(4));
    ImGui::SliderFloat("##sun size", &*sun, 0, 90, "%.2f deg",
                       ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    ui.mark("sun size");
  }
  if (gives_no_size(method)) return;
  edit_words(ui, method, "Shining", "light-emission", "emission");
  setting_row(ui, "Facing", "light-facing");
  std::optional<glm::dvec3>& facing = method.light_facing;
  bool own = facing.has_value();
  if (ImGui::Checkbox("a point", &own)) {
    facing.reset();
    if (own) facing = ui.state.display.frame.to_file(glm::dvec3(ui.state.centre));
  }
  ui.mark("facing");
  if (facing) {
    row(ui, "");
    edit_coordinates("##facing", *facing);
  }
}

/// Resets what hard shadows may have set and soft ones cannot use.
void settle_soft(MethodOptions& method) {
  method.render.samples = render::SampleSource::ids;
  method.cull_front.reset();
}

/// 0: as it is without --memory soft:MB.
void limit_soft_memory(int mb, SoftShadowConfig& soft) {
  soft.memory_bytes.reset();
  soft.tree_bytes = SoftShadowConfig{}.tree_bytes;
  if (mb > 0) set_soft_memory(mb, soft);
}

void edit_soft(Ui& ui, MethodOptions& method) {
  SoftShadowConfig& soft = method.render.soft;
  setting_row(ui, "Emissive", "emissive-lights");
  ImGui::Checkbox("quads shine##emissive", &method.render.area_lights.emissive_quads);
  edit_words(ui, method, "Solver", "soft-solver", "solver");
  edit_words(ui, method, "Groups", "soft-grouping", "grouping");
  edit_words(ui, method, "Occluder", "soft-choice", "occluder");
  row(ui, "Memory", "For BSPs of any size and candidates, in MB. 0: what the system has, and 4 for a BSP.");
  int memory_mb = soft_memory_mb(soft).value_or(0);
  if (number_field(ui, "soft memory", memory_mb, 0, 1000000, 64)) limit_soft_memory(memory_mb, soft);
  setting_row(ui, "Error", "soft-error");
  auto error = static_cast<float>(soft.error_255);
  if (ImGui::SliderFloat("##soft error", &error, 0.0f, 8.0f, error > 0 ? "%.1f / 255" : "exact",
                         ImGuiSliderFlags_AlwaysClamp))
    soft.error_255 = std::round(10 * double{error}) / 10;
  ui.mark("soft error");
  edit_number(ui, method, "Points", "soft-points", "soft points", 4);
}

void edit_distance(Ui& ui, AoConfig& ao) {
  setting_row(ui, "Distance", "ao-distance");
  ImGui::InputDouble("##distance", &ao.distance_m, 0, 0, ao.distance_m > 0 ? "%.3f m" : "automatic",
                     ImGuiInputTextFlags_EnterReturnsTrue);
  ui.mark("ao distance");
  if (!(ao.distance_m >= 0)) ao.distance_m = 0;
}

void edit_error(Ui& ui, AoConfig& ao) {
  setting_row(ui, "Error", "ao-error");
  auto error = static_cast<float>(ao.error_255);
  if (ImGui::SliderFloat("##ao error", &error, 0.5f, 8.0f, "%.1f / 255", ImGuiSliderFlags_AlwaysClamp))
    ao.error_255 = std::round(10 * double{error}) / 10;
  ui.mark("ao error");
}

void edit_ao(Ui& ui, MethodOptions& method) {
  AoConfig& ao = method.render.ao;
  if (ao.mode == AoMode::adaptive) return;
  edit_words(ui, method, "At", "ao-at", "place");
  edit_number(ui, method, "Rays", "ao-rays", "ao rays", 16);
  edit_number(ui, method, "Downscale", "ao-downscale", "ao downscale", 1);
  if (ao.mode != AoMode::field) return;
  edit_words(ui, method, "Layout", "ao-layout", "layout");
  edit_number(ui, method, "Positions", "ao-positions", "ao positions", 256);
  row(ui, "Directions", "Per position; a square number.");
  int side = static_cast<int>(std::lround(std::sqrt(ao.directions)));
  if (number_field(ui, "ao directions", side, 1, 1024, 4)) ao.directions = side * side;
  tooltip("The side of the square: 32 stands for 1024 directions.");
  edit_words(ui, method, "Bits", "ao-bits", "bits");
  edit_words(ui, method, "Deforming", "ao-deforming", "deforming");
  setting_row(ui, "Cache", "ao-cache");
  bool kept = !ao.cache.empty();
  if (ImGui::Checkbox("keep fields and samples", &kept))
    ao.cache = kept ? default_cache_folder() : std::filesystem::path();
  if (kept) tooltip(ao.cache.c_str());
  edit_number(ui, method, "Memory", "ao-memory", "ao memory", 64);
}

void choose_quality(Ui& ui, render::RenderSettings& render) {
  setting_row(ui, "Quality", "quality");
  std::array<const char*, settings::qualities.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i)
    names[i] = settings::quality_name(settings::qualities[i]).data();  // literals
  const auto now = settings::quality_of(render);
  int chosen = now ? static_cast<int>(*now) : -1;
  if (segments(ui, "quality", names.data(), static_cast<int>(names.size()), chosen))
    settings::apply_quality(settings::qualities[static_cast<std::size_t>(chosen)], render);
}

void edit_display(Ui& ui, MethodOptions& method) {
  const SceneDisplay& display = ui.state.display;
  setting_row(ui, "Exposure", "exposure");
  float exposure = render_settings(method, {}, display).exposure;
  const bool measured = takes_measured_exposure(method, display);
  ImGui::SetNextItemWidth(-ui.px(50));
  if (ImGui::SliderFloat("##exposure", &exposure, 1e-4f, 100.0f, measured ? "auto: %.3g" : "%.3g",
                         ImGuiSliderFlags_Logarithmic)) {
    method.render.exposure = exposure > 0 ? exposure : 1;
    method.auto_exposure = false;
    method.exposure_given = true;
  }
  ui.mark("exposure");
  ImGui::SameLine(0, ui.px(4));
  if (ImGui::Button("Auto")) {
    method.auto_exposure = true;
    method.exposure_given = false;
    ui.actions.meter = true;
  }
  ui.mark("exposure.auto");
  tooltip("One exposure for the whole animation, with which at most a hundredth of the pixels is too bright");
  setting_row(ui, "Tone", "tone");
  shade::Tone tone = tone_of(method, display.transfer);
  choose(ui, "tone", tone_choices, tone);
  if (tone != tone_of(method, display.transfer)) method.tone = tone;
}

void edit_machine(Ui& ui, MethodOptions& method) {
  render::RenderSettings& render = method.render;
  edit_number(ui, method, "Threads", "threads", "threads", 1);
  setting_row(ui, "SIMD", "simd");
  if (ImGui::BeginCombo("##simd", std::string(simd_level_name(render.hard.simd)).c_str())) {
    for (const SimdLevel level : levels) {
      if (level != SimdLevel::automatic && !simd_level_supported(level)) continue;
      if (ImGui::Selectable(std::string(simd_level_name(level)).c_str(), level == render.hard.simd)) {
        render.hard.simd = level;
      }
    }
    ImGui::EndCombo();
  }
  ui.mark("simd");
}

}  // namespace

void draw_scene_section(Ui& ui) {
  if (!ui.state.scene) return;
  const Scene& scene = ui.state.scene->scene;
  const std::string name = std::filesystem::path(ui.state.options.file).filename().string();
  if (ImGui::Button("Open...")) ui.actions.open_dialog = true;
  ui.mark("open");
  tooltip("Opens a scene (Ctrl+O); recent ones come first. A file can be dropped on the window too.");
  ImGui::SameLine(0, ui.px(4));
  if (ImGui::Button("Undo")) ui.actions.undo = true;
  ui.mark("undo");
  tooltip("Takes back the last change of the scene (Ctrl+Z)");
  ImGui::SameLine(0, ui.px(4));
  if (ImGui::Button("Redo")) ui.actions.redo = true;
  ui.mark("redo");
  tooltip("Does it again (Ctrl+Shift+Z)");
  ImGui::SameLine(0, ui.px(4));
  if (ImGui::Button("See all")) ui.actions.frame_all = true;
  ui.mark("see all");
  tooltip("A camera that sees the whole scene (G)");
  ImGui::TextUnformatted(name.c_str());
  tooltip(fmt::format("{}\n{} nodes, {} meshes, {} lights. Drop a scene file on the window to open it.",
                      ui.state.options.file, scene.nodes.size(), scene.meshes.size(), scene.lights.size())
              .c_str());
  ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize("? keys").x);
  dim_text("? keys");
  if (ImGui::IsItemClicked()) ui.state.help = true;
  if (scene.clips.size() < 2) return;
  row(ui, "Animation");
  const auto clip_name = [&](int clip) {
    const std::string& own = scene.clips[static_cast<std::size_t>(clip)].name;
    return own.empty() ? fmt::format("animation {}", clip) : own;
  };
  if (ImGui::BeginCombo("##clip", clip_name(ui.state.clip).c_str())) {
    for (int i = 0; i < static_cast<int>(scene.clips.size()); ++i) {
      ImGui::PushID(i);
      if (ImGui::Selectable(clip_name(i).c_str(), i == ui.state.clip)) choose_clip(ui.state, i);
      ui.mark(fmt::format("clip.{}", i));
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  ui.mark("clip");
}

namespace {

void choose_slot(Ui& ui) {
  ViewState& state = ui.state;
  constexpr const char* slots[] = {"A", "B"};
  if (!state.compare && state.active == 0) return;
  row(ui, "Settings of", "Two methods with their settings. X flips between them; Compare shows both.");
  if (segments(ui, "slot", slots, 2, state.active) && state.compare && state.show <= CompareView::b) {
    state.show = state.active == 0 ? CompareView::a : CompareView::b;
  }
}

}  // namespace

void draw_method_section(Ui& ui) {
  if (!section(ui, "Picture", true)) return;
  ViewState& state = ui.state;
  choose_slot(ui);
  MethodOptions& method = state.method();
  choose_quality(ui, method.render);
  edit_words(ui, method, "Shadows", "shadows", "shadows");
  if (method.render.shadows == render::ShadowMode::soft) {
    settle_soft(method);
    edit_light_size(ui, method);
  }
  edit_words(ui, method, "Occlusion", "ao", "ao");
  if (method.render.ao.mode == AoMode::adaptive) edit_error(ui, method.render.ao);
  if (method.render.ao.mode != AoMode::none) {
    method.render.samples = render::SampleSource::ids;
    edit_distance(ui, method.render.ao);
  }
  if (state.scene) edit_display(ui, method);
  if (state.scene) draw_trade_plot(ui);
}

void draw_research_section(Ui& ui) {
  bool& open = ui.state.settings.research;
  ImGui::SetNextItemOpen(open);
  open = section(ui, "Research", false);
  if (!open) return;
  MethodOptions& method = ui.state.method();
  if (method.render.shadows == render::ShadowMode::hard) edit_hard(ui, method);
  if (method.render.shadows == render::ShadowMode::soft) edit_soft(ui, method);
  if (method.render.ao.mode != AoMode::none) edit_ao(ui, method);
  edit_machine(ui, method);
  draw_cost_section(ui);
}

}  // namespace tenebra::viewer
