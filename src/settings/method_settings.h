// How light is computed: shadows, their settings, ambient occlusion, and how the picture shows it.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tenebra/scene.h>
#include "render/renderer.h"
#include "settings/quality.h"
#include "settings/values.h"

namespace tenebra::settings {

/// Samples per pixel of pictures; RenderSettings has 1, for callers that want masks.
inline constexpr int standard_antialias = 4;

/// Exposures by tone: what --exposure auto stands for.
using AutoExposures = std::array<float, shade::tones.size()>;

/// The properties of a scene that settings are applied with.
struct SceneDisplay {
  FileFrame frame;  ///< of the places that settings name
  Transfer transfer = Transfer::srgb;
  std::optional<AutoExposures> exposures;  ///< none: not measured
  bool needs_exposure = false;             ///< pictures take them where the user gives no exposure
};

/// RenderSettings of pictures: anti-aliased, with a folder for what is kept between runs.
render::RenderSettings standard_render();

/// For soft shadows: of point and spot lights without a size, in percent of the scene's diagonal; of suns.
inline constexpr float unsized_percent = 1, unsized_sun_deg = 0.53f;

struct MethodSettings {
  render::RenderSettings render = standard_render();  ///< but for its size, tone and emission
  std::optional<Quality> quality;                     ///< as given; settle_quality turns it into settings
  std::optional<bool> cull_front;                     ///< not given: as the samples need it
  std::optional<LightSize> light_size;                ///< not given: unsized_percent; 0: hard shadows
  std::optional<render::Terminator> terminator;       ///< not given: smooth
  render::LightEmission light_emission = render::LightEmission::point;  ///< in place of render's
  std::optional<glm::dvec3> light_facing;  ///< in the file's coordinates, in place of render's
  std::optional<shade::Tone> tone;         ///< not given: neutral for linear colours, none for display values
  bool auto_exposure = false;              ///< SceneDisplay::exposures, where measured, in place of render's
  bool exposure_given = false;             ///< render's exposure is the user's: the scene has no say

  bool operator==(const MethodSettings& other) const;  ///< all settings of the table are the same
};

/// Names of settings that the user gave.
using Given = std::set<std::string, std::less<>>;

/// Sets what a given --quality stands for, but for settings that were given themselves: they win. To be
/// called once all settings are read.
void settle_quality(const Given& given, MethodSettings& method);

/// What single settings cannot check: combinations.
Expected<void> check_method_settings(const MethodSettings& method);

/// Given settings that the chosen methods ignore, one sentence each.
std::vector<std::string> idle_sentences(const Given& given, const MethodSettings& method);

/// The tone of pictures with that transfer.
shade::Tone tone_of(const MethodSettings& method, Transfer transfer);

/// Whether pictures take SceneDisplay::exposures.
bool takes_measured_exposure(const MethodSettings& method, const SceneDisplay& display);

/// Whether lights without a size keep none.
bool gives_no_size(const MethodSettings& method);

/// Whether emissive meshes are lights.
bool makes_emissive_lights(const MethodSettings& method);

/// The settings of a frame of `size`.
render::RenderSettings render_settings(const MethodSettings& method, Size size, const SceneDisplay& display);

/// The method with `render`, which render_settings made of it, in place of what was left open.
MethodSettings settled(MethodSettings method, const render::RenderSettings& render);

constexpr std::size_t bytes_of_mb(int mb) {
  return static_cast<std::size_t>(mb) << 20;
}
/// --memory soft:MB: that much for soft shadows, and BSPs of any size within it.
void set_soft_memory(int mb, SoftShadowConfig& soft);
/// What was given to it; none: nothing.
std::optional<int> soft_memory_mb(const SoftShadowConfig& soft);

}  // namespace tenebra::settings
