#include "gl/egl_choice.h"

namespace tenebra::gl {

std::optional<std::size_t> choose_platform(std::span<const EglPlatform> platforms,
                                           const std::function<Draws(std::size_t)>& attempt) {
  std::optional<std::size_t> spare;
  for (std::size_t i = 0; i < platforms.size(); ++i) {
    if (platforms[i] != EglPlatform::device) continue;
    const Draws draws = attempt(i);
    if (draws == Draws::by_hardware) return i;
    if (draws == Draws::by_software && !spare) spare = i;
  }
  const auto first_that_draws = [&](EglPlatform kind) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < platforms.size(); ++i)
      if (platforms[i] == kind && attempt(i) != Draws::nothing) return i;
    return std::nullopt;
  };
  if (const auto found = first_that_draws(EglPlatform::surfaceless)) return found;
  return spare ? spare : first_that_draws(EglPlatform::software_device);
}

}  // namespace tenebra::gl
