// Method options as the text that gives them on the command line.
#pragma once

#include <string>

#include "options/settings_names.h"
#include "settings/tables.h"

namespace tenebra::viewer {

/// "--shadows soft --light-size 0.5x0.5 ...": every option whose value is not the default, in the order of
/// the help. Read by add_method_options it gives the same settings. What --quality stands for is among them.
inline std::string method_arguments(MethodOptions options) {
  options.quality.reset();
  return settings::arguments(settings::method_table(), options);
}

}  // namespace tenebra::viewer
