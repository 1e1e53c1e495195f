#include "soft/light/light_places.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tenebra::soft {

namespace {

using glm::dvec2;

/// The chord of a convex polygon on the line at `x`: from its .x to its .y.
dvec2 chord_at(const std::vector<dvec2>& polygon, double x) {
  dvec2 chord(INFINITY, -INFINITY);
  const auto meet = [&](double y) { chord = {std::min(chord.x, y), std::max(chord.y, y)}; };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if (a.x == x) meet(a.y);
    if ((a.x < x) != (b.x < x) && a.x != x && b.x != x) meet(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y));
  }
  return chord;
}

}  // namespace

double LightPlaces::Slab::x_at(double part) const {
  return x + 2 * part / (width + std::sqrt(std::max(0.0, width * width + 2 * slope * part)));
}

LightPlaces::LightPlaces(const AreaLight& light) : light_(&light) {
  std::vector<double> xs;
  for (const dvec2& v : light.polygon) xs.push_back(v.x);
  std::sort(xs.begin(), xs.end());
  for (std::size_t i = 1; i < xs.size(); ++i) {
    if (xs[i] == xs[i - 1]) continue;
    const dvec2 from = chord_at(light.polygon, xs[i - 1]), to = chord_at(light.polygon, xs[i]);
    const double step = xs[i] - xs[i - 1], width = from.y - from.x;
    slabs_.push_back({xs[i - 1], step, width, (to.y - to.x - width) / step});
  }
  for (const Slab& slab : slabs_) area_ += slab.area();
}

glm::vec3 LightPlaces::at(double across, double along) const {
  double part = across * area_;
  std::size_t k = 0;
  while (k + 1 < slabs_.size() && part > slabs_[k].area()) part -= slabs_[k++].area();
  const double x = std::clamp(slabs_[k].x_at(part), slabs_[k].x, slabs_[k].x + slabs_[k].step);
  const dvec2 chord = chord_at(light_->polygon, x);
  const double y = std::lerp(chord.x, chord.y, along);
  return glm::vec3(light_->centre + x * light_->ex + y * light_->ey);
}

ShadowLight light_at(const AreaLight& light, const glm::vec3& place) {
  ShadowLight point;
  point.directional = light.at_infinity;
  (point.directional ? point.to_light : point.position) = place;
  return point;
}

dvec2 sobol_place(std::uint32_t index) {
  // The digits beyond those that `index` sets are 0101... or 1010...: a third or two thirds of a cell's side,
  // wherever they begin.
  std::uint32_t x = 0x55555555u, y = 0xaaaaaaaau, column = 1u << 31, digit = 1u << 31;
  for (; index != 0; index >>= 1, digit >>= 1, column ^= column >> 1) {
    if ((index & 1u) == 0) continue;
    x ^= digit, y ^= column;
  }
  return {x * 0x1p-32, y * 0x1p-32};
}

std::size_t half_of_place(std::uint32_t phase, std::uint32_t k, std::uint32_t more) {
  const std::uint32_t quarter = 4 * k / more;
  return (static_cast<std::uint32_t>(std::popcount(quarter)) + phase) % 2;
}

}  // namespace tenebra::soft
