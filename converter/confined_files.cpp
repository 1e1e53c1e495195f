#include "confined_files.h"

#include <algorithm>

namespace tenebra::converter {

namespace fs = std::filesystem;

bool ConfinedFiles::is_inside(const char* file) const {
  if (file == main_) return true;
  std::error_code error;
  const fs::path place = fs::weakly_canonical(file, error);
  return !error && std::mismatch(root_.begin(), root_.end(), place.begin(), place.end()).first == root_.end();
}

bool ConfinedFiles::Exists(const char* file) const {
  std::error_code error;
  return is_inside(file) && fs::is_regular_file(file, error);
}

Assimp::IOStream* ConfinedFiles::Open(const char* file, const char* mode) {
  const bool reads =
      mode != nullptr && mode[0] == 'r' && std::string_view(mode).find('+') == std::string_view::npos;
  if (!reads || !Exists(file)) return nullptr;
  const std::string place = file == main_ ? main_ : fs::weakly_canonical(file).string();
  if (std::find(opened_.begin(), opened_.end(), place) == opened_.end()) opened_.push_back(place);
  return DefaultIOSystem::Open(file, mode);
}

}  // namespace tenebra::converter
