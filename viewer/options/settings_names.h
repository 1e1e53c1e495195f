// The settings' names, as the program's files use them.
#pragma once

#include "settings/choices.h"
#include "settings/edit_texts.h"
#include "settings/method_settings.h"
#include "settings/nearest_word.h"
#include "settings/output_pattern.h"
#include "settings/scene_settings.h"
#include "settings/values.h"

namespace tenebra::viewer {

using namespace settings;
using SceneOptions = settings::SceneSettings;
using MethodOptions = settings::MethodSettings;

}  // namespace tenebra::viewer
