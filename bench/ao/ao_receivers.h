// Where the errors of ambient occlusion are measured: outside an object's bounding sphere, inside it and off
// the object, and on the object.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/ao/ao_objects.h"
#include "bench/ao/ao_peer.h"
#include "bench/ao/ao_rays.h"

namespace tenebra::bench {

constexpr int wall_points = 33;  ///< points along each side of a wall

struct Ball {
  glm::dvec3 centre{0.0};
  double radius = 0;
};

/// The paper's corner: three walls of 33 x 33 points, three of the sphere's diameters wide, 5 % of the radius
/// beyond it, facing it.
std::vector<Receiver> corner_receivers(const Ball& ball);

/// A floor just (a thousandth of the radius) below the object's lowest point: the points inside the sphere of
/// a grid of 33 x 33, looking up.
std::vector<Receiver> floor_receivers(const Object& object, const Ball& ball);

/// Points inside the sphere at least a fiftieth of the radius off the object and not within it (most rays
/// meet fronts, or nothing), looking anywhere.
std::vector<Receiver> air_receivers(const Ball& ball, const AoPeer& peer, int count, std::uint64_t seed);

/// A point on a triangle.
struct SurfacePoint {
  std::uint32_t triangle = 0;
  Receiver at;  ///< normal: of the face
};
/// Points on the object, as many on equal areas.
std::vector<SurfacePoint> surface_points(const Object& object, int count, std::uint64_t seed);

}  // namespace tenebra::bench
