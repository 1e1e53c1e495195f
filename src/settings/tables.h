// All settings, each once: a new one is a row of these tables, beside the code that reads its value.
#pragma once

#include <span>

#include "settings/method_settings.h"
#include "settings/scene_settings.h"
#include "settings/setting.h"

namespace tenebra::settings {

/// What is looked at.
std::span<const Setting<SceneSettings>> scene_table();
/// How light is computed, and how the picture shows it.
std::span<const Setting<MethodSettings>> method_table();

/// The row of that name, as options or as logs write it, in any of the tables; null: there is none.
const About* find_about(std::string_view name);

/// Whether the chosen methods look at settings of that kind.
bool is_used(Used used, const render::RenderSettings& render);

}  // namespace tenebra::settings
