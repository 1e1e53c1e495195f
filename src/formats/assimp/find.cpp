#include <dlfcn.h>
#include <unistd.h>

#include "formats/converted.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

/// The file that this code is in: the program, or a shared library such as the Python module.
fs::path file_of_this_code() {
  Dl_info info{};
  return dladdr(reinterpret_cast<void*>(&find_converter), &info) != 0 ? info.dli_fname : "";
}

}  // namespace

Converter find_converter() {
  std::error_code error;
  for (const fs::path& file : {fs::read_symlink("/proc/self/exe", error), file_of_this_code()}) {
    if (!file.is_absolute()) continue;
    // Beside it; of bin/tenebra; of lib/python3/dist-packages/tenebra; of a build folder's python/tenebra.
    for (const char* const place : {".", "../lib/tenebra", "../../../tenebra", "../../bin"}) {
      const fs::path program = (file.parent_path() / place / "tenebra-assimp").lexically_normal();
      if (fs::is_regular_file(program, error) && access(program.c_str(), X_OK) == 0) return {program};
    }
  }
  return {};
}

}  // namespace tenebra::formats
