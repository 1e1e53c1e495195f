// import_obj: Wavefront OBJ through tinyobjloader; polygons are cut here.
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <unordered_map>

#include "base/fail.h"
#include "formats/images/scene_images.h"
#include "formats/import_failure.h"
#include "formats/import_scene.h"
#include "formats/obj/polygon.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace {

/// Materials from the scene's folder only; what cannot be read is a warning.
class ConfinedMaterials : public tinyobj::MaterialReader {
public:
  ConfinedMaterials(std::filesystem::path folder, std::vector<std::filesystem::path>* files_read,
                    std::vector<std::string>& warnings)
      : folder_(std::move(folder)), files_read_(files_read), warnings_(warnings) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* index, std::string* warning, std::string* error) override {
    try {
      std::istringstream stream(read_scene_file(confine(folder_, name, "mtllib", false), files_read_));
      tinyobj::LoadMtl(index, materials, &stream, warning, error);
      return true;
    } catch (const UnreadableFile& failure) {
      throw UnreadableFile(fmt::format("mtllib '{}': {}", name, failure.what()));
    } catch (const ImportFailure& failure) {
      warnings_.push_back(fmt::format("mtllib '{}': {}; its materials are grey.", name, failure.what()));
      return false;
    }
  }

private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path>* files_read_;
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

/// A vertex of a mesh for each combination of indices: position, normal, texture coordinates; -1: none.
struct HashIndices {
  std::size_t operator()(const std::array<int, 3>& key) const {
    std::uint64_t hash = 0;
    for (const int index : key)
      hash = (hash ^ static_cast<std::uint32_t>(index)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return hash;
  }
};
using KnownVertices = std::unordered_map<std::array<int, 3>, std::uint32_t, HashIndices>;

struct ObjBuilder {
  const tinyobj::attrib_t& attributes;
  std::uint32_t grey;  ///< the material of faces without one
  bool has_colors;     ///< whether the vertices have any
  bool textured;       ///< whether a material has a picture: else coordinates would only split vertices
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
    const auto coordinates = static_cast<int>(attributes.texcoords.size() / 2);
    if (corner.texcoord_index >= coordinates)
      refuse("face of '{}': found texture coordinates {}, expected 1 to {}", name, corner.texcoord_index + 1,
             coordinates);
  }

  /// OBJ's v points up, ours down.
  glm::vec2 coordinates(int i) const {
    if (i < 0) return glm::vec2(0);
    const std::size_t at = 2 * static_cast<std::size_t>(i);
    const glm::vec2 uv(attributes.texcoords[at], 1 - attributes.texcoords[at + 1]);
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0);
  }

  glm::vec4 color(int i) const {
    const std::size_t at = 3 * static_cast<std::size_t>(i);
    const glm::vec3 rgb(attributes.colors[at], attributes.colors[at + 1], attributes.colors[at + 2]);
    return glm::vec4(glm::clamp(rgb, 0.0f, 1.0f), 1);
  }

  std::uint32_t vertex(const tinyobj::index_t& corner, KnownVertices& known, Mesh& mesh) const {
    const std::array<int, 3> key{corner.vertex_index, std::max(corner.normal_index, -1),
                                 textured ? std::max(corner.texcoord_index, -1) : -1};
    const auto [found, fresh] = known.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
    if (fresh) {
      mesh.positions.push_back(position(corner.vertex_index));
      mesh.normals.push_back(normal(corner.normal_index));
      if (textured) mesh.texture_coordinates[0].push_back(coordinates(corner.texcoord_index));
      if (has_colors) mesh.colors.push_back(color(corner.vertex_index));
    }
    return found->second;
  }

  void add_face(std::span<const tinyobj::index_t> corners, int material, const std::string& name,
                KnownVertices& known, Mesh& mesh) {
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
    KnownVertices known;
    std::size_t at = 0;
    for (std::size_t f = 0; f < shape.mesh.num_face_vertices.size(); ++f) {
      const std::size_t count = shape.mesh.num_face_vertices[f];
      add_face(std::span(shape.mesh.indices).subspan(at, count), shape.mesh.material_ids[f], shape.name,
               known, mesh);
      at += count;
    }
    const auto is_zero = [](const glm::vec3& n) { return n == glm::vec3(0); };
    if (std::all_of(mesh.normals.begin(), mesh.normals.end(), is_zero)) mesh.normals.clear();
    const auto has_none = [](const tinyobj::index_t& corner) { return corner.texcoord_index < 0; };
    if (std::all_of(shape.mesh.indices.begin(), shape.mesh.indices.end(), has_none))
      mesh.texture_coordinates[0].clear();
    return mesh;
  }
};

/// A finite number that is not negative, or `otherwise`.
float at_least_zero(float value, float otherwise) {
  return std::isfinite(value) && value >= 0 ? value : otherwise;
}

glm::vec3 color_of(const float (&rgb)[3]) {
  return {at_least_zero(rgb[0], 0), at_least_zero(rgb[1], 0), at_least_zero(rgb[2], 0)};
}

TextureMap map_of(const std::string& name, const tinyobj::texture_option_t& options, const std::string& place,
                  SceneImages& images) {
  TextureMap map;
  if (name.empty()) return map;
  map.image = images.find(name, place);
  if (map.image < 0) return map;
  if (options.clamp) map.wrap_u = map.wrap_v = Wrap::clamp_to_edge;
  // -s and -o scale and move coordinates whose v points up: v' = 1 - (scale * (1 - v) + offset).
  const glm::vec2 scale(options.scale[0], options.scale[1]);
  const glm::vec2 offset(options.origin_offset[0], options.origin_offset[1]);
  map.transform = {glm::vec2(scale.x, 0), glm::vec2(0, scale.y), glm::vec2(offset.x, 1 - scale.y - offset.y)};
  return map;
}

Material read_material(const tinyobj::material_t& source, SceneImages& images) {
  constexpr int diffuse_only = 1;  // one of the MTL format's illumination models
  const std::string place = fmt::format("material '{}'", source.name);
  Material material;
  material.name = source.name;
  material.base_color = color_of(source.diffuse);
  material.emissive = color_of(source.emission);
  material.base_color_map = map_of(source.diffuse_texname, source.diffuse_texopt, place + ", map_Kd", images);
  if (material.emissive != glm::vec3(0))
    material.emissive_map =
        map_of(source.emissive_texname, source.emissive_texopt, place + ", map_Ke", images);
  // Without its picture the factor alone would shine from all of the surface.
  if (!source.emissive_texname.empty() && !material.emissive_map) material.emissive = glm::vec3(0);
  if (source.illum != diffuse_only) material.specular = color_of(source.specular);
  material.phong_exponent = at_least_zero(source.shininess, 1);
  material.alpha = std::clamp(at_least_zero(source.dissolve, 1), 0.0f, 1.0f);
  if (material.alpha < 1) material.alpha_mode = AlphaMode::blend;
  return material;
}

/// What the materials have and nothing here uses.
void name_unused(const std::vector<tinyobj::material_t>& sources, Scene& scene) {
  using Name = std::string tinyobj::material_t::*;
  static constexpr std::pair<const char*, Name> unused[] = {
      {"map_d", &tinyobj::material_t::alpha_texname},
      {"map_Ks", &tinyobj::material_t::specular_texname},
      {"map_Ka", &tinyobj::material_t::ambient_texname},
      {"map_Ns", &tinyobj::material_t::specular_highlight_texname},
      {"map_bump", &tinyobj::material_t::bump_texname},
      {"disp", &tinyobj::material_t::displacement_texname},
      {"refl", &tinyobj::material_t::reflection_texname},
      {"norm", &tinyobj::material_t::normal_texname},
      {"map_Pr", &tinyobj::material_t::roughness_texname},
      {"map_Pm", &tinyobj::material_t::metallic_texname}};
  for (const auto& [name, field] : unused) {
    const auto count = std::count_if(sources.begin(), sources.end(), [field = field](const auto& source) {
      return !(source.*field).empty();
    });
    if (count == 0) continue;
    scene.warnings.push_back(
        fmt::format("{}: found in {} material{}, where it is not used.", name, count, count == 1 ? "" : "s"));
    scene.unused.push_back({name, static_cast<std::size_t>(count)});
  }
}

void add_materials(const std::vector<tinyobj::material_t>& sources, SceneImages& images, Scene& scene) {
  for (const auto& source : sources) scene.materials.push_back(read_material(source, images));
  name_unused(sources, scene);
}

/// tinyobjloader's report as one sentence.
std::string first_line(std::string text) {
  text = text.substr(0, text.find('\n'));
  while (!text.empty() && (text.back() == '.' || text.back() == ' ' || text.back() == '\r')) text.pop_back();
  return text;
}

Scene read_obj(const std::filesystem::path& path, const ImportOptions& options) {
  Scene scene;
  scene.name = path.filename().string();
  std::size_t skipped = 0;
  std::istringstream stream(keep_known_lines(read_scene_file(path, options.files_read), skipped));
  ConfinedMaterials reader(path.parent_path(), options.files_read, scene.warnings);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream, &reader, false, false))
    refuse("found a fault ({}), expected faces of vertices that are there", first_line(error));
  if (!error.empty()) scene.warnings.push_back(fmt::format("Found a fault: {}.", first_line(error)));
  SceneImages images(scene, path.parent_path(), options);
  add_materials(materials, images, scene);
  const bool has_colors =
      !attributes.colors.empty() && attributes.colors.size() == attributes.vertices.size();
  ObjBuilder builder{attributes, static_cast<std::uint32_t>(materials.size()), has_colors,
                     !scene.images.empty()};
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

Expected<Scene> import_obj(const std::filesystem::path& path, const ImportOptions& options) {
  try {
    return read_obj(path, options);
  } catch (const ImportFailure& failure) {
    return base::fail("{}: {}.", path.string(), failure.what());
  } catch (const std::bad_alloc&) {
    return base::fail("{}: found more than the memory can hold, expected a smaller scene.", path.string());
  } catch (const std::exception& error) {
    return base::fail("{}: found a fault ({}), expected an OBJ file.", path.string(), error.what());
  }
}

}  // namespace tenebra::formats
