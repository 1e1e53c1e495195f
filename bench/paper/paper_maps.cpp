#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "ao/cast/sphere_maps.h"
#include "bench/paper/paper_ao.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

using glm::vec2;
using glm::vec3;

vec3 lifted(vec2 disk) {
  const float square = glm::dot(disk, disk);
  return square > 1 ? vec3(0, 0, -1) : vec3(disk, std::sqrt(1 - square));
}

}  // namespace

const char* direction_map_name(DirectionMap map) {
  switch (map) {
    case DirectionMap::polar:
      return "uniform (polar)";
    case DirectionMap::rejection:
      return "rejection";
    case DirectionMap::concentric:
      return "concentric";
  }
  return "";
}

int cell_of_direction(DirectionMap map, vec3 d, int side) {
  switch (map) {
    case DirectionMap::polar: {  // rows of equal angles from the axis, columns of equal angles about it
      const auto pi = static_cast<float>(std::numbers::pi);
      const float theta = std::acos(std::clamp(d.z, 0.0f, 1.0f)) / (0.5f * pi);
      return ao::cell_index({std::atan2(d.y, d.x) / pi, 2 * theta - 1}, side);
    }
    case DirectionMap::rejection:
      return ao::cell_index({d.x, d.y}, side);
    case DirectionMap::concentric:
      return ao::cell_index(ao::square_from_disk({d.x, d.y}), side);
  }
  return 0;
}

vec3 direction_of_cell(DirectionMap map, int cell, int side) {
  const vec2 at = ao::cell_point(cell, side);
  if (map == DirectionMap::concentric) return lifted(ao::disk_from_square(at));
  if (map == DirectionMap::rejection) return lifted(at);
  const auto pi = static_cast<float>(std::numbers::pi);
  const float theta = 0.25f * pi * (at.y + 1), phi = pi * at.x;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

double unused_cells(DirectionMap map, int side) {
  int unused = 0;
  for (int cell = 0; cell < side * side; ++cell) unused += direction_of_cell(map, cell, side).z < 0 ? 1 : 0;
  return static_cast<double>(unused) / (side * side);
}

MappedField::MappedField(const AoPeer& peer, const Ball& ball, DirectionMap map, int position_side,
                         int direction_side)
    : ball_(ball), map_(map), position_side_(position_side), direction_side_(direction_side) {
  const auto cells = static_cast<std::size_t>(direction_side * direction_side);
  distances_.resize(static_cast<std::size_t>(position_side * position_side) * cells);
  parallel::parallel_ranges(distances_.size() / cells, 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      const vec3 out = ao::direction_from_square(ao::cell_point(static_cast<int>(p), position_side));
      const ao::Frame frame = ao::frame_around(-out);
      const vec3 entry(ball_.centre + ball_.radius * glm::dvec3(out));
      for (std::size_t c = 0; c < cells; ++c) {
        vec3 d = direction_of_cell(map, static_cast<int>(c), direction_side);
        if (d.z < 0) d = glm::normalize(vec3(ao::cell_point(static_cast<int>(c), direction_side), 0));
        const vec3 along = d.x * frame.x + d.y * frame.y - d.z * out;
        distances_[p * cells + c] = peer.nearest(entry, along).distance;
      }
    }
  });
}

void MappedField::nearest(std::span<const trees::RayBatch> rays, float* distances) const {
  const auto cells = static_cast<std::size_t>(direction_side_ * direction_side_);
  for (std::size_t i = 0; i < rays.size() * trees::batch_size; ++i) {
    const trees::RayBatch& batch = rays[i / trees::batch_size];
    const vec3 origin = batch.origin(static_cast<int>(i % trees::batch_size)),
               d = batch.direction(static_cast<int>(i % trees::batch_size));
    const glm::dvec3 to = ball_.centre - glm::dvec3(origin);
    const double along = glm::dot(to, glm::dvec3(d));
    const double root = ball_.radius * ball_.radius - glm::dot(to, to) + along * along;
    if (!(root > 0) || !(along > 0)) continue;
    const double way = along - std::sqrt(root);  // to the entry
    const vec3 out((glm::dvec3(origin) + way * glm::dvec3(d) - ball_.centre) / ball_.radius);
    const int position = ao::cell_index(ao::square_from_direction(out), position_side_);
    // Directions are relative to the position's own inward normal, as the map was made.
    const vec3 at = ao::direction_from_square(ao::cell_point(position, position_side_));
    const ao::Frame frame = ao::frame_around(-at);
    vec3 local(glm::dot(d, frame.x), glm::dot(d, frame.y), -glm::dot(d, at));
    if (local.z < 0) local = glm::normalize(vec3(local.x, local.y, 0));
    const int cell = cell_of_direction(map_, local, direction_side_);
    const float hit = static_cast<float>(way) +
                      distances_[static_cast<std::size_t>(position) * cells + static_cast<std::size_t>(cell)];
    if (hit < distances[i]) distances[i] = hit;
  }
}

}  // namespace tenebra::bench
