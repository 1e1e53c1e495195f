// Candidate search of the oracle: a plain tree of boxes over the triangles, in absolute coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/hard_shadows.h>

namespace tenebra::oracle {

/// The points P + t d, 0 <= t <= t_max; d is the exact real direction up to a relative error of 2^-53 a
/// component.
struct Segment {
  glm::dvec3 origin;
  glm::dvec3 direction;
  double t_max;
};

/// Triangles whose vertices are the view's or, where they are given, these doubles.
struct OracleTriangles {
  TriangleView view;
  std::span<const glm::dvec3> doubles;

  OracleTriangles(const TriangleView& floats,
                  std::span<const glm::dvec3> instead = {})  // NOLINT: a view will do
      : view(floats), doubles(instead) {}
  glm::dvec3 corner(std::uint32_t id, int k) const {
    const std::uint32_t v = view.triangles[id][k];
    return doubles.empty() ? glm::dvec3(view.positions[v]) : doubles[v];
  }
};

class TriangleBoxes {
public:
  /// A tree over the triangles `ids`.
  TriangleBoxes(const OracleTriangles& triangles, std::vector<std::uint32_t> ids);

  /// Calls visit(id) for every triangle whose box the segment may meet, until visit returns true.
  /// Conservative: a triangle that the segment meets is always visited.
  template <class Visit>
  bool any_of(const Segment& segment, Visit visit) const {
    std::array<std::uint32_t, 128>
        stack;  // halving 2^32 triangles needs 33 levels, two entries a level at most
    std::size_t size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!may_meet(segment, node)) continue;
      if (node.right == 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          if (visit(ids_[i])) return true;
      } else {
        stack[size++] = node.right;
        stack[size++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      }
    }
    return false;
  }

  /// Calls visit(id) for every triangle whose box and all boxes around it satisfy may(low, high).
  template <class May, class Visit>
  void each_of(May may, Visit visit) const {
    std::array<std::uint32_t, 128> stack;
    std::size_t size = 0;
    if (!nodes_.empty()) stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!may(node.low, node.high)) continue;
      if (node.right == 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(ids_[i]);
      } else {
        stack[size++] = node.right;
        stack[size++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
      }
    }
  }

private:
  struct Node {
    glm::dvec3 low, high;
    std::uint32_t right = 0;  ///< 0: a leaf; the left child follows its parent
    std::uint32_t first = 0, count = 0;
  };
  static bool may_meet(const Segment& segment, const Node& node);
  void split(const OracleTriangles& triangles, std::uint32_t first, std::uint32_t count);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace tenebra::oracle
