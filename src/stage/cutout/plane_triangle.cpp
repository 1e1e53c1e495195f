#include "stage/cutout/plane_triangle.h"

#include <algorithm>
#include <cmath>

#include "stage/cutout/cross.h"

namespace tenebra::stage {

PlaneTriangle::PlaneTriangle(const std::array<glm::dvec2, 3>& corners) : corners_(corners) {
  for (int e = 0; e < 3; ++e) {
    const glm::dvec2 a = corners[static_cast<std::size_t>(e)],
                     b = corners[static_cast<std::size_t>((e + 1) % 3)];
    first_end_[static_cast<std::size_t>(e)] = (a.x != b.x ? a.x < b.x : a.y < b.y) ? e : (e + 1) % 3;
  }
}

double PlaneTriangle::side(int edge, glm::dvec2 place) const {
  return cross(end(edge) - start(edge), place - start(edge));
}

double PlaneTriangle::along(int edge, glm::dvec2 place) const {
  const glm::dvec2 way = end(edge) - start(edge);
  const int axis = std::abs(way.x) >= std::abs(way.y) ? 0 : 1;
  return (place[axis] - start(edge)[axis]) / way[axis];
}

Spot PlaneTriangle::edge_spot(int edge, double along) const {
  if (!(along > 0)) return corner_spot(first_end(edge));
  if (!(along < 1)) return corner_spot(other_end(edge));
  return {start(edge) + along * (end(edge) - start(edge)), -1, edge, along};
}

Spot PlaneTriangle::edge_spot(int edge, int axis, double value) const {
  Spot spot = edge_spot(edge, (value - start(edge)[axis]) / (end(edge)[axis] - start(edge)[axis]));
  if (spot.corner < 0) spot.at[axis] = value;
  return spot;
}

Spot PlaneTriangle::edge_spot(int edge, glm::dvec2 p, glm::dvec2 q, double of_p, double of_q) const {
  // The same place is found by the same formula, whatever meets the edge there.
  if (of_p == 0) return edge_spot(edge, along(edge, p));
  if (of_q == 0) return edge_spot(edge, along(edge, q));
  if (p.x == q.x) return edge_spot(edge, 0, p.x);
  if (p.y == q.y) return edge_spot(edge, 1, p.y);
  const glm::dvec2 way = q - p;
  return edge_spot(edge, cross(p - start(edge), way) / cross(end(edge) - start(edge), way));
}

Spot PlaneTriangle::spot(glm::dvec2 place) const {
  for (int e = 0; e < 3; ++e)
    if (side(e, place) == 0) return edge_spot(e, along(e, place));
  return {place};
}

glm::dvec3 PlaneTriangle::weights(glm::dvec2 place) const {
  const double area = cross(corners_[1] - corners_[0], corners_[2] - corners_[0]);
  const double b = cross(place - corners_[0], corners_[2] - corners_[0]) / area;
  const double c = cross(corners_[1] - corners_[0], place - corners_[0]) / area;
  const double b01 = std::clamp(b, 0.0, 1.0), c01 = std::clamp(c, 0.0, 1.0 - b01);
  return {1.0 - b01 - c01, b01, c01};
}

}  // namespace tenebra::stage
