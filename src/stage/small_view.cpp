#include "stage/small_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tenebra::stage {
namespace {

using glm::dvec2;
using glm::dvec3;

/// A triangle less what is behind the near plane has at most four corners.
template <class Point>
struct Polygon {
  std::array<Point, 4> corners;
  int count = 0;

  void add(const Point& corner) { corners[static_cast<std::size_t>(count++)] = corner; }
};

Polygon<dvec3> clipped(const dvec3 (&v)[3], double near_m) {
  Polygon<dvec3> kept;
  for (int k = 0; k < 3; ++k) {
    const dvec3 &a = v[k], &b = v[(k + 1) % 3];
    const double ahead_a = -a.z - near_m, ahead_b = -b.z - near_m;
    if (ahead_a > 0) kept.add(a);
    if ((ahead_a > 0) != (ahead_b > 0)) kept.add(a + (b - a) * (ahead_a / (ahead_a - ahead_b)));
  }
  return kept;
}

bool covers(const Polygon<dvec2>& polygon, const dvec2& at) {
  bool left = false, right = false;
  for (int k = 0; k < polygon.count; ++k) {
    const dvec2 &a = polygon.corners[static_cast<std::size_t>(k)],
                &b = polygon.corners[static_cast<std::size_t>((k + 1) % polygon.count)];
    const double side = (b.x - a.x) * (at.y - a.y) - (b.y - a.y) * (at.x - a.x);
    left = left || side > 0;
    right = right || side < 0;
  }
  return left != right;
}

/// The pixels of a side whose centres lie from `low` to `high`: first, and one past the last.
std::array<int, 2> centres_between(double low, double high, int side) {
  const double first = std::clamp(std::ceil(low - 0.5), 0.0, static_cast<double>(side)),
               end = std::clamp(std::floor(high - 0.5) + 1, 0.0, static_cast<double>(side));
  return {static_cast<int>(first), static_cast<int>(end)};
}

}  // namespace

SmallView::SmallView(const Lens& lens, int width, int height)
    : lens_(lens),
      width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

dvec2 SmallView::pixel_of(const dvec3& at) const {
  return 0.5 * dvec2(width_, height_) *
         dvec2(1 - at.x / (lens_.tan.x * at.z), 1 + at.y / (lens_.tan.y * at.z));
}

dvec3 SmallView::ray_in_view(int x, int y) const {
  return {lens_.tan.x * (2 * (x + 0.5) / width_ - 1), lens_.tan.y * (1 - 2 * (y + 0.5) / height_), -1};
}

void SmallView::keep(int x, int y, double depth_m, bool front) {
  Pixel& pixel =
      pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  const auto depth = static_cast<float>(depth_m);
  if (depth < pixel.depth_m) pixel = {depth, front};
}

void SmallView::add(const dvec3 (&corners)[3]) {
  const dvec3 v[3]{in_view(corners[0]), in_view(corners[1]), in_view(corners[2])};
  const Polygon<dvec3> kept = clipped(v, lens_.near_m);
  if (kept.count == 0) return;
  Polygon<dvec2> drawn;
  dvec2 low(HUGE_VAL), high(-HUGE_VAL);
  for (int k = 0; k < kept.count; ++k) {
    const dvec2 at = pixel_of(kept.corners[static_cast<std::size_t>(k)]);
    drawn.add(at);
    low = glm::min(low, at), high = glm::max(high, at);
  }
  const auto [left, right] = centres_between(low.x, high.x, width_);
  const auto [top, bottom] = centres_between(low.y, high.y, height_);
  const dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
  const double plane = glm::dot(normal, v[0]);  // negative: the eye is before it
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      if (!covers(drawn, {x + 0.5, y + 0.5})) continue;
      const double depth_m = plane / glm::dot(normal, ray_in_view(x, y));
      if (depth_m > 0) keep(x, y, depth_m, plane < 0);
    }
  }
}

void SmallView::add(const dvec3& middle, const dvec2& half_m) {
  const dvec3 at = in_view(middle);
  if (!(-at.z > lens_.near_m)) return;
  const dvec2 centre = pixel_of(at), half = 0.5 * dvec2(width_, height_) * half_m / (lens_.tan * -at.z);
  const auto [left, right] = centres_between(centre.x - half.x, centre.x + half.x, width_);
  const auto [top, bottom] = centres_between(centre.y - half.y, centre.y + half.y, height_);
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) keep(x, y, -at.z, true);
}

double SmallView::share(const SmallView* other) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < pixels_.size(); ++i)
    count += pixels_[i].held() && (other == nullptr || !other->pixels_[i].held());
  return static_cast<double>(count) / static_cast<double>(pixels_.size());
}

double SmallView::share_of_backs() const {
  std::size_t held = 0, backs = 0;
  for (const Pixel& pixel : pixels_) {
    held += pixel.held();
    backs += pixel.held() && !pixel.front;
  }
  return held > 0 ? static_cast<double>(backs) / static_cast<double>(held) : 0;
}

}  // namespace tenebra::stage
