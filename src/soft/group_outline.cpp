#include "soft/group_outline.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "points/triangle_corners.h"

namespace tenebra {

namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::size_t worthwhile = 32;    // triangles; fewer are subtracted one by one
constexpr std::size_t look_after = 2048;  // triangles, and give up if hardly any edge has cancelled

bool before(const vec3& a, const vec3& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

std::uint32_t hash_of(const vec3& v) {
  std::uint32_t h = 0;
  for (int k = 0; k < 3; ++k) {
    h = (h ^ std::bit_cast<std::uint32_t>(v[k] + 0.0f)) * 0x9e3779b1u;  // -0 + 0 = +0
    h ^= h >> 15;
  }
  return h;
}

// The solid angle of the light as Candidate::size gives it, were it seen face on.
int light_class(const LightFrame& light, const dvec3& point) {
  const dvec3 from = light.origin - point;
  return std::ilogb(light.area * glm::dot(light.ex, light.ex) / glm::dot(from, from));
}

}  // namespace

std::uint32_t OutlineFinder::edge_of(const vec3& from, const vec3& to) {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = (hash_of(from) * 31 + hash_of(to)) & mask;
  while (table_[slot] != 0) {
    const Edge& edge = edges_[table_[slot] - 1];
    if (edge.from == from && edge.to == to) return table_[slot] - 1;
    slot = (slot + 1) & mask;
  }
  edges_.push_back({from, to});
  table_[slot] = static_cast<std::uint32_t>(edges_.size());
  return table_[slot] - 1;
}

// `turn`: +1 if the corners run counter-clockwise in (u, v), else -1.
void OutlineFinder::add_triangle(const vec3* corners, int turn, std::int32_t blocker, GroupOutline& out) {
  for (int k = 0; k < 3; ++k) {
    const vec3 &a = corners[k], &b = corners[(k + 1) % 3];
    const bool forward = before(a, b);
    const std::uint32_t edge = forward ? edge_of(a, b) : edge_of(b, a);
    const int winding = forward ? turn : -turn;
    if (blocker < 0) {
      count_left(edges_[edge], -1);
      edges_[edge].winding += winding;
      count_left(edges_[edge], 1);
    } else {
      count_left(edges_[edge], -1);
      edges_[edge].used = true;
      count_left(edges_[edge], 1);
      out.uses.push_back({edge, static_cast<std::uint32_t>(blocker), winding});
    }
  }
}

// Drops the edges that cancel.
void OutlineFinder::keep_outline(const LightAxes& axes, GroupOutline& out) {
  kept_.assign(edges_.size(), 0);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    if (edge.winding == 0 && !edge.used) continue;
    kept_[i] = static_cast<std::uint32_t>(out.edges.size());
    out.edges.push_back(
        {axes.of(dvec3(edge.from) - axes.centre), axes.of(dvec3(edge.to) - axes.centre), edge.winding});
  }
  for (OutlineUse& use : out.uses) use.edge = kept_[use.edge];
}

// Adds up the edges of what `candidates` can give; false if too few of them cancel.
bool OutlineFinder::take(const LightFrame& light, const TriangleView& triangles,
                         const GroupCandidates& candidates, GroupOutline& out,
                         std::vector<std::uint32_t>& rest) {
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
    // Where its sign is +1, the triangle is seen as (u, v) turn if the light is `facing`.
    const Corners corners = corners_of(triangles, c.triangle);
    add_triangle(corners.v, sometimes ? facing : static_cast<int>(c.sign),
                 sometimes ? static_cast<std::int32_t>(out.sometimes.size()) - 1 : -1, out);
    if (++taken % look_after == 0 && 2 * left_ > 5 * taken) return false;
  }
  return taken >= worthwhile && 5 * left_ <= 6 * taken;
}

void OutlineFinder::find(const LightFrame& light, const TriangleView& triangles,
                         const GroupCandidates& candidates, GroupOutline& out,
                         std::vector<std::uint32_t>& rest) {
  out.clear();
  rest.clear();
  const std::size_t count = candidates.all.size();
  if (count >= worthwhile) {
    edges_.clear();
    left_ = 0;
    table_.assign(std::bit_ceil(6 * count), 0);
    if (take(light, triangles, candidates, out, rest)) return keep_outline(candidates.axes, out);
  }
  out.clear();
  rest.resize(count);
  std::iota(rest.begin(), rest.end(), 0u);
}

}  // namespace tenebra
