#include "window/motion/camera_control.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "options/settings_names.h"
#include "scene/view_basis.h"

namespace tenebra::viewer {
namespace {

constexpr double degrees_per_radian = 180.0 / std::numbers::pi;
/// The view axis keeps this angle to `up`: beyond, the picture would turn over.
constexpr double least_angle_to_up_rad = 0.01;
constexpr double notch = 0.9;  ///< distance after one notch of the wheel

/// The turn of a view along `direction` right about `up` and down about its right axis, kept off the poles.
glm::dquat turn_of(glm::dvec3 direction, glm::dvec3 up, double right_rad, double down_rad) {
  up = glm::normalize(up);
  const glm::dvec3 right = scene::view_basis(direction, up)[0];
  const double length = glm::length(direction);
  const double angle = std::acos(std::clamp(glm::dot(direction, up) / length, -1.0, 1.0));
  const double wanted =
      std::clamp(angle + down_rad, least_angle_to_up_rad, std::numbers::pi - least_angle_to_up_rad);
  return glm::dquat(glm::angleAxis(-right_rad, up)) * glm::dquat(glm::angleAxis(angle - wanted, right));
}

}  // namespace

std::string camera_arguments(const FreeCamera& camera, const FileFrame& frame) {
  const auto place = [&](const glm::vec3& p) {
    return frame.is_identity() ? vector_text(p) : place_text(frame.to_file(glm::dvec3(p)));
  };
  return fmt::format("--eye {} --look-at {} --up {} --fov {}", place(camera.eye), place(camera.target),
                     vector_text(glm::vec3(frame.direction_to_file(glm::dvec3(camera.up)))), camera.fov_deg);
}

FreeCamera free_camera(const ViewRays& view, int width, int height, float distance_m) {
  const glm::vec3 middle =
      0.5f * static_cast<float>(width) * view.dx + 0.5f * static_cast<float>(height) * view.dy;
  const float half_height = 0.5f * static_cast<float>(height) * glm::length(view.dy);
  FreeCamera camera;
  camera.up = -glm::normalize(view.dy);
  if (view.orthographic) {
    const glm::vec3 forward = glm::normalize(view.d0);
    camera.target = view.eye + middle + forward * distance_m;
    camera.eye =
        camera.target -
        forward * (half_height / static_cast<float>(std::tan(camera.fov_deg / 2 / degrees_per_radian)));
    return camera;
  }
  const glm::vec3 axis = view.d0 + middle;
  camera.eye = view.eye;
  camera.target = view.eye + glm::normalize(axis) * distance_m;
  camera.fov_deg = 2 * std::atan2(half_height, glm::length(axis)) * degrees_per_radian;
  return camera;
}

void orbit(FreeCamera& camera, float right_rad, float down_rad) {
  const glm::dvec3 forward = glm::dvec3(camera.target) - glm::dvec3(camera.eye);
  camera.eye = glm::dvec3(camera.target) - turn_of(forward, camera.up, right_rad, down_rad) * forward;
}

void orbit(FreeCamera& camera, float right_rad, float down_rad, glm::vec3 point) {
  const glm::dvec3 eye = camera.eye, target = camera.target, about = point;
  const glm::dquat turn = turn_of(target - eye, camera.up, right_rad, down_rad);
  camera.eye = about + turn * (eye - about);
  camera.target = about + turn * (target - about);
}

void look_around(FreeCamera& camera, float right_rad, float down_rad) {
  const glm::dvec3 forward = glm::dvec3(camera.target) - glm::dvec3(camera.eye);
  camera.target = glm::dvec3(camera.eye) + turn_of(forward, camera.up, right_rad, down_rad) * forward;
}

void pan(FreeCamera& camera, glm::vec2 pixels, int height) {
  const glm::dvec3 forward = glm::dvec3(camera.target) - glm::dvec3(camera.eye);
  const glm::dmat3 basis = scene::view_basis(forward, camera.up);
  const double metres_a_pixel =
      2 * glm::length(forward) * std::tan(camera.fov_deg / 2 / degrees_per_radian) / height;
  const glm::vec3 moved =
      (basis[1] * static_cast<double>(pixels.y) - basis[0] * static_cast<double>(pixels.x)) * metres_a_pixel;
  camera.eye += moved;
  camera.target += moved;
}

void zoom(FreeCamera& camera, float steps) {
  const glm::dvec3 back = glm::dvec3(camera.eye) - glm::dvec3(camera.target);
  const glm::vec3 eye = glm::dvec3(camera.target) + back * std::pow(notch, static_cast<double>(steps));
  if (eye != camera.target && std::isfinite(glm::dot(eye, eye))) camera.eye = eye;
}

void fly(FreeCamera& camera, glm::vec3 right_up_forward_m) {
  const glm::dmat3 basis = scene::view_basis(glm::dvec3(camera.target) - glm::dvec3(camera.eye), camera.up);
  const glm::dvec3 m = right_up_forward_m;
  const glm::vec3 moved = basis[0] * m.x + basis[1] * m.y - basis[2] * m.z;
  camera.eye += moved;
  camera.target += moved;
}

void focus(FreeCamera& camera, glm::vec3 point) {
  if (point != camera.eye) camera.target = point;
}

void frame(FreeCamera& camera, glm::vec3 low, glm::vec3 high, double aspect) {
  constexpr double room = 1.04;  // around the box
  const glm::dmat3 basis = scene::view_basis(glm::dvec3(camera.target) - glm::dvec3(camera.eye), camera.up);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(low) + glm::dvec3(high)),
                   half = 0.5 * (glm::dvec3(high) - glm::dvec3(low));
  const double tall = std::tan(camera.fov_deg / 2 / degrees_per_radian), wide = tall * aspect;
  double distance = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 sign((corner & 1) * 2 - 1, (corner & 2) - 1, (corner & 4) / 2 - 1);
    const glm::dvec3 at = glm::transpose(basis) * (half * sign);  // right, up, back
    distance = std::max({distance, at.z + room * std::abs(at.x) / wide, at.z + room * std::abs(at.y) / tall});
  }
  if (!(distance > 0) || !std::isfinite(distance)) return;
  camera.target = centre;
  camera.eye = centre + distance * basis[2];
}

glm::dvec3 pixel_of(const ViewRays& view, glm::dvec3 point) {
  const glm::dvec3 offset = point - glm::dvec3(view.eye);
  const glm::dmat3 rays{glm::dvec3(view.dx), glm::dvec3(view.dy), glm::dvec3(view.d0)};
  const glm::dvec3 along = glm::inverse(rays) * offset;  // offset = x dx + y dy + z d0
  return view.orthographic ? along : glm::dvec3(along.x / along.z, along.y / along.z, along.z);
}

}  // namespace tenebra::viewer
