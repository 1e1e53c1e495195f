#include "soft/silhouette/group_silhouette.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "points/triangle_corners.h"

namespace tenebra::soft {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::size_t worthwhile = 32;  // triangles; fewer are subtracted one by one
// Triangles between two checks whether to give up: hardly any edge has cancelled, or a stop was requested.
constexpr std::size_t look_after = 2048;

std::uint32_t hash_of(const vec3& v) {
  const auto word = [](float value) -> std::uint64_t {
    return std::bit_cast<std::uint32_t>(value + 0.0f);  // -0 + 0 = +0
  };
  const std::uint64_t h =
      (word(v.x) | word(v.y) << 32) * 0x9e3779b97f4a7c15u ^ word(v.z) * 0xc2b2ae3d27d4eb4fu;
  return static_cast<std::uint32_t>(h >> 32) ^ static_cast<std::uint32_t>(h);
}

// The binary logarithm, rounded down, of the solid angle of the light if it were seen face on.
int light_class(const LightFrame& light, const dvec3& point) {
  const dvec3 from = light.way_from(point);
  return std::ilogb(light.area * glm::dot(light.ex, light.ex) / glm::dot(from, from));
}

// Where the shadow of a corner falls on the light's plane, from all points of a group.
struct ShadowRange {
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};

  // `half`: of the points' box in the axes. With r the ratio of the heights of light and corner over a point,
  // the shadow lies at centre + r corner - (r - weight) point: linear in r, which is monotone in the point's
  // height.
  void add(const LightAxes& axes, const dvec3& half, const dvec3& corner) {
    for (const double z : {-half.z, half.z}) {
      const double r = (axes.centre_uv.z - axes.weight * z) / (corner.z - z);
      for (int axis = 0; axis < 2; ++axis) {
        const double middle = axes.centre_uv[axis] + r * corner[axis],
                     reach = half[axis] * std::abs(axes.weight - r);
        const double rounding =
            product_rounding * (std::abs(axes.centre_uv[axis]) + std::abs(r * corner[axis]) + reach);
        low[axis] = std::min(low[axis], middle - reach - rounding);
        high[axis] = std::max(high[axis], middle + reach + rounding);
      }
    }
  }
  // No ray from the light towards +u meets it.
  bool beside_light() const { return high[0] < -1 || high[1] < -1 || low[1] > 1; }
};

}  // namespace

void drop_beside_light(const GroupFrame& group, const LightAxes& axes, GroupSilhouette& silhouette) {
  const dvec3 half = axes.half_around(group.half);
  constexpr std::uint32_t dropped = ~0u;
  std::vector<std::uint32_t>& places = silhouette.kept;
  places.assign(silhouette.edges.size(), dropped);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < silhouette.edges.size(); ++i) {
    const SilhouetteEdge edge = silhouette.edges[i];
    ShadowRange range;
    range.add(axes, half, edge.from), range.add(axes, half, edge.to);
    if (range.beside_light()) continue;
    places[i] = count;
    silhouette.edges[count++] = edge;
  }
  silhouette.edges.resize(count);
  for (SilhouetteUse& use : silhouette.uses) use.edge = places[use.edge];
  std::erase_if(silhouette.uses, [](const SilhouetteUse& use) { return use.edge == dropped; });
}

// `hash`: the same for both directions.
SilhouetteFinder::Edge& SilhouetteFinder::edge_of(const vec3& from, const vec3& to, std::uint32_t hash) {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash & mask;
  for (; table_[slot] != 0; slot = (slot + 1) & mask) {
    Edge& edge = edges_[table_[slot] - 1];
    if ((edge.from == from && edge.to == to) || (edge.from == to && edge.to == from)) return edge;
  }
  Edge& added = edges_.emplace_back();
  added.from = from;
  added.to = to;
  table_[slot] = static_cast<std::uint32_t>(edges_.size());
  return added;
}

// `turn`: +1 if the corners run counter-clockwise in (u, v), else -1.
void SilhouetteFinder::add_triangle(const vec3* corners, int turn, std::int32_t blocker,
                                    GroupSilhouette& out) {
  const std::uint32_t hashes[3] = {hash_of(corners[0]), hash_of(corners[1]), hash_of(corners[2])};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    Edge& edge = edge_of(corners[k], corners[next], hashes[k] + hashes[next]);
    const int winding = edge.from == corners[k] ? turn : -turn;
    count_left(edge, -1);
    if (blocker < 0) {
      edge.winding += winding;
    } else {
      edge.used = true;
      out.uses.push_back(
          {static_cast<std::uint32_t>(&edge - edges_.data()), static_cast<std::uint32_t>(blocker), winding});
    }
    count_left(edge, 1);
  }
}

// Drops the edges that cancel.
void SilhouetteFinder::keep_silhouette(const LightAxes& axes, GroupSilhouette& out) {
  kept_.assign(edges_.size(), 0);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    if (edge.winding == 0 && !edge.used) continue;
    kept_[i] = static_cast<std::uint32_t>(out.edges.size());
    out.edges.push_back(
        {axes.of(dvec3(edge.from) - axes.centre), axes.of(dvec3(edge.to) - axes.centre), edge.winding});
  }
  for (SilhouetteUse& use : out.uses) use.edge = kept_[use.edge];
}

// Adds up the edges of those `candidates` that may be part of a silhouette; false if too few of them cancel,
// or for a stop.
bool SilhouetteFinder::take(const LightFrame& light, const TriangleView& triangles,
                            const GroupCandidates& candidates, GroupSilhouette& out,
                            std::vector<std::uint32_t>& rest, const StopFlag* stop) {
  const int facing = static_cast<int>(candidates.axes.turn);
  const int large = light_class(light, candidates.axes.centre) - 2;
  std::size_t taken = 0;
  for (std::uint32_t place = 0; place < candidates.all.size(); ++place) {
    const Candidate& c = candidates.all[place];
    if (c.size > large || !c.stands_between) {
      rest.push_back(place);
      continue;
    }
    const bool sometimes = c.sign == 0;
    if (sometimes) out.sometimes.push_back({c.triangle, candidates.heights[c.height]});
    // Corners run counter-clockwise in (u, v) where the sign is +1. A triangle that blocks sometimes has, at
    // a point, `facing` times its blocking_sign for a sign.
    const points::Corners corners = points::corners_of(triangles, c.triangle);
    add_triangle(corners.v, sometimes ? facing : static_cast<int>(c.sign),
                 sometimes ? static_cast<std::int32_t>(out.sometimes.size()) - 1 : -1, out);
    if (++taken % look_after == 0 && (2 * left_ > 5 * taken || stop_requested(stop))) return false;
  }
  return taken >= worthwhile && 5 * left_ <= 6 * taken;
}

void SilhouetteFinder::find(const LightFrame& light, const TriangleView& triangles,
                            const GroupCandidates& candidates, GroupSilhouette& out,
                            std::vector<std::uint32_t>& rest, const StopFlag* stop) {
  out.clear();
  rest.clear();
  edges_.clear();
  table_.clear();
  const std::size_t count = candidates.all.size();
  if (count >= worthwhile) {
    left_ = 0;
    table_.assign(std::bit_ceil(6 * count), 0);
    if (take(light, triangles, candidates, out, rest, stop)) return keep_silhouette(candidates.axes, out);
  }
  out.clear();
  rest.resize(count);
  std::iota(rest.begin(), rest.end(), 0u);
}

}  // namespace tenebra::soft
