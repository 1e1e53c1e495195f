#include "sun/sky.h"

#include <cmath>
#include <numbers>

#include "base/fail.h"
#include "base/number_in.h"

namespace tenebra::sun {

Expected<int> parse_sky(const std::string& text) {
  if (text == "tregenza") return 1;
  if (text == "reinhart") return 2;
  const std::string name = "reinhart:";
  const auto parts = text.starts_with(name) ? base::number_in<int>(text.substr(name.size())) : std::nullopt;
  if (!parts || *parts < 2 || *parts > 8)
    return base::fail("found {}, expected tregenza, reinhart or reinhart:2 to reinhart:8", text);
  return *parts;
}

std::vector<Sun> sky_patches(int parts, double north_deg) {
  constexpr int tregenza[] = {30, 30, 24, 24, 18, 12, 6};
  constexpr double turn = 2 * std::numbers::pi;
  const int rows = 7 * parts;
  const double height_deg = 90 / (rows + 0.5);
  const auto sine = [&](double row) { return std::sin(row * height_deg * turn / 360); };
  std::vector<Sun> patches;
  double horizontal = 0;
  const auto add = [&](const Position& centre, double solid_angle) {
    const glm::dvec3 way = direction(centre, north_deg);
    patches.push_back({way, 0, 0, 0, solid_angle});
    horizontal += solid_angle * way.y;
  };
  for (int row = 0; row < rows; ++row) {
    const int count = parts * tregenza[row / parts];
    for (int i = 0; i < count; ++i)
      add({360.0 * i / count, (row + 0.5) * height_deg}, turn / count * (sine(row + 1) - sine(row)));
  }
  add({0, 90}, turn * (1 - sine(rows)));
  for (Sun& patch : patches) patch.light_wh_m2 /= horizontal;
  return patches;
}

}  // namespace tenebra::sun
