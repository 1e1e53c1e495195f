// Edits of a scene as texts: from what a user types to edits, and back.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include "stage/edits/scene_edits.h"

namespace tenebra::settings {

/// "N KEY=VALUE ...": `1 on=0`, `0 intensity=2 move=0,1.5,0 size=0.5x0.3`. The edit of light N in `edits`,
/// which grows as needed.
Expected<void> parse_light_edit(const std::string& text, stage::LightEdits& edits);
/// The same as text, one per edit that changes something.
std::vector<std::string> light_edit_texts(const stage::LightEdits& edits);

/// "TYPE KEY=VALUE ...", TYPE point, spot or directional: `directional direction=-1,-2,0 intensity=2`.
Expected<void> parse_added_light(const std::string& text, stage::SceneEdits& edits);
/// "N KEY=VALUE ...": `0 color=1,0,0 roughness=0.5`.
Expected<void> parse_material_edit(const std::string& text, stage::SceneEdits& edits);
/// "N KEY=VALUE ...": `3 visible=0 casts=0`.
Expected<void> parse_node_edit(const std::string& text, stage::SceneEdits& edits);

/// All that differs from the scene as options: {"--set-light", "0 on=0"}, ...
struct EditOption {
  const char* name;
  std::string value;
};
std::vector<EditOption> edit_options(const stage::SceneEdits& edits);
/// "--set-light" as the name of a log's setting: "set_light".
std::string setting_name(const EditOption& option);

}  // namespace tenebra::settings
