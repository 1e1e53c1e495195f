// Three words for settings that cost and err differently, chosen from the Pareto fronts of docs/trade.md.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "render/renderer.h"

namespace tenebra::render {

enum class Quality {
  fast,      ///< soft shadows and ambient occlusion with errors that are hardly seen
  balanced,  ///< the defaults: exact shadows, occlusion off by 2.5/255 RMS
  exact,     ///< exact shadows, occlusion off by 1/255 RMS
};
inline constexpr std::array qualities{Quality::fast, Quality::balanced, Quality::exact};
std::string_view quality_name(Quality quality);  ///< "fast"
std::optional<Quality> quality_from_name(std::string_view name);

/// What a preset sets. Hard shadows are exact in all of them: inexact settings save little compared with
/// their errors (docs/trade.md).
struct QualitySettings {
  double soft_error = 0;  ///< SoftShadowConfig::error_255
  double ao_error = 2.5;  ///< AoConfig::error_255
  int ao_rays = 64;       ///< AoConfig::rays
  int ao_downscale = 1;   ///< AoConfig::downscale
};
QualitySettings quality_settings(Quality quality);

/// Sets these and leaves all else alone: what is drawn, and how it is computed, stays the caller's.
void apply_quality(Quality quality, RenderSettings& settings);

}  // namespace tenebra::render
