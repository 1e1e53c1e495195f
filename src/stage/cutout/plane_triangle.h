// A triangle laid into the plane of its texture, and places on it.
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace tenebra::stage {

/// A place on a triangle: one of its corners, a point of one of its edges, or a point between.
struct Spot {
  glm::dvec2 at{0.0};
  int corner = -1;
  int edge = -1;     ///< edge e runs between corners e and e + 1
  double along = 0;  ///< 0 to 1 from the edge's first end (PlaneTriangle::first_end) to its other

  bool operator==(const Spot& other) const {
    if (corner >= 0 || other.corner >= 0) return corner == other.corner;
    return edge >= 0 || other.edge >= 0 ? edge == other.edge && along == other.along : at == other.at;
  }
};

/// Counter-clockwise corners. What is computed of an edge depends on nothing but the places of its two ends,
/// whichever of them comes first: two triangles that share the ends agree to the bit.
class PlaneTriangle {
public:
  explicit PlaneTriangle(const std::array<glm::dvec2, 3>& corners);

  const std::array<glm::dvec2, 3>& corners() const { return corners_; }
  int first_end(int edge) const { return first_end_[static_cast<std::size_t>(edge)]; }
  int other_end(int edge) const { return first_end(edge) == edge ? (edge + 1) % 3 : edge; }

  /// Positive on one side of the edge's line, negative on the other.
  double side(int edge, glm::dvec2 place) const;
  bool inside(int edge, double side) const { return (side >= 0) == (first_end(edge) == edge); }

  Spot corner_spot(int corner) const { return {corners_[static_cast<std::size_t>(corner)], corner}; }
  Spot edge_spot(int edge, double along) const;
  /// Where the line coordinate[axis] = value meets the edge.
  Spot edge_spot(int edge, int axis, double value) const;
  /// Where the segment p, q meets the edge; `of_p`, `of_q` are side(edge, p) and side(edge, q).
  Spot edge_spot(int edge, glm::dvec2 p, glm::dvec2 q, double of_p, double of_q) const;
  /// Any place of the triangle: on its edges and corners where it is exactly there.
  Spot spot(glm::dvec2 place) const;

  /// Weights of the three corners.
  glm::dvec3 weights(glm::dvec2 place) const;

private:
  glm::dvec2 start(int edge) const { return corners_[static_cast<std::size_t>(first_end(edge))]; }
  glm::dvec2 end(int edge) const { return corners_[static_cast<std::size_t>(other_end(edge))]; }
  double along(int edge, glm::dvec2 place) const;

  std::array<glm::dvec2, 3> corners_;
  std::array<int, 3> first_end_;
};

}  // namespace tenebra::stage
