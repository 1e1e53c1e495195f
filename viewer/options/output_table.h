// What a render writes and how its run goes, as a table of settings; settings/tables.h has the others.
#pragma once

#include "options/render_options.h"
#include "settings/setting.h"

namespace tenebra::viewer {

std::span<const settings::Setting<RenderOptions>> output_table();

/// The row of that name, as options or as logs write it, in any table; null: there is none.
const settings::About* about_of(std::string_view name);

}  // namespace tenebra::viewer
