#include "render/emissive.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/fail.h"
#include "points/contact_rule.h"
#include "render/area_lights.h"

namespace tenebra::render {

namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;

/// A corner in the coordinates of its plane.
struct Corner {
  dvec2 at{0.0};
  vec3 world{0.0f};
};

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Counter-clockwise convex hull without collinear corners (Andrew's monotone chain).
std::vector<Corner> convex_hull(std::vector<Corner> corners) {
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y;
  });
  std::vector<Corner> hull;
  const auto add_side = [&](auto first, auto last) {
    const std::size_t begin = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back().at - hull[hull.size() - 2].at, first->at - hull[hull.size() - 2].at) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*first);
    }
    hull.pop_back();  // the other side begins with it
  };
  add_side(corners.begin(), corners.end());
  add_side(corners.rbegin(), corners.rend());
  return hull;
}

double area_of(const std::vector<Corner>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    twice += cross(outline[i].at - outline[0].at, outline[(i + 1) % outline.size()].at - outline[0].at);
  }
  return 0.5 * twice;
}

/// Triangles of one node with one material.
using Part = std::vector<glm::uvec3>;

dvec3 area_vector(const glm::uvec3& t, const FrameGeometry& g) {
  const dvec3 a(g.positions[t.x]), b(g.positions[t.y]), c(g.positions[t.z]);
  return 0.5 * glm::cross(b - a, c - a);
}

/// The outline of a part whose triangles, seen along their mean normal, tile a convex polygon; none if they
/// do not, or are turned to both sides.
std::optional<std::vector<vec3>> outline_of(const Part& part, const FrameGeometry& geometry) {
  dvec3 normal(0.0);
  for (const glm::uvec3& t : part) normal += area_vector(t, geometry);
  const double total = glm::length(normal);
  if (!(total > 0) || !std::isfinite(total)) return std::nullopt;
  normal /= total;
  const dvec3 ex =
      glm::normalize(glm::cross(std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), normal));
  const dvec3 ey = glm::cross(normal, ex);
  const dvec3 origin(geometry.positions[part.front().x]);
  std::vector<Corner> corners;
  vec3 far(0.0f);
  for (const glm::uvec3& t : part) {
    if (glm::dot(area_vector(t, geometry), normal) < 0) return std::nullopt;
    for (int k = 0; k < 3; ++k) {
      const vec3 world = geometry.positions[t[k]];
      const dvec3 from_origin = dvec3(world) - origin;
      corners.push_back({{glm::dot(from_origin, ex), glm::dot(from_origin, ey)}, world});
      far = glm::max(far, glm::abs(world));
    }
  }
  const auto hull = convex_hull(std::move(corners));
  if (hull.size() < 3) return std::nullopt;
  // Holes, overlaps and dents make the areas differ; the rounding of the corners does so too, by at most its
  // size times the outline's length.
  double around = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    around += glm::length(hull[(i + 1) % hull.size()].at - hull[i].at);
  }
  const vec3 farthest[3] = {far, far, far};
  if (std::abs(area_of(hull) - total) > points::rounding_tolerance(farthest) * around) return std::nullopt;
  std::vector<vec3> outline;
  outline.reserve(hull.size());
  for (const Corner& corner : hull) outline.push_back(corner.world);
  return outline;
}

Expected<AreaLight> polygon_of(const Part& part, const FrameGeometry& geometry) {
  const auto outline = outline_of(part, geometry);
  if (!outline) return base::fail("its triangles do not tile a convex polygon");
  auto area = make_area_light(*outline);
  if (!area) return area;
  for (const glm::uvec3& t : part) {
    const vec3 corners[3] = {geometry.positions[t.x], geometry.positions[t.y], geometry.positions[t.z]};
    if (!lies_in_plane(*area, corners)) return base::fail("its triangles do not lie in one plane");
  }
  return area;
}

bool shines(const Material& material) {
  const vec3& e = material.emissive;
  return e.x > 0 || e.y > 0 || e.z > 0;
}

/// The drawn triangles first .. first + count by emissive material, in the order in which these appear.
std::vector<std::pair<std::uint32_t, Part>> emissive_parts(const Scene& scene, const FrameGeometry& geometry,
                                                           std::size_t first, std::size_t count) {
  std::vector<std::pair<std::uint32_t, Part>> parts;
  for (std::size_t i = first; i < first + count; ++i) {
    const std::uint32_t material = geometry.materials[i];
    if (geometry.triangles[i] == glm::uvec3(0) || !shines(scene.materials[material])) continue;
    auto part = std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.first == material; });
    if (part == parts.end()) part = parts.insert(parts.end(), {material, {}});
    part->second.push_back(geometry.triangles[i]);
  }
  return parts;
}

}  // namespace

std::vector<EmissivePolygon> emissive_polygons(const Scene& scene, const FrameGeometry& geometry,
                                               std::vector<std::string>& notes) {
  std::vector<EmissivePolygon> polygons;
  if (std::none_of(scene.materials.begin(), scene.materials.end(), shines)) return polygons;
  std::size_t first = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const std::string name = mesh.name.empty() ? mesh.source : mesh.name;
    for (const auto& [material, part] : emissive_parts(scene, geometry, first, mesh.triangles.size())) {
      if (auto area = polygon_of(part, geometry)) {
        polygons.push_back({std::move(*area), scene.materials[material].emissive, name});
      } else {
        notes.push_back(
            fmt::format("mesh {} is emissive but lights nothing: {}", name, area.error().message));
      }
    }
    first += mesh.triangles.size();
  }
  return polygons;
}

}  // namespace tenebra::render
