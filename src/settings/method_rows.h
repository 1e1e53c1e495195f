// The files that share the table of the method.
#pragma once

#include <vector>

#include "settings/method_settings.h"
#include "settings/rows.h"

namespace tenebra::settings {

using MethodRow = Rows<MethodSettings>;
using MethodRows = std::vector<Setting<MethodSettings>>;

void add_soft_rows(MethodRows& rows);  ///< what gives lights an area, and how their visible part is found
void add_ao_rows(MethodRows& rows);    ///< ambient occlusion

}  // namespace tenebra::settings
