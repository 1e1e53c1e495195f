#include "shared/bundled_scene.h"

#include "base/fail.h"

namespace tenebra::viewer {

namespace fs = std::filesystem;

Expected<fs::path> bundled_scene(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path file = (program.parent_path() / "../share/tenebra/scenes" / name).lexically_normal();
  if (fs::is_regular_file(file, error)) return file;
  return base::fail("no scene was given, and the bundled {} is missing; name a scene file", name);
}

}  // namespace tenebra::viewer
