// Values of settings.
#pragma once

namespace tenebra::settings {

struct Size {
  int width = 0;
  int height = 0;

  bool operator==(const Size&) const = default;
};
inline constexpr int largest_side_px = 16384;

}  // namespace tenebra::settings
