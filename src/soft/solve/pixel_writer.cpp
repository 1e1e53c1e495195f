#include "soft/solve/pixel_writer.h"

#include <algorithm>

namespace tenebra::soft {

namespace {

float clamped(double irradiance) {
  return static_cast<float>(std::clamp(irradiance, 0.0, 3.141592653589793));
}

}  // namespace

void PixelWriter::write(std::uint32_t pixel, double area, double irradiance, double above) {
  const double fraction = std::clamp(area / frame_.light.area, 0.0, 1.0);
  frame_.out.visible_fraction[pixel] = static_cast<float>(fraction);
  frame_.out.irradiance[pixel] = clamped(irradiance);
  count(pixel, area, above);
}

void PixelWriter::write_whole(std::uint32_t pixel, double irradiance) {
  frame_.out.visible_fraction[pixel] = 1.0f;
  frame_.out.irradiance[pixel] = clamped(irradiance);
  ++stats_.points_lit;
  ++stats_.fragments;
}

void PixelWriter::count(std::uint32_t pixel, double area, double above) {
  if (above <= 0) {
    frame_.classes[pixel] = static_cast<std::uint8_t>(SoftClass::below_horizon);
    return;
  }
  count_solver(pixel);
  const bool dark = area <= 0, lit = area >= above * (1 - 1e-6);
  ++(dark ? stats_.points_dark : lit ? stats_.points_lit : stats_.points_penumbra);
}

void PixelWriter::count_solver(std::uint32_t pixel) {
  ++(solver_ == SoftClass::bsp          ? stats_.points_bsp
     : solver_ == SoftClass::silhouette ? stats_.points_silhouette
                                        : stats_.points_clip);
  frame_.classes[pixel] = static_cast<std::uint8_t>(solver_);
}

}  // namespace tenebra::soft
