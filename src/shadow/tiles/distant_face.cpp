#include "shadow/tiles/distant_face.h"

#include <algorithm>
#include <cmath>

#include "math/box.h"

namespace tenebra::shadow {

namespace {

using glm::dvec3;

constexpr double far_enough = 16;  // times the points' extent
constexpr double largest_extent = 1e15;

math::Box<double> bounds_of(const points::PointTiles& tiles) {
  math::Box<double> b;
  for (const points::PointPatch& patch : tiles.patches) {
    for (const points::PointSquare& square : patch.squares) {
      const dvec3 at(square.base.at[0], square.base.at[1], square.base.at[2]);
      b.add({at - square.base.reach(), at + square.base.reach()});
    }
  }
  return b;
}

int longest_axis(const dvec3& v) {
  const dvec3 size = glm::abs(v);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

dvec3 DistantFace::place(const dvec3& p) const {
  const double z = p[axes[2]] * static_cast<double>(sign), q = 1 - approach * z;
  return {(p[axes[0]] - slope[0] * z) / q, (p[axes[1]] - slope[1] * z) / q, z / q};
}

std::optional<DistantFace> distant_face(const ShadowLight& light, const points::PointTiles& tiles) {
  math::Box<double> b = bounds_of(tiles);
  if (b.empty()) b = {dvec3(0), dvec3(0)};
  DistantFace f;
  f.origin = 0.5 * b.low + 0.5 * b.high;
  const dvec3 origin(f.origin), reach = glm::max(origin - b.low, b.high - origin);
  const double extent = std::max({reach.x, reach.y, reach.z}) * (1 + 0x1p-20);
  const dvec3 l = light.directional ? dvec3(light.to_light) : dvec3(light.position) - origin;
  const int axis = longest_axis(l);
  const double distance = std::abs(l[axis]);
  if (!(extent < largest_extent) || !(distance > 0)) return std::nullopt;
  if (!light.directional && !(distance >= far_enough * extent)) return std::nullopt;
  f.sign = l[axis] < 0 ? -1.0f : 1.0f;
  for (int i = 0; i < 3; ++i) f.axes[i] = (axis + 1 + i) % 3;
  for (int i = 0; i < 2; ++i) f.slope[i] = l[f.axes[i]] / distance;
  f.approach = light.directional ? 0 : 1 / distance;
  f.s = static_cast<float>(f.slope[0]), f.t = static_cast<float>(f.slope[1]);
  f.k = static_cast<float>(f.approach);
  f.extent = static_cast<float>(extent);
  // (|x| + |z|) / q + (|y| + |z|) / q <= 4 extent 16/15; z / q <= extent 16/15.
  f.across = 4.5f * f.extent, f.along = 1.1f * f.extent;
  f.per_extent = 1 / std::max(f.extent, 1e-37f);
  return f;
}

RaySource distant_source(const RaySource& source, const DistantFace& face) {
  RaySource distant = source;
  distant.distant = true;
  distant.origin = face.origin;
  return distant;
}

}  // namespace tenebra::shadow
