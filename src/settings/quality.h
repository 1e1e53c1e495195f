// Three words for settings that cost and err differently, chosen from the Pareto fronts of docs/trade.md.
// Which settings, and to what, stands in the table (About::by_quality). Hard shadows are exact in all of
// them: inexact settings save little compared with their errors.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "render/renderer.h"

namespace tenebra::settings {

struct MethodSettings;

enum class Quality {
  fast,      ///< soft shadows and ambient occlusion with errors that are hardly seen
  balanced,  ///< the defaults: exact shadows, occlusion off by 2.5/255 RMS
  exact,     ///< exact shadows, occlusion off by 1/255 RMS
};
inline constexpr std::array qualities{Quality::fast, Quality::balanced, Quality::exact};
std::string_view quality_name(Quality quality);  ///< "fast"

/// Sets these, but for the `given` ones, and leaves all else alone: what is drawn, and how it is computed,
/// stays the caller's.
void apply_quality(Quality quality, const std::set<std::string, std::less<>>& given, MethodSettings& method);
void apply_quality(Quality quality, render::RenderSettings& render);
/// The defaults with these.
render::RenderSettings quality_settings(Quality quality);
/// The preset that sets nothing that `render` does not have; none if none is.
std::optional<Quality> quality_of(const render::RenderSettings& render);

}  // namespace tenebra::settings
