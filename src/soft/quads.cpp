#include "soft/quads.h"

#include <algorithm>
#include <cmath>

namespace tenebra {

namespace {

using glm::dvec3;

dvec3 corner_of(const Candidate& c, int k) {
  return {c.corners[k % 3][0], c.corners[k % 3][1], c.corners[k % 3][2]};
}

double size_of(const dvec3& v) {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

// Whether p, q and r turn the way of `sign` as seen from all points of a box around 0; false where rounding
// might decide.
bool turn_from_all(const dvec3& p, const dvec3& q, const dvec3& r, double sign, const dvec3& half) {
  const dvec3 n = glm::cross(q - p, r - p);
  const double rounding = 0x1p-48 * size_of(q - p) * size_of(r - p) * (size_of(p) + size_of(half));
  return sign * glm::dot(n, p) > glm::dot(glm::abs(n), half) + rounding;
}

bool may_pair(const Candidate& c) {
  return c.sign != 0 && !c.has_plane && !c.is_quad;
}

// `half`: of the points' box, in the light's axes.
bool pair(Candidate& a, const Candidate& b, const dvec3& half) {
  if (!may_pair(a) || !may_pair(b) || a.sign != b.sign) return false;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const dvec3 from = corner_of(a, i), to = corner_of(a, i + 1);
      if (corner_of(b, j) != to || corner_of(b, j + 1) != from) continue;
      const dvec3 other = corner_of(b, j + 2), own = corner_of(a, i + 2);
      if (!turn_from_all(own, from, other, a.sign, half) || !turn_from_all(other, to, own, a.sign, half))
        return false;
      const dvec3 quad[4] = {from, other, to, own};
      for (int k = 0; k < 4; ++k)
        for (int axis = 0; axis < 3; ++axis) a.corners[k][axis] = quad[k][axis];
      a.is_quad = true;
      a.size = std::max(a.size, b.size) + (a.size == b.size ? 1 : 0);
      return true;
    }
  }
  return false;
}

}  // namespace

void pair_triangles(const GroupFrame& group, GroupCandidates& candidates,
                    std::vector<std::uint32_t>& places) {
  const auto reach = [&](const dvec3& row) { return glm::dot(glm::abs(row), group.half); };
  const dvec3 half(reach(candidates.axes.u), reach(candidates.axes.v), reach(candidates.axes.height));
  std::size_t kept = 0;
  for (const std::uint32_t place : places) {
    if (kept > 0 && pair(candidates.all[places[kept - 1]], candidates.all[place], half)) continue;
    places[kept++] = place;
  }
  places.resize(kept);
}

}  // namespace tenebra
