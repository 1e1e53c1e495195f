// The silhouette of the meshes that stand between a group of points and the light: only the edges at which
// the number of triangles in the way may change.
//
// Every triangle is turned to show its points one and the same orientation. Where two neighbours share an
// edge, they run through it in opposite directions, and the edge cancels: what is left of a closed mesh is
// its silhouette, as seen from the points. How many triangles cover a place of the light is then the winding
// number of this silhouette around it (the same for all triangles as for their silhouette, by the linearity
// of boundaries), and the light is visible where it is zero. No assumption on the meshes: open, two-sided or
// crossing ones only cancel less.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/visible_points.h>
#include "soft/light/light_frame.h"
#include "soft/occluders/group_candidates.h"

namespace tenebra::soft {

struct SilhouetteEdge {
  glm::dvec3 from, to;  ///< in LightAxes
  /// How many triangles that block all points run through it: +1 for one this way, -1 for the other way.
  int winding = 0;
};

/// A triangle that the points of the group lie on both sides of, or too near to: its part in the silhouette
/// is its blocking_sign at the point times its uses.
struct SometimesBlocker {
  std::uint32_t triangle = 0;
  PlaneHeight plane;
};

/// What such a triangle adds to the winding of an edge where its blocking_sign is +1.
struct SilhouetteUse {
  std::uint32_t edge = 0, blocker = 0;
  int winding = 0;
};

struct GroupSilhouette {
  std::vector<SilhouetteEdge> edges;
  std::vector<SometimesBlocker> sometimes;
  std::vector<SilhouetteUse> uses;
  std::vector<std::uint32_t> kept;  ///< scratch of drop_beside_light()

  bool empty() const { return edges.empty(); }
  void clear() {
    edges.clear();
    sometimes.clear();
    uses.clear();
  }
};

/// Drops the edges that, seen from any point of the group, no ray from a place of the light towards +u meets:
/// the winding around places of the light stays. `silhouette` stands between all points and the light's
/// plane.
void drop_beside_light(const GroupFrame& group, const LightAxes& axes, GroupSilhouette& silhouette);

/// Finds silhouettes, with a table of edges of its own.
class SilhouetteFinder {
public:
  /// Fills `out` from those of `candidates` that stand between the group's points and the light, and leaves
  /// the places of the others in `rest`. Where too few edges cancel, `out` is empty and all are left. Of no
  /// use if `stop` was requested.
  void find(const LightFrame& light, const TriangleView& triangles, const GroupCandidates& candidates,
            GroupSilhouette& out, std::vector<std::uint32_t>& rest, const StopFlag* stop = nullptr);

private:
  struct Edge {
    glm::vec3 from, to;
    int winding = 0;
    bool used = false;  ///< by a triangle that blocks sometimes
  };

  bool take(const LightFrame& light, const TriangleView& triangles, const GroupCandidates& candidates,
            GroupSilhouette& out, std::vector<std::uint32_t>& rest, const StopFlag* stop);
  void add_triangle(const glm::vec3* corners, int turn, std::int32_t blocker, GroupSilhouette& out);
  Edge& edge_of(const glm::vec3& from, const glm::vec3& to, std::uint32_t hash);
  void keep_silhouette(const LightAxes& axes, GroupSilhouette& out);

  void count_left(const Edge& edge, int change) {
    if (edge.winding != 0 || edge.used) left_ += static_cast<std::size_t>(change);
  }

  std::vector<Edge> edges_;
  std::size_t left_ = 0;              ///< edges that have not cancelled
  std::vector<std::uint32_t> table_;  ///< open addressing: index into edges_ + 1, or 0
  std::vector<std::uint32_t> kept_;
};

}  // namespace tenebra::soft
