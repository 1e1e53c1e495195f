#include "stage/light_cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/lower_case.h"
#include "scene/frame_parts.h"

namespace tenebra::stage {
namespace {

/// The share of the other casters' vertices that a sky has to hide: BART's city has a frame about its sky,
/// and a moon above it.
constexpr double nearly_all = 0.99;
constexpr std::size_t first_look = 16;          // corners: most meshes hide next to nothing
constexpr std::size_t most_tests = 50'000'000;  // of a way to a light with a triangle: well below a second

/// The casting triangles of a mesh at its node.
struct Part {
  int node = -1;
  std::vector<glm::uvec3> triangles;
};

std::vector<Part> parts_of(const Scene& scene, const FrameGeometry& frame) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh < 0) continue;
    const auto [begin, end] = scene::triangles_of_part(frame, parts.size());
    Part& part = parts.emplace_back();
    part.node = static_cast<int>(i);
    for (std::size_t t = begin; t < end; ++t) {
      const bool casts =
          frame.casts_shadow[t] != 0 || (!frame.see_through.empty() && frame.see_through[t] == 1);
      if (!casts || frame.triangles[t] == glm::uvec3(0)) continue;
      part.triangles.push_back(frame.triangles[t]);
    }
  }
  return parts;
}

/// Whether some edge belongs to one triangle alone, by the places of its ends: so that a lamp's closed
/// housing is none.
bool is_open(const Part& part, const FrameGeometry& frame) {
  using Place = std::array<float, 3>;
  std::vector<std::pair<Place, Place>> edges;
  for (const glm::uvec3& t : part.triangles) {
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 &a = frame.positions[t[k]], &b = frame.positions[t[(k + 1) % 3]];
      const Place from{a.x, a.y, a.z}, to{b.x, b.y, b.z};
      edges.emplace_back(std::min(from, to), std::max(from, to));
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();) {
    const auto next = std::upper_bound(edges.begin() + static_cast<std::ptrdiff_t>(i), edges.end(), edges[i]);
    const auto end = static_cast<std::size_t>(next - edges.begin());
    if (end - i == 1) return true;
    i = end;
  }
  return false;
}

bool says_sky(const std::string& name) {
  return base::lower_case(name).find("sky") != std::string::npos;
}

/// Whether a mesh is painted as a sky: by its name or its material's, or because it shines or is unlit. AFF
/// and NFF have neither names nor light: there a sheet over all is one.
bool looks_like_sky(const Scene& scene, int number) {
  const Node& node = scene.nodes[static_cast<std::size_t>(number)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
  if (scene.transfer == Transfer::display || says_sky(node.name) || says_sky(mesh.name)) return true;
  return std::any_of(mesh.materials.begin(), mesh.materials.end(), [&](std::uint32_t index) {
    const Material& material = scene.materials[index];
    return material.model == SurfaceModel::unlit || material.emissive != glm::vec3(0.0f) ||
           says_sky(material.name);
  });
}

/// What lies in front of a part: n.p > limit, by the mean of its normals and the foremost of its vertices.
struct Front {
  glm::dvec3 n{0.0};
  double limit = -INFINITY;

  bool contains(const glm::dvec3& p) const { return glm::dot(n, p) > limit; }
};

Front front_of(const Part& part, const FrameGeometry& frame) {
  Front front;
  for (const glm::uvec3& t : part.triangles) {
    const glm::dvec3 a(frame.positions[t.x]), b(frame.positions[t.y]), c(frame.positions[t.z]);
    const glm::dvec3 twice_area = glm::cross(b - a, c - a);
    // Shading normals say which side is meant where triangles are wound the other way.
    const glm::dvec3 shading(frame.normals[t.x] + frame.normals[t.y] + frame.normals[t.z]);
    front.n += glm::dot(shading, twice_area) < 0 ? -twice_area : twice_area;
  }
  for (const glm::uvec3& t : part.triangles) {
    for (int k = 0; k < 3; ++k)
      front.limit = std::max(front.limit, glm::dot(front.n, glm::dvec3(frame.positions[t[k]])));
  }
  return front;
}

/// The way from a vertex to a light: p + t d, 0 < t < length.
struct Way {
  glm::dvec3 p, d;
  double length;
};

Way way_to(const WorldLight& placed, const Light& light, const glm::dvec3& from) {
  if (light.type == LightType::directional) return {from, -glm::dvec3(placed.direction), INFINITY};
  return {from, glm::dvec3(placed.position) - from, 1.0};
}

/// Edges count. Rounded: a cover is larger than what it hides by more than that.
bool crosses(const Way& way, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, normal = glm::cross(ab, ac);
  const double along = glm::dot(normal, way.d);
  if (along == 0) return false;
  const double t = glm::dot(normal, a - way.p) / along;
  if (!(t > 0 && t < way.length)) return false;
  const glm::dvec3 at = way.p + t * way.d - a;
  const double u = glm::dot(glm::cross(at, ac), normal), v = glm::dot(glm::cross(ab, at), normal);
  return u >= 0 && v >= 0 && u + v <= glm::dot(normal, normal);
}

bool covered(const Part& cover, const FrameGeometry& frame, const Way& way) {
  return std::any_of(cover.triangles.begin(), cover.triangles.end(), [&](const glm::uvec3& t) {
    return crosses(way, glm::dvec3(frame.positions[t.x]), glm::dvec3(frame.positions[t.y]),
                   glm::dvec3(frame.positions[t.z]));
  });
}

/// The corners of all parts, one triangle after the other.
struct Corners {
  std::vector<glm::dvec3> places;
  std::vector<std::size_t> parts;
};

Corners corners_of(const std::vector<Part>& parts, const FrameGeometry& frame) {
  Corners corners;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const glm::uvec3& t : parts[i].triangles) {
      for (int k = 0; k < 3; ++k) corners.places.emplace_back(frame.positions[t[k]]);
      corners.parts.insert(corners.parts.end(), 3, i);
    }
  }
  return corners;
}

/// Corners of other parts, and how many of them a part hides from a light.
struct Count {
  std::size_t all = 0, hidden = 0;
  std::size_t in_front = 0, hidden_in_front = 0;

  bool hides(double share) const {
    return hidden > 0 && static_cast<double>(hidden) >= share * static_cast<double>(all);
  }
  bool is_over(double share) const {
    return hidden_in_front > 0 && static_cast<double>(in_front) >= share * static_cast<double>(all) &&
           static_cast<double>(hidden_in_front) >= share * static_cast<double>(in_front);
  }
};

/// Looks at about `most` corners, evenly spread.
Count count_hidden(const std::vector<Part>& parts, std::size_t cover, const FrameGeometry& frame,
                   const Corners& corners, const WorldLight& placed, const Light& light, std::size_t most) {
  const Front front = front_of(parts[cover], frame);
  const std::size_t stride = 1 + corners.places.size() / std::max<std::size_t>(most, 1);
  Count count;
  for (std::size_t i = 0; i < corners.places.size(); i += stride) {
    if (corners.parts[i] == cover) continue;
    const glm::dvec3& at = corners.places[i];
    const bool in_front = front.contains(at),
               hidden = covered(parts[cover], frame, way_to(placed, light, at));
    ++count.all, count.in_front += in_front;
    count.hidden += hidden, count.hidden_in_front += in_front && hidden;
  }
  return count;
}

}  // namespace

std::vector<LightCover> find_light_covers(const Scene& scene, const FrameGeometry& frame,
                                          std::span<const WorldLight> lights) {
  std::vector<LightCover> covers;
  const std::vector<Part> parts = parts_of(scene, frame);
  const Corners corners = corners_of(parts, frame);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].triangles.empty()) continue;
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const Light& light = scene.lights[static_cast<std::size_t>(lights[k].light)];
      const auto count = [&](std::size_t most) {
        return count_hidden(parts, i, frame, corners, lights[k], light, most);
      };
      if (const Count few = count(first_look); !few.hides(0.5) && !few.is_over(0.5)) continue;
      const Count seen = count(most_tests / parts[i].triangles.size());
      const bool is_sky =
          seen.is_over(nearly_all) && is_open(parts[i], frame) && looks_like_sky(scene, parts[i].node);
      if (is_sky || seen.hides(nearly_all)) covers.push_back({k, parts[i].node, is_sky});
    }
  }
  return covers;
}

}  // namespace tenebra::stage
