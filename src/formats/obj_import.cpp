// import_obj: Wavefront OBJ through tinyobjloader; polygons are cut here.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <unordered_map>

#include "base/fail.h"
#include "formats/import_failure.h"
#include "formats/import_scene.h"
#include "formats/polygon.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace {

/// Materials from the scene's folder only; what cannot be read is a warning.
class ConfinedMaterials : public tinyobj::MaterialReader {
public:
  ConfinedMaterials(std::filesystem::path folder, std::vector<std::string>& warnings)
      : folder_(std::move(folder)), warnings_(warnings) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* index, std::string* warning, std::string* error) override {
    try {
      std::istringstream stream(read_scene_file(confine(folder_, name, "mtllib", false)));
      tinyobj::LoadMtl(index, materials, &stream, warning, error);
      return true;
    } catch (const ImportFailure& failure) {
      warnings_.push_back(fmt::format("mtllib '{}': {}; its materials are grey.", name, failure.what()));
      return false;
    }
  }

private:
  std::filesystem::path folder_;
  std::vector<std::string>& warnings_;
};

/// The lines that matter, continuations joined. Others (tags, skin weights, curves) would let the parser
/// allocate what they claim.
std::string keep_known_lines(const std::string& text, std::size_t& skipped) {
  std::string kept, line;
  kept.reserve(text.size());
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part);) {
    if (!part.empty() && part.back() == '\r') part.pop_back();
    line += part;
    if (!line.empty() && line.back() == '\\') {
      line.back() = ' ';
      continue;
    }
    const std::size_t start = line.find_first_not_of(" \t");
    const std::size_t end = start == std::string::npos ? start : line.find_first_of(" \t", start);
    const std::string word = start == std::string::npos ? "" : line.substr(start, end - start);
    static constexpr std::string_view known[] = {"v", "vn", "vt", "f", "o", "g", "usemtl", "mtllib"};
    if (std::find(std::begin(known), std::end(known), word) != std::end(known)) kept += line;
    skipped += word == "p" || word == "l";
    kept += '\n';  // keeps the parser's line numbers
    line.clear();
  }
  return kept;
}

struct ObjBuilder {
  const tinyobj::attrib_t& attributes;
  std::uint32_t grey;  ///< the material of faces without one
  std::uint64_t work = 0;
  bool used_grey = false;

  glm::vec3 position(int i) const {
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    return {attributes.vertices[at], attributes.vertices[at + 1], attributes.vertices[at + 2]};
  }

  glm::vec3 normal(int i) const {
    if (i < 0) return glm::vec3(0);
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    const glm::vec3 n(attributes.normals[at], attributes.normals[at + 1], attributes.normals[at + 2]);
    const float length = glm::length(n);
    return std::isfinite(length) && length > 0 ? n / length : glm::vec3(0);
  }

  void check(const tinyobj::index_t& corner, const std::string& name) const {
    const auto vertices = static_cast<int>(attributes.vertices.size() / 3);
    const auto normals = static_cast<int>(attributes.normals.size() / 3);
    if (corner.vertex_index < 0 || corner.vertex_index >= vertices)
      refuse("face of '{}': found vertex {}, expected 1 to {}", name, corner.vertex_index + 1, vertices);
    if (corner.normal_index >= normals)
      refuse("face of '{}': found normal {}, expected 1 to {}", name, corner.normal_index + 1, normals);
  }

  std::uint32_t vertex(const tinyobj::index_t& corner,
                       std::unordered_map<std::uint64_t, std::uint32_t>& known, Mesh& mesh) const {
    const std::uint64_t key = static_cast<std::uint64_t>(corner.vertex_index) << 32 |
                              static_cast<std::uint32_t>(corner.normal_index);
    const auto [found, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.push_back(position(corner.vertex_index));
      mesh.normals.push_back(normal(corner.normal_index));
    }
    return found->second;
  }

  void add_face(std::span<const tinyobj::index_t> corners, int material, const std::string& name,
                std::unordered_map<std::uint64_t, std::uint32_t>& known, Mesh& mesh) {
    constexpr std::uint64_t most_work = 300'000'000;  // corner tests in about half a second
    std::vector<std::uint32_t> ids;
    std::vector<glm::vec3> points;
    for (const auto& corner : corners) {
      check(corner, name);
      ids.push_back(vertex(corner, known, mesh));
      points.push_back(position(corner.vertex_index));
    }
    for (const glm::uvec3& t : triangulate(points, work)) {
      mesh.triangles.emplace_back(ids[t.x], ids[t.y], ids[t.z]);
      mesh.materials.push_back(material < 0 ? grey : static_cast<std::uint32_t>(material));
      used_grey |= material < 0;
    }
    if (work > most_work)
      refuse("face of '{}': found a polygon of {} corners, expected simpler ones", name, corners.size());
  }

  Mesh build(const tinyobj::shape_t& shape) {
    Mesh mesh;
    mesh.name = shape.name;
    std::unordered_map<std::uint64_t, std::uint32_t> known;
    std::size_t at = 0;
    for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f) {
      const std::size_t count = shape.mesh.num_face_vertices[f];
      add_face(std::span(shape.mesh.indices).subspan(at, count), shape.mesh.material_ids[f], shape.name,
               known, mesh);
      at += count;
    }
    const auto is_zero = [](const glm::vec3& n) { return n == glm::vec3(0); };
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_zero)) mesh.normals.clear();
    return mesh;
  }
};

void add_materials(const std::vector<tinyobj::material_t>& sources, Scene& scene) {
  for (const auto& source : sources) {
    Material material;
    material.name = source.name;
    material.base_color = {source.diffuse[0], source.diffuse[1], source.diffuse[2]};
    material.emissive = {source.emission[0], source.emission[1], source.emission[2]};
    scene.materials.push_back(std::move(material));
  }
}

/// tinyobjloader's report as one sentence.
std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == '.' || text.back() == ' ' || text.back() == '\r')) text.pop_back();
  return text;
}

Scene read_obj(const std::filesystem::path& path) {
  Scene scene;
  scene.name = path.filename().string();
  std::size_t skipped = 0;
  std::istringstream stream(keep_known_lines(read_scene_file(path), skipped));
  ConfinedMaterials reader(path.parent_path(), scene.warnings);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &reader, false, false))
    refuse("found a fault ({}), expected faces of vertices that are there", first_line(error));
  if (!error.empty()) scene.warnings.push_back(fmt::format("Found a fault: {}.", first_line(error)));
  add_materials(materials, scene);
  ObjBuilder builder{attributes, static_cast<std::uint32_t>(materials.size())};
  for (const auto& shape : shapes) {
    if (shape.mesh.indices.empty()) continue;
    Node node;
    node.name = shape.name;
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(builder.build(shape));
    scene.meshes.back().source = fmt::format("{}:{}", scene.name, shape.name);
    scene.nodes.push_back(std::move(node));
  }
  if (builder.used_grey) scene.materials.emplace_back();
  if (skipped > 0) scene.warnings.push_back(fmt::format("Skipped {} lines of points and lines.", skipped));
  if (scene.meshes.empty()) scene.warnings.push_back("The file has no faces.");
  for (const float value : attributes.vertices)
    if (!std::isfinite(value)) {
      scene.warnings.push_back("Found vertices that are not finite; triangles that use them are dropped.");
      break;
    }
  return scene;
}

}  // namespace

Expected<Scene> import_obj(const std::filesystem::path& path) {
  try {
    return read_obj(path);
  } catch (const ImportFailure& failure) {
    return base::fail("{}: {}.", path.string(), failure.what());
  } catch (const std::bad_alloc&) {
    return base::fail("{}: found more than the memory can hold, expected a smaller scene.", path.string());
  } catch (const std::exception& error) {
    return base::fail("{}: found a fault ({}), expected an OBJ file.", path.string(), error.what());
  }
}

}  // namespace tenebra::formats
