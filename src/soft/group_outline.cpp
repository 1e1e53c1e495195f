#include "soft/group_outline.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "points/triangle_corners.h"
#include "soft/occluder_geometry.h"

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

// The triangle is between all points and the light's plane: its shadow there is finite, and whatever lies in
// the shadow lies behind the triangle. It is so far above the points that the division loses no more than 16
// bits.
bool stands_between(const Triangle3& t, const LightFrame& light, const GroupFrame& group) {
  const double reach = std::abs(light.normal.x) * group.half.x + std::abs(light.normal.y) * group.half.y +
                       std::abs(light.normal.z) * group.half.z;
  for (const dvec3& v : t.v) {
    const double size = sum_of(v) + sum_of(group.centre) + sum_of(group.half) + sum_of(light.origin);
    if (!(glm::dot(group.centre - v, light.normal) - reach > 0x1p-16 * size)) return false;
    if (!(glm::dot(v - light.origin, light.normal) > rounding * size)) return false;
  }
  return true;
}

// The solid angle of the light as size_class gives it, were it seen face on.
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

// Drops the edges that cancel, and finds the lines of the others.
void OutlineFinder::keep_outline(const LightFrame& light, const GroupFrame& group, GroupOutline& out) {
  // The sense in which a line's left side is positive: see edge_line.
  const double sense = glm::dot(glm::cross(light.ex, light.ey), light.origin - group.centre) > 0 ? 1.0 : -1.0;
  kept_.assign(edges_.size(), 0);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    if (edge.winding == 0 && !edge.used) continue;
    const dvec3 a(edge.from), b(edge.to);
    kept_[i] = static_cast<std::uint32_t>(out.edges.size());
    MovingLine line = edge_line(light, group.centre, a, b, sense);
    const double size = size_of(line, group.half);
    for (dvec3& c : line.c) c /= size > 0 ? size : 1.0;
    out.edges.push_back({line, light_coordinates(light, group.centre, a),
                         light_coordinates(light, group.centre, b), edge.winding});
  }
  for (OutlineUse& use : out.uses) use.edge = kept_[use.edge];
}

// Adds up the edges of what `candidates` can give; false if too few of them cancel.
bool OutlineFinder::take(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                         std::span<const std::uint32_t> candidates, GroupOutline& out,
                         std::vector<std::uint32_t>& rest) {
  const int facing = glm::dot(glm::cross(light.ex, light.ey), light.origin - group.centre) > 0 ? 1 : -1;
  const int large = light_class(light, group.centre) - 2;
  std::size_t taken = 0;
  for (const std::uint32_t id : candidates) {
    const Triangle3 t = triangle_in_double(triangles, id);
    const PlaneSides sides = plane_sides(t, light, group);
    if (sides.never) continue;
    if (size_class(t, group.centre) > large || !stands_between(t, light, group)) {
      rest.push_back(id);
      continue;
    }
    const bool sometimes = sides.points == 0 || contains(group.receivers, id);
    if (!sometimes && sides.light == (sides.points > 0 ? Side::positive : Side::negative)) continue;
    if (sometimes) out.sometimes.push_back({id, plane_height(t, group)});
    // From its negative side the triangle is seen as (u, v) turn if the light is `facing`.
    const Corners corners = corners_of(triangles, id);
    add_triangle(corners.v, sometimes ? facing : -facing * sides.points,
                 sometimes ? static_cast<std::int32_t>(out.sometimes.size()) - 1 : -1, out);
    if (++taken % look_after == 0 && 2 * left_ > 5 * taken) return false;
  }
  return taken >= worthwhile && 5 * left_ <= 6 * taken;
}

void OutlineFinder::find(const LightFrame& light, const TriangleView& triangles, const GroupFrame& group,
                         std::span<const std::uint32_t> candidates, GroupOutline& out,
                         std::vector<std::uint32_t>& rest) {
  out.clear();
  rest.clear();
  if (candidates.size() >= worthwhile) {
    edges_.clear();
    left_ = 0;
    table_.assign(std::bit_ceil(6 * candidates.size()), 0);
    if (take(light, triangles, group, candidates, out, rest)) return keep_outline(light, group, out);
  }
  out.clear();
  rest.assign(candidates.begin(), candidates.end());
}

}  // namespace tenebra
