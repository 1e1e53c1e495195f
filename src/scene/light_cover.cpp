#include "scene/light_cover.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tenebra {
namespace scene {
namespace {

constexpr std::size_t most_tests = 50'000'000;  // of a way to a light with a triangle: well below a second

struct Bounds {
  glm::dvec3 low{INFINITY};
  glm::dvec3 high{-INFINITY};

  bool empty() const { return !(low.x <= high.x); }
  void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
  void add(const Bounds& other) { low = glm::min(low, other.low), high = glm::max(high, other.high); }
  /// Whether a plane along two axes parts the two: touching counts as apart.
  bool apart(const Bounds& other) const {
    return glm::any(glm::lessThanEqual(high, other.low)) || glm::any(glm::lessThanEqual(other.high, low));
  }
};

/// The casting triangles of a mesh at its node.
struct Part {
  int node = -1;
  std::vector<glm::uvec3> triangles;
  Bounds bounds;
};

std::vector<Part> parts_of(const Scene& scene, const FrameGeometry& frame) {
  std::vector<Part> parts;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh < 0) continue;
    const std::size_t begin = frame.parts[parts.size()];
    const bool last = parts.size() + 1 == frame.parts.size();
    const std::size_t end = last ? frame.triangles.size() : frame.parts[parts.size() + 1];
    Part& part = parts.emplace_back();
    part.node = static_cast<int>(i);
    for (std::size_t t = begin; t < end; ++t) {
      const bool casts =
          frame.casts_shadow[t] != 0 || (!frame.see_through.empty() && frame.see_through[t] == 1);
      if (!casts || frame.triangles[t] == glm::uvec3(0)) continue;
      part.triangles.push_back(frame.triangles[t]);
      for (int k = 0; k < 3; ++k) part.bounds.add(glm::dvec3(frame.positions[frame.triangles[t][k]]));
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

/// Whether its front, by area, is turned to `towards`.
bool faces(const Part& part, const FrameGeometry& frame, const glm::dvec3& towards) {
  double facing = 0;
  for (const glm::uvec3& t : part.triangles) {
    const glm::dvec3 a(frame.positions[t.x]), b(frame.positions[t.y]), c(frame.positions[t.z]);
    glm::dvec3 twice_area = glm::cross(b - a, c - a);
    // Shading normals say which side is meant where triangles are wound the other way.
    const glm::dvec3 n(frame.normals[t.x] + frame.normals[t.y] + frame.normals[t.z]);
    if (glm::dot(n, twice_area) < 0) twice_area = -twice_area;
    facing += glm::dot(twice_area, towards - a);
  }
  return facing > 0;
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

bool hides(const Part& cover, const std::vector<Part>& parts, const FrameGeometry& frame,
           const WorldLight& placed, const Light& light) {
  std::size_t corners = 0;
  for (const Part& part : parts) corners += 3 * part.triangles.size();
  const std::size_t stride = 1 + corners * cover.triangles.size() / most_tests;
  std::size_t i = 0;
  for (const Part& part : parts) {
    if (&part == &cover) continue;
    for (const glm::uvec3& t : part.triangles) {
      for (int k = 0; k < 3; ++k) {
        if (i++ % stride != 0) continue;
        const Way way = way_to(placed, light, glm::dvec3(frame.positions[t[k]]));
        const bool hidden =
            std::any_of(cover.triangles.begin(), cover.triangles.end(), [&](const glm::uvec3& over) {
              return crosses(way, glm::dvec3(frame.positions[over.x]), glm::dvec3(frame.positions[over.y]),
                             glm::dvec3(frame.positions[over.z]));
            });
        if (!hidden) return false;
      }
    }
  }
  return i > 0;
}

/// Bounds of all parts before and of all parts behind each.
std::vector<Bounds> bounds_of_others(const std::vector<Part>& parts) {
  std::vector<Bounds> others(parts.size());
  Bounds before, behind;
  for (std::size_t i = 0; i < parts.size(); ++i) others[i] = before, before.add(parts[i].bounds);
  for (std::size_t i = parts.size(); i-- > 0;) others[i].add(behind), behind.add(parts[i].bounds);
  return others;
}

}  // namespace

std::vector<LightCover> find_light_covers(const Scene& scene, const FrameGeometry& frame,
                                          std::span<const WorldLight> lights) {
  std::vector<LightCover> covers;
  const std::vector<Part> parts = parts_of(scene, frame);
  const std::vector<Bounds> others = bounds_of_others(parts);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    if (part.triangles.empty() || others[i].empty()) continue;
    for (std::size_t k = 0; k < lights.size(); ++k) {
      const Light& light = scene.lights[static_cast<std::size_t>(lights[k].light)];
      if (!hides(part, parts, frame, lights[k], light)) continue;
      const glm::dvec3 middle = 0.5 * (others[i].low + others[i].high);
      const bool is_sky = part.bounds.apart(others[i]) && is_open(part, frame) && faces(part, frame, middle);
      covers.push_back({k, part.node, is_sky});
    }
  }
  return covers;
}

}  // namespace scene

namespace {

/// As --no-cast takes it where the file has a name for it.
std::string name_of_mesh(const Scene& scene, int node_index) {
  const Node& node = scene.nodes[static_cast<std::size_t>(node_index)];
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
  if (!mesh.source.empty()) return mesh.source;
  if (!mesh.name.empty()) return mesh.name;
  return fmt::format("The mesh of node {}{}", node_index, node.name.empty() ? "" : " (" + node.name + ")");
}

}  // namespace

void leave_out_covers(Scene& scene) {
  const int clip = scene.clips.empty() ? -1 : 0;
  const double time_s = scene.clips.empty() ? 0.0 : scene.clips.front().start_s;
  FrameGeometry frame;
  evaluate_frame(scene, clip, time_s, frame);
  const std::vector<WorldLight> lights = evaluate_lights(scene, clip, time_s);
  for (const scene::LightCover& cover : scene::find_light_covers(scene, frame, lights)) {
    const int number = lights[cover.light].light;
    Light& light = scene.lights[static_cast<std::size_t>(number)];
    const std::string what = name_of_mesh(scene, cover.node);
    const std::string whom = light.name.empty() ? fmt::format("light {}", number)
                                                : fmt::format("light {} ({})", number, light.name);
    if (!cover.is_sky) {
      scene.warnings.push_back(fmt::format(
          "{} hides {} from everything else: nothing else is lit by it, until --no-cast leaves it out.", what,
          whom));
      continue;
    }
    light.left_out_nodes.push_back(cover.node);
    scene.warnings.push_back(
        fmt::format("{} hides {} from everything else, like a sky: it casts no shadow from that light (with "
                    "--cast-all it does).",
                    what, whom));
  }
}

}  // namespace tenebra
