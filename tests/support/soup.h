// Triangles for the tests of visibility: plain bodies, and the nasty ones of the catalogue.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include <tenebra/hard_shadows.h>
#include "support/seeded_random.h"

namespace tenebra::testing {

struct Soup {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint8_t> casts;

  TriangleView view() const { return {positions, triangles, casts}; }
  void add(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c);
  void quad(glm::dvec3 corner, glm::dvec3 u, glm::dvec3 v);
  void append(const Soup& other);
  /// x -> scale * x + offset, rounded to float once.
  Soup moved(double scale, glm::dvec3 offset) const;
  glm::vec3 corner(std::uint32_t id, int k) const { return positions[triangles[id][k]]; }
  glm::dvec3 low() const;
  glm::dvec3 high() const;
};

Soup random_soup(Random& random, int count, double size);        ///< in the cube of +-1
Soup sphere(int rings, double radius, glm::dvec3 centre);        ///< closed, 6 * 2 * rings^2 triangles
Soup torus(int around, int across, double major, double minor);  ///< closed, around the y axis
Soup box(glm::dvec3 low, glm::dvec3 high);                       ///< closed, 12 triangles
Soup tilted_wall(Random& random);  ///< grid wall with T-junctions, decals and a reversed double
Soup slivers(Random& random, int count, double aspect);
Soup needle_fan(Random& random, int count);              ///< around one vertex
Soup duplicates(Random& random, int count, int copies);  ///< half of them with opposite winding
Soup coplanar(Random& random, int count);                ///< overlapping, all in one oblique plane
Soup interpenetrating(Random& random, int count);
Soup wide_range(Random& random, int count);       ///< coordinates +-2^U(-26, 26)
Soup with_zero_areas(Random& random, int count);  ///< a soup with points, lines and equal corners
Soup equal_centroids(Random& random, int count);
Soup tiny_cluster(Random& random, int count);  ///< tiny ones in one spot above a ground
Soup room(Random& random, int clutter);        ///< walls, a floor and closed bodies

/// Makers by name, each called with a seed of its own.
struct SoupMaker {
  std::string name;
  std::function<Soup(Random&)> make;
};
std::vector<SoupMaker> soup_makers();

}  // namespace tenebra::testing
