#include "bake/baked_scene.h"

#include <algorithm>
#include <cmath>

#include "bake/map_layout.h"
#include "base/fail.h"
#include "parallel/parallel.h"
#include "scene/material_maps.h"

namespace tenebra::bake {
namespace {

using glm::dvec3;

/// Calls use(list) for every list of a mesh that has a value for each vertex.
template <class Use>
void each_vertex_list(Mesh& mesh, const Use& use) {
  use(mesh.positions), use(mesh.normals), use(mesh.tangents), use(mesh.colors);
  for (auto& set : mesh.texture_coordinates) use(set);
  use(mesh.joints), use(mesh.weights), use(mesh.more_joints), use(mesh.more_weights);
  for (MorphTarget& target : mesh.morph_targets)
    use(target.positions), use(target.normals), use(target.tangents);
  for (Mesh::Shape& shape : mesh.shapes) use(shape.positions), use(shape.normals);
}

/// Whether corners at that vertex have their triangles' normals.
class FlatVertices {
public:
  explicit FlatVertices(const Mesh& mesh)
      : normals_(mesh.shapes.empty() ? mesh.normals : mesh.shapes[0].normals) {}
  bool operator[](std::size_t vertex) const {
    return normals_.empty() || normals_[vertex] == glm::vec3(0.0f);
  }

private:
  std::span<const glm::vec3> normals_;
};

/// For each vertex that the mesh is to have, the one that it has now: those with normals, then one for each
/// corner at one without. Makes the triangles follow.
std::vector<std::uint32_t> renumber_corners(Mesh& mesh) {
  const FlatVertices flat(mesh);
  std::vector<std::uint32_t> from, to(mesh.positions.size());
  for (std::uint32_t v = 0; v < to.size(); ++v) {
    to[v] = static_cast<std::uint32_t>(from.size());
    if (!flat[v]) from.push_back(v);
  }
  for (glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = t[k];
      t[k] = flat[vertex] ? static_cast<std::uint32_t>(from.size()) : to[vertex];
      if (flat[vertex]) from.push_back(vertex);
    }
  }
  return from;
}

Triangle corners_of(const FrameGeometry& frame, std::uint32_t triangle) {
  const glm::uvec3 t = frame.triangles[triangle];
  return {dvec3(frame.positions[t.x]), dvec3(frame.positions[t.y]), dvec3(frame.positions[t.z])};
}

double area_of(const Triangle& t) {
  return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
}

/// A mesh at its node, by its place in FrameGeometry.
struct Part {
  Mesh* mesh = nullptr;
  std::uint32_t first_triangle = 0, last_triangle = 0, first_vertex = 0;
};
std::vector<Part> parts_of(Scene& scene, const FrameGeometry& frame) {
  std::vector<Part> parts;
  std::uint32_t vertex = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const std::uint32_t first = frame.parts[parts.size()];
    parts.push_back({&mesh, first, first + static_cast<std::uint32_t>(mesh.triangles.size()), vertex});
    vertex += static_cast<std::uint32_t>(mesh.positions.size());
  }
  return parts;
}

bool has_second_set(const Part& part) {
  return !part.mesh->texture_coordinates[1].empty();
}

/// With its corners in the frame's order, which is the mesh's turned round where the node mirrors it.
MapTriangle in_map(const FrameGeometry& frame, const Part& part, std::uint32_t number, std::uint32_t triangle,
                   const MapSquare& square) {
  MapTriangle placed{{}, triangle, number};
  const glm::uvec3 t = frame.triangles[triangle] - part.first_vertex;
  for (int k = 0; k < 3; ++k)
    placed.corners[static_cast<std::size_t>(k)] =
        square.origin + square.side * glm::dvec2(part.mesh->texture_coordinates[1][t[k]]);
  return placed;
}

void place_triangles(std::span<const Part> parts, std::span<const MapSquare> squares,
                     const FrameGeometry& frame, ScenePlaces& out) {
  out.triangles.clear(), out.flat = out.outside = 0;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    if (!has_second_set(parts[i]) || squares[i].side <= 0) continue;
    for (std::uint32_t t = parts[i].first_triangle; t < parts[i].last_triangle; ++t) {
      if (frame.triangles[t] == glm::uvec3(0)) continue;  // hidden or dropped
      const MapTriangle placed = in_map(frame, parts[i], i, t, squares[i]);
      const glm::dvec2 a = placed.corners[1] - placed.corners[0], b = placed.corners[2] - placed.corners[0];
      const bool flat = !(std::abs(a.x * b.y - a.y * b.x) > 0);
      bool outside = false;
      for (const glm::dvec2& c : placed.corners)
        for (const double x : {c.x - squares[i].origin.x, c.y - squares[i].origin.y})
          outside = outside || !(x >= -0.5 && x <= squares[i].side + 0.5);
      out.flat += flat, out.outside += outside;
      if (!flat && !outside) out.triangles.push_back(placed);
    }
  }
}

/// Whether more than a hundredth of what is covered belongs to two meshes.
bool meshes_overlap(const ScenePlaces& places) {
  constexpr int coarse = 256;
  std::vector<MapTriangle> triangles = places.triangles;
  double extent = 1;
  for (const MapTriangle& t : triangles)
    for (const glm::dvec2& c : t.corners) extent = std::max({extent, c.x, c.y});
  for (MapTriangle& t : triangles)
    for (glm::dvec2& c : t.corners) c *= coarse / extent;
  const TexelCoverage coverage(triangles, coarse, 1);
  return coverage.overlaps_between() * 100 > coverage.covered_places();
}

bool looks_at_second_set(const Material& material) {
  for (const TextureMap* map : scene::texture_maps(material))
    if (*map && map->uv_set == 1) return true;
  return false;
}

void rewrite_second_set(std::span<Part> parts, std::span<const MapSquare> squares, int size) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (glm::vec2& uv : parts[i].mesh->texture_coordinates[1])
      uv = glm::vec2((squares[i].origin + squares[i].side * glm::dvec2(uv)) / static_cast<double>(size));
}

}  // namespace

void separate_meshes(Scene& scene) {
  std::vector<bool> taken(scene.meshes.size(), false);
  for (Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (mesh < taken.size() && !taken[mesh]) {
      taken[mesh] = true;
      continue;
    }
    Mesh copy = scene.meshes[mesh];
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(copy));
  }
}

void separate_flat_corners(Scene& scene) {
  for (Mesh& mesh : scene.meshes) {
    const std::vector<std::uint32_t> from = renumber_corners(mesh);
    each_vertex_list(mesh, [&](auto& list) {
      if (list.empty()) return;
      std::remove_reference_t<decltype(list)> apart;
      apart.reserve(from.size());
      for (const std::uint32_t vertex : from) apart.push_back(list[vertex]);
      list = std::move(apart);
    });
  }
}

std::vector<Sample> vertex_samples(const FrameGeometry& frame) {
  constexpr double to_others = 1.0 / 32;  // weight of each of the other corners
  std::vector<Sample> samples;
  for (std::uint32_t i = 0; i < frame.triangles.size(); ++i) {
    const double area = area_of(corners_of(frame, i));
    if (!(area > 0) || !std::isfinite(area)) continue;
    for (int k = 0; k < 3; ++k) {
      dvec3 weights(to_others);
      weights[k] = 1 - 2 * to_others;
      samples.push_back({frame.triangles[i][k], i, static_cast<float>(area), weights});
    }
  }
  return samples;
}

std::vector<Light> vertex_light(std::span<const Sample> samples, std::span<const Light> light,
                                std::size_t vertices) {
  std::vector<glm::dvec4> sums(vertices, glm::dvec4(0.0));
  std::vector<double> shares(vertices, 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sums[samples[i].target] += static_cast<double>(samples[i].share) * glm::dvec4(light[i]);
    shares[samples[i].target] += static_cast<double>(samples[i].share);
  }
  std::vector<Light> means(vertices, Light(1.0f));
  for (std::size_t v = 0; v < vertices; ++v)
    if (shares[v] > 0) means[v] = Light(sums[v] / shares[v]);
  return means;
}

Clipped colour_vertices(Scene& scene, std::span<const Light> light, float exposure, bool openness_only) {
  Clipped clipped;
  std::size_t first = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    if (mesh.colors.empty()) mesh.colors.assign(mesh.positions.size(), glm::vec4(1.0f));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Light& l = light[first + v];
      const glm::vec3 factor = openness_only ? glm::vec3(l.a) : exposure * glm::vec3(l);
      const glm::vec3 wanted = glm::vec3(mesh.colors[v]) * factor;
      const float brightest = std::max({wanted.r, wanted.g, wanted.b});
      clipped.vertices += brightest > 1;
      clipped.brightest = std::max(clipped.brightest, brightest);
      mesh.colors[v] = glm::vec4(glm::min(wanted, glm::vec3(1.0f)), mesh.colors[v].a);
    }
    first += mesh.positions.size();
  }
  if (!openness_only)
    for (Material& material : scene.materials)
      if (material.emissive == glm::vec3(0.0f)) material.model = SurfaceModel::unlit;
  return clipped;
}

Expected<ScenePlaces> place_in_map(Scene& scene, const FrameGeometry& frame, int size) {
  std::vector<Part> parts = parts_of(scene, frame);
  ScenePlaces places;
  std::size_t with = 0;
  for (const Part& part : parts) {
    with += has_second_set(part);
    if (!has_second_set(part))
      places.parts_without.push_back(part.mesh->name.empty() ? part.mesh->source : part.mesh->name);
  }
  if (with == 0)
    return base::fail(
        "found no second set of texture coordinates (TEXCOORD_1), expected one that lays the surfaces out "
        "side by side: Blender makes it (Edit Mode, UV > Lightmap Pack, on a new UV map; then export as "
        "glTF); --to vertices needs none");
  std::vector<MapSquare> squares(parts.size(), {glm::dvec2(0.0), static_cast<double>(size)});
  place_triangles(parts, squares, frame, places);
  if (!meshes_overlap(places)) return places;
  if (std::any_of(scene.materials.begin(), scene.materials.end(), looks_at_second_set))
    return base::fail(
        "found textures that use TEXCOORD_1, which has to be rewritten as meshes overlap in it; expected a "
        "set "
        "of its own for the lightmap");
  std::vector<double> areas(parts.size(), 0.0);
  for (const MapTriangle& t : places.triangles) areas[t.part] += area_of(corners_of(frame, t.triangle));
  const auto laid_out = lay_out(areas, size);
  if (!laid_out)
    return base::fail(
        "--size {}: found {} meshes that need places of their own, expected room for squares of 8 x 8 "
        "texels; a larger map has it",
        size, with);
  place_triangles(parts, *laid_out, frame, places);
  rewrite_second_set(parts, *laid_out, size);
  places.own_squares = true;
  return places;
}

double extent_of(const FrameGeometry& frame) {
  float extent = 0;
  for (const glm::vec3& p : frame.positions)
    extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return static_cast<double>(extent);
}

void move_inside(const FrameGeometry& frame, double margin_m, std::vector<Sample>& samples) {
  std::erase_if(samples, [&](Sample& sample) {
    const auto inside = weights_inside(corners_of(frame, sample.triangle), sample.weights, margin_m);
    if (inside) sample.weights = *inside;
    return !inside;
  });
}

}  // namespace tenebra::bake
