#include "settings/tables.h"

#include <algorithm>

namespace tenebra::settings {

const About* find_about(std::string_view written) {
  std::string name(written);
  std::replace(name.begin(), name.end(), '_', '-');
  if (const About* found = find(method_table(), std::string_view(name))) return found;
  return find(scene_table(), std::string_view(name));
}

}  // namespace tenebra::settings
