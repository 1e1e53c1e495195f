#include "support/bart.h"

#include <cstdlib>

namespace tenebra::testing {

std::filesystem::path bart_part() {
  return TENEBRA_BART_PART;
}

std::filesystem::path bart_folder() {
  if (const char* chosen = std::getenv("TENEBRA_BART"); chosen != nullptr && *chosen != 0) return chosen;
  const auto beside = std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes" / "bart";
  return std::filesystem::exists(beside) ? beside : bart_part();
}

bool bart_has_textures() {
  return std::filesystem::exists(bart_folder() / "kitchen" / "textures");
}

}  // namespace tenebra::testing
