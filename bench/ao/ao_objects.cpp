#include "bench/ao/ao_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <tenebra/frame_geometry.h>
#include "base/fail.h"
#include "formats/import_scene.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::uvec3;
using glm::vec3;

/// Twelve corners and twenty faces, counter-clockwise from outside.
Object icosahedron() {
  const auto golden = static_cast<float>(std::numbers::phi);
  Object object;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float a : {-1.0f, 1.0f}) {
      for (const float b : {-golden, golden}) {
        vec3 p(0.0f);
        p[(axis + 1) % 3] = a;
        p[(axis + 2) % 3] = b;
        object.positions.push_back(glm::normalize(p));
      }
    }
  }
  // Three corners at the length of an edge from each other are a face.
  const auto& p = object.positions;
  const auto joined = [&](unsigned i, unsigned j) { return glm::distance(p[i], p[j]) < 1.1f; };
  for (unsigned i = 0; i < 12; ++i) {
    for (unsigned j = i + 1; j < 12; ++j) {
      for (unsigned k = j + 1; k < 12; ++k) {
        if (!joined(i, j) || !joined(j, k) || !joined(i, k)) continue;
        const bool outward = glm::dot(glm::cross(p[j] - p[i], p[k] - p[i]), p[i]) > 0;
        object.triangles.push_back(outward ? uvec3(i, j, k) : uvec3(i, k, j));
      }
    }
  }
  return object;
}

/// Vertices in the middle of edges, each made once.
class Middles {
public:
  explicit Middles(std::vector<vec3>& positions) : positions_(positions) {}
  unsigned between(unsigned a, unsigned b) {
    const auto [found, is_new] = known_.try_emplace(std::minmax(a, b), 0u);
    if (is_new) {
      found->second = static_cast<unsigned>(positions_.size());
      positions_.push_back(0.5f * (positions_[a] + positions_[b]));
    }
    return found->second;
  }

private:
  std::vector<vec3>& positions_;
  std::map<std::pair<unsigned, unsigned>, unsigned> known_;
};

void grow_spikes(Object& object) {
  Middles middles(object.positions);
  std::vector<uvec3> finer;
  for (const uvec3& t : object.triangles) {
    const unsigned a = middles.between(t.x, t.y), b = middles.between(t.y, t.z),
                   c = middles.between(t.z, t.x);
    const auto& p = object.positions;
    const vec3 across = glm::cross(p[b] - p[a], p[c] - p[a]);
    const float edge = glm::distance(p[a], p[b]);
    const auto tip = static_cast<unsigned>(p.size());
    object.positions.push_back((p[a] + p[b] + p[c]) / 3.0f +
                               glm::normalize(across) * (edge * std::sqrt(2.0f / 3.0f)));
    for (const uvec3& part : {uvec3(t.x, a, c), uvec3(a, t.y, b), uvec3(c, b, t.z), uvec3(a, b, tip),
                              uvec3(b, c, tip), uvec3(c, a, tip)}) {
      finer.push_back(part);
    }
  }
  object.triangles = std::move(finer);
}

dvec3 knot_centre(double turn) {
  const double r = 2 + std::cos(3 * turn);
  return {r * std::cos(2 * turn), r * std::sin(2 * turn), -std::sin(3 * turn)};
}

/// Largest extent 2, lowest point at y = 0, centred over the origin.
void stand_on_floor(Object& object) {
  vec3 low = object.positions[object.triangles[0].x], high = low;
  for (const uvec3& t : object.triangles) {
    for (int k = 0; k < 3; ++k) {
      low = glm::min(low, object.positions[t[k]]);
      high = glm::max(high, object.positions[t[k]]);
    }
  }
  const vec3 size = high - low, foot(0.5f * (low.x + high.x), low.y, 0.5f * (low.z + high.z));
  const float scale = 1.6f / std::max({size.x, size.y, size.z});
  for (vec3& p : object.positions) p = (p - foot) * scale;
}

Object object_or_knot(const std::filesystem::path& file, const std::string& name, int around, int across,
                      std::vector<std::string>& notes) {
  if (auto loaded = load_object(file, "", name)) return std::move(*loaded);
  notes.push_back(fmt::format("{} is missing: a knot of {} triangles stands in for it", file.string(),
                              2 * around * across));
  return make_knot(around, across);
}

}  // namespace

Mesh mesh_of(Object object) {
  Mesh mesh;
  mesh.name = object.name;
  mesh.materials.assign(object.triangles.size(), 0);
  mesh.positions = std::move(object.positions), mesh.triangles = std::move(object.triangles);
  return mesh;
}

Expected<Object> load_object(const std::filesystem::path& file, const std::string& mesh, std::string name) {
  auto scene = formats::import_scene(file);
  if (!scene) return tl::unexpected(scene.error());
  Object object;
  object.name = std::move(name);
  if (mesh.empty()) {
    FrameGeometry geometry;
    evaluate_frame(*scene, -1, 0, geometry);
    object.positions = std::move(geometry.positions);
    object.triangles = std::move(geometry.triangles);
    return object;
  }
  const auto found =
      std::find_if(scene->meshes.begin(), scene->meshes.end(), [&](const Mesh& m) { return m.name == mesh; });
  if (found == scene->meshes.end())
    return base::fail("{}: expected a mesh \"{}\", found none", file.string(), mesh);
  object.positions = found->positions;
  object.triangles = found->triangles;
  return object;
}

Object make_flake(int depth) {
  Object flake = icosahedron();
  for (int i = 0; i < depth; ++i) grow_spikes(flake);
  flake.name = "flake";
  return flake;
}

Object make_knot(int around, int across) {
  constexpr double turn = 2 * std::numbers::pi, thickness = 0.45;
  Object knot;
  knot.name = "knot";
  for (int i = 0; i < around; ++i) {
    const double t = turn * i / around, step = 1e-4;
    const dvec3 centre = knot_centre(t);
    const dvec3 along = glm::normalize(knot_centre(t + step) - knot_centre(t - step));
    const dvec3 side = glm::normalize(glm::cross(along, dvec3(0, 0, 1))), up = glm::cross(side, along);
    for (int j = 0; j < across; ++j) {
      const double a = turn * j / across;
      knot.positions.emplace_back(centre + thickness * (std::cos(a) * side + std::sin(a) * up));
    }
  }
  const auto at = [&](int i, int j) { return static_cast<unsigned>((i % around) * across + j % across); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      knot.triangles.emplace_back(at(i, j), at(i + 1, j), at(i, j + 1));
      knot.triangles.emplace_back(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return knot;
}

Object subdivided(const Object& object, int times) {
  Object finer = object;
  for (int i = 0; i < times; ++i) {
    Middles middles(finer.positions);
    std::vector<uvec3> triangles;
    triangles.reserve(finer.triangles.size() * 4);
    for (const uvec3& t : finer.triangles) {
      const unsigned a = middles.between(t.x, t.y), b = middles.between(t.y, t.z),
                     c = middles.between(t.z, t.x);
      for (const uvec3& part : {uvec3(t.x, a, c), uvec3(a, t.y, b), uvec3(c, b, t.z), uvec3(a, b, c)})
        triangles.push_back(part);
    }
    finer.triangles = std::move(triangles);
  }
  return finer;
}

std::filesystem::path scene_root(const std::filesystem::path& data) {
  if (data.empty()) return std::filesystem::path(TENEBRA_SHARED_DIR) / "scenes";
  std::error_code ignored;
  if (!std::filesystem::is_directory(data / "extra", ignored) &&
      std::filesystem::is_directory(data / ".." / "extra", ignored)) {
    return data / "..";
  }
  return data;
}

Expected<std::vector<Object>> error_objects(const std::filesystem::path& data,
                                            std::vector<std::string>& notes) {
  const std::filesystem::path bundled = TENEBRA_SCENES_DIR, extra = scene_root(data) / "extra";
  std::vector<Object> objects;
  auto knot = load_object(bundled / "gallery.glb", "shards", "gallery knot");
  if (!knot) return tl::unexpected(knot.error());
  objects.push_back(std::move(*knot));
  auto head = load_object(bundled / "city.glb", "robot 0 head", "robot head");
  if (!head) return tl::unexpected(head.error());
  objects.push_back(std::move(*head));
  for (const auto& [file, name] : {std::pair("obj/bunny.obj", "bunny"),
                                   std::pair("gltf/FlightHelmet/FlightHelmet.gltf", "FlightHelmet")}) {
    auto object = load_object(extra / file, "", name);
    if (object)
      objects.push_back(std::move(*object));
    else
      notes.push_back(fmt::format("{} is left out: {}", name, object.error().message));
  }
  objects.push_back(make_flake(4));
  return objects;
}

std::vector<Object> crowd_objects(const std::filesystem::path& data, std::vector<std::string>& notes) {
  const std::filesystem::path models = scene_root(data) / "extra" / "obj";
  std::vector<Object> objects;
  objects.push_back(object_or_knot(models / "bunny.obj", "bunny", 165, 20, notes));
  objects.push_back(object_or_knot(models / "spot.obj", "spot", 360, 32, notes));
  objects.push_back(make_flake(4));
  for (Object& object : objects) stand_on_floor(object);
  return objects;
}

}  // namespace tenebra::bench
