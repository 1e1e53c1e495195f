#include "window/files/file_names.h"

#include <fmt/format.h>

namespace tenebra::viewer {

std::string unused_name(const std::filesystem::path& name) {
  std::filesystem::path file = name;
  std::error_code none;
  for (int i = 2; std::filesystem::exists(file, none); ++i) {
    file = fmt::format("{}_{}{}", name.stem().string(), i, name.extension().string());
  }
  return file.string();
}

std::filesystem::path next_unused(const OutputPattern& pattern, int& number) {
  std::error_code none;
  do ++number;
  while (std::filesystem::exists(pattern.file(number), none));
  return pattern.file(number);
}

}  // namespace tenebra::viewer
