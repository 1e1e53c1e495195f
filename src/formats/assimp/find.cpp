#include <dlfcn.h>
#include <unistd.h>

#include <initializer_list>

#include "formats/converted.h"

namespace tenebra::formats {
namespace {

namespace fs = std::filesystem;

/// The file that this code is in: the program, or a shared library such as the Python module.
fs::path file_of_this_code() {
  Dl_info info{};
  return dladdr(reinterpret_cast<void*>(&find_converter), &info) != 0 ? info.dli_fname : "";
}

/// The converter in one of `places` around `file`, or empty.
fs::path find_at(const fs::path& file, std::initializer_list<const char*> places) {
  std::error_code error;
  if (!file.is_absolute()) return {};
  for (const char* const place : places) {
    const fs::path program = (file.parent_path() / place / "tenebra-assimp").lexically_normal();
    if (fs::is_regular_file(program, error) && access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

}  // namespace

Converter find_converter() {
  std::error_code error;
  const fs::path running = fs::read_symlink("/proc/self/exe", error), code = file_of_this_code();
  fs::path found = find_at(running, {".", "../lib/tenebra"});  // beside it; of bin/tenebra
  // Of lib/python3/dist-packages/tenebra; of a build folder's python/tenebra. Not of a program: two folders
  // above it anybody may write, as where it lies in /tmp/build/bin.
  if (found.empty() && !fs::equivalent(running, code, error))
    found = find_at(code, {".", "../lib/tenebra", "../../../tenebra", "../../bin"});
  return {found};
}

}  // namespace tenebra::formats
