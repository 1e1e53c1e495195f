#include "commands/file_numbers.h"

#include <algorithm>
#include <cmath>

#include "math/whole_origin.h"
#include "scene/pose.h"
#include "scene/unrounded.h"

namespace tenebra::viewer {
namespace {

using glm::dvec3;

double largest(const dvec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The point that divides triangle `to` as `point`, of its plane, divides `from`; the first corner where a
/// triangle has no area.
dvec3 same_place(const dvec3& point, const dvec3 from[3], const dvec3 to[3]) {
  const dvec3 e1 = from[1] - from[0], e2 = from[2] - from[0], way = point - from[0];
  const dvec3 normal = glm::cross(e1, e2);
  const double square = glm::dot(normal, normal);
  if (!(square > 0)) return to[0];
  const double v = glm::dot(glm::cross(way, e2), normal) / square,
               w = glm::dot(glm::cross(e1, way), normal) / square;
  return to[0] + v * (to[1] - to[0]) + w * (to[2] - to[0]);
}

void move_points(const FrameGeometry& drawn, FileNumbers& numbers) {
  for (std::size_t i = 0; i < numbers.points.triangles.size(); ++i) {
    const std::uint32_t id = numbers.points.triangles[i];
    if (id >= drawn.triangles.size()) continue;
    dvec3 from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      from[k] = dvec3(drawn.positions[drawn.triangles[id][k]]);
      to[k] = numbers.positions[drawn.triangles[id][k]];
    }
    numbers.points.positions[i] = same_place(numbers.points.positions[i], from, to);
  }
}

}  // namespace

ShadowLight FileNumbers::light(const session::StagedScene& staged, double time_s, const WorldLight& placed,
                               ShadowLight drawn) const {
  dvec3 rounded_off(0.0);  // the lights of nodes stand where these do, moved by edits
  if (placed.node >= 0) {
    Pose pose;
    scene::evaluate_pose(staged.scene, staged.clip, time_s, pose);
    const dvec3 place(pose.nodes[static_cast<std::size_t>(placed.node)].to_world[3]);
    rounded_off = place - dvec3(glm::vec3(place));
  }
  drawn.position = glm::vec3(dvec3(drawn.position) + rounded_off - origin);
  return drawn;
}

std::optional<FileNumbers> file_numbers(const session::StagedScene& staged, double time_s,
                                        const render::FrameInput& input, const VisiblePoints& points) {
  FileNumbers numbers;
  numbers.positions.resize(input.geometry.positions.size());
  double size = 0;
  scene::each_unrounded(staged.scene, staged.clip, time_s, [&](std::size_t v, const dvec3& place) {
    const dvec3 rounded(input.geometry.positions[v]);
    numbers.positions[v] = place;
    size = std::max(size, largest(rounded));
    numbers.rounding_m = std::max(numbers.rounding_m, largest(place - rounded));
  });
  numbers.origin = math::whole_origin(numbers.positions);
  constexpr double of_floats = 0x1p-23;  // of the largest, twice what rounding to nearest does
  if (numbers.origin == dvec3(0) && !(numbers.rounding_m > of_floats * size)) return std::nullopt;
  for (dvec3& place : numbers.positions) place -= numbers.origin;
  numbers.view = input.view;
  numbers.view.eye = glm::vec3(dvec3(input.view.eye) - numbers.origin);
  numbers.points.width = points.width, numbers.points.height = points.height;
  numbers.points.positions = points.positions;
  numbers.points.triangles = points.triangles;
  move_points(input.geometry, numbers);
  return numbers;
}

}  // namespace tenebra::viewer
