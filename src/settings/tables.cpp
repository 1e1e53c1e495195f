#include "settings/tables.h"

namespace tenebra::settings {

const About* find_about(std::string_view written) {
  const std::string name = dashed(written);
  if (const About* found = find(method_table(), std::string_view(name))) return found;
  return find(scene_table(), std::string_view(name));
}

}  // namespace tenebra::settings
