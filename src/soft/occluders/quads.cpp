#include "soft/occluders/quads.h"

#include "math/l1_norm.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tenebra::soft {

namespace {

using glm::dvec3;

dvec3 corner_of(const Candidate& c, int k) {
  return {c.corners[k % 3][0], c.corners[k % 3][1], c.corners[k % 3][2]};
}

// Whether p, q and r turn the way of `sign` as seen from all points of a box around 0; false where rounding
// might decide.
bool turn_from_all(const dvec3& p, const dvec3& q, const dvec3& r, double sign, const dvec3& half) {
  const dvec3 n = glm::cross(q - p, r - p);
  const double rounding = product_rounding * math::l1_norm(q - p) * math::l1_norm(r - p) *
                          (math::l1_norm(p) + math::l1_norm(half));
  return sign * glm::dot(n, p) > glm::dot(glm::abs(n), half) + rounding;
}

bool may_pair(const Candidate& c) {
  return c.sign != 0 && !c.has_plane && !c.is_quad;
}

struct SharedEdge {
  int of_a = 0, of_b = 0;  // its first corners
};

// An edge that both run through, in opposite directions.
std::optional<SharedEdge> shared_edge(const Candidate& a, const Candidate& b) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (corner_of(a, i) == corner_of(b, j + 1) && corner_of(a, i + 1) == corner_of(b, j))
        return SharedEdge{i, j};
  return std::nullopt;
}

// `half`: of the points' box, in the light's axes.
bool pair(Candidate& a, const Candidate& b, const dvec3& half) {
  if (!may_pair(a) || !may_pair(b) || a.sign != b.sign) return false;
  const auto edge = shared_edge(a, b);
  if (!edge) return false;
  const dvec3 quad[4] = {corner_of(a, edge->of_a), corner_of(b, edge->of_b + 2), corner_of(a, edge->of_a + 1),
                         corner_of(a, edge->of_a + 2)};
  if (!turn_from_all(quad[3], quad[0], quad[1], a.sign, half) ||
      !turn_from_all(quad[1], quad[2], quad[3], a.sign, half))
    return false;
  for (int k = 0; k < 4; ++k)
    for (int axis = 0; axis < 3; ++axis) a.corners[k][axis] = quad[k][axis];
  a.is_quad = true;
  a.size = std::max(a.size, b.size) + (a.size == b.size ? 1 : 0);
  return true;
}

}  // namespace

void pair_triangles(const GroupFrame& group, GroupCandidates& candidates,
                    std::vector<std::uint32_t>& places) {
  const dvec3 half = candidates.axes.half_around(group.half);
  std::size_t kept = 0;
  for (const std::uint32_t place : places) {
    if (kept > 0 && pair(candidates.all[places[kept - 1]], candidates.all[place], half)) {
      candidates.all[places[kept - 1]].second = place;
      continue;
    }
    places[kept++] = place;
  }
  places.resize(kept);
}

}  // namespace tenebra::soft
