#include "stage/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/view_basis.h"

namespace tenebra::stage {
namespace {

using glm::dvec3;

constexpr double least_filled = 0.8, least_backs = 0.7, least_backs_a_side = 0.3, least_plain = 0.9,
                 least_closed = 0.9;
constexpr std::array axes{dvec3(1, 0, 0),  dvec3(-1, 0, 0), dvec3(0, 0, 1),
                          dvec3(0, 0, -1), dvec3(0, 1, 0),  dvec3(0, -1, 0)};  // the sides first
constexpr std::size_t side_count = 4;

SmallView view_of(const Subject& subject, const Lens& lens, int width, int height) {
  SmallView view(lens, width, height);
  for (const glm::uvec3& triangle : subject.first.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    dvec3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = dvec3(subject.first.positions[triangle[k]]);
    view.add(corners);
  }
  return view;
}

/// What a side of the box shows from far outside; shares.
struct Side {
  double filled = 0, backs = 0, plain = 0;
};
Side side_of(const Subject& subject, const dvec3& outward) {
  constexpr int pixels = 48;
  constexpr double depth_of_plain = 0.05;  // of the box
  const dvec3 half = 0.5 * (subject.high - subject.low);
  const double far_m = 20 * subject.radius_m(), deep = 2 * glm::dot(half, glm::abs(outward));
  Lens lens;
  lens.basis = scene::view_basis(-outward, {0, 1, 0});
  lens.eye = subject.centre() + (0.5 * deep + far_m) * outward;
  for (int c = 0; c < 2; ++c) lens.tan[c] = glm::dot(half, glm::abs(lens.basis[c])) / far_m;
  lens.near_m = 0.5 * far_m;
  const SmallView view = view_of(subject, lens, pixels, pixels);
  Side side{.filled = view.share(), .backs = view.share_of_backs()};
  for (const SmallView::Pixel& pixel : view.pixels())
    side.plain += pixel.held() && pixel.depth_m < far_m + depth_of_plain * deep;
  side.plain /= static_cast<double>(view.pixels().size());
  return side;
}

bool shows_nothing_outside(const Subject& subject) {
  double filled = 0, backs = 0, least_side = 1, plain = 0;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Side side = side_of(subject, axes[i]);
    filled += i < side_count ? side.filled / side_count : 0;
    backs += side.backs / axes.size();
    least_side = std::min(least_side, side.backs);
    plain += side.plain / axes.size();
    if (i + 1 == side_count && filled < least_filled) return false;
  }
  return (backs >= least_backs && least_side >= least_backs_a_side) || plain >= least_plain;
}

/// The share of all directions, about, in which the front of something is met.
double closedness(const Subject& subject, const dvec3& eye) {
  double closed = 0;
  for (const dvec3& axis : axes) {
    const Lens lens{.eye = eye,
                    .basis = scene::view_basis(axis, {0, 1, 0}),
                    .tan = {1, 1},
                    .near_m = 1e-4 * subject.radius_m()};
    const SmallView view = view_of(subject, lens, 16, 16);
    closed += view.share() * (1 - view.share_of_backs()) / axes.size();
  }
  return closed;
}

/// The place at shares of the box's sides, -1 to 1.
dvec3 place_in(const Subject& subject, const dvec3& at) {
  return subject.centre() + 0.5 * at * (subject.high - subject.low);
}

/// The more of the room is seen, and the further.
double outlook(const Subject& subject, Framing& framing) {
  constexpr int width = 64;
  const SmallView view = view_of(subject, framing.lens(), width,
                                 std::max(1, static_cast<int>(std::lround(width / framing.aspect))));
  const double radius = subject.radius_m();
  double sum = 0, nearest = radius;
  for (const SmallView::Pixel& pixel : view.pixels()) {
    if (!pixel.held()) continue;
    nearest = std::min<double>(nearest, pixel.depth_m);
    if (pixel.front && pixel.depth_m > 0.1 * radius) sum += std::min(pixel.depth_m / radius, 1.0);
  }
  framing.subject_share = view.share();
  framing.near_m = static_cast<float>(std::max(0.1 * nearest, 1e-4 * radius));
  return sum / static_cast<double>(view.pixels().size());
}

std::vector<std::pair<double, Framing>> views_inside(const Subject& subject, std::optional<float> aspect) {
  constexpr double near_wall = 0.8, eye_height = 0.1, target_height = -0.2;
  std::vector<std::pair<double, Framing>> views;
  for (const double z : {near_wall, 0.0, -near_wall}) {
    for (const double x : {near_wall, 0.0, -near_wall}) {
      if (x == 0 && z == 0) continue;
      Framing framing;
      framing.eye = place_in(subject, {x, eye_height, z});
      framing.basis = scene::view_basis(place_in(subject, {0, target_height, 0}) - framing.eye, {0, 1, 0});
      framing.vertical_fov_rad = 1.0f;
      framing.aspect = aspect.value_or(4 / 3.0f);
      framing.near_m = static_cast<float>(1e-4 * subject.radius_m());
      const double score = outlook(subject, framing);
      views.emplace_back(score, framing);
    }
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  return views;
}

/// Below the ceiling in the middle, or on the way from there to the camera.
dvec3 lamp_place(const Subject& subject, const Framing& framing) {
  for (const double way : {0.0, 0.5})
    for (const double height : {0.8, 0.6, 0.3}) {
      const dvec3 middle = place_in(subject, {0, height, 0});
      const dvec3 at = glm::mix(middle, {framing.eye.x, middle.y, framing.eye.z}, way);
      if (closedness(subject, at) >= least_closed) return at;
    }
  return framing.eye;
}

}  // namespace

std::optional<Framing> frame_room(const Subject& subject, std::optional<float> aspect) {
  const dvec3 size = subject.high - subject.low;
  if (subject.empty() || !(std::min({size.x, size.y, size.z}) > 0)) return std::nullopt;
  if (!shows_nothing_outside(subject)) return std::nullopt;
  for (auto& [score, framing] : views_inside(subject, aspect)) {
    if (closedness(subject, framing.eye) < least_closed) continue;
    framing.lamp = lamp_place(subject, framing);
    return framing;
  }
  return std::nullopt;
}

}  // namespace tenebra::stage
