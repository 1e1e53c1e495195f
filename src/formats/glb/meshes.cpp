// Meshes of a GLB: a primitive for each material, with the vertices that it uses and no others.
#include "formats/glb/writer.h"

namespace tenebra::formats {
namespace {

/// Triangles of one material; `flat` ones have a corner without a normal, which glTF states by leaving out
/// NORMAL.
struct Part {
  std::vector<std::uint32_t> corners;   ///< vertices of the primitive
  std::vector<std::uint32_t> vertices;  ///< vertex of the mesh for each of the primitive
};

using Parts = std::map<std::pair<std::uint32_t, bool>, Part>;  ///< by material and flatness

const std::vector<glm::vec3>& rest_positions(const Mesh& mesh) {
  return mesh.shapes.empty() ? mesh.positions : mesh.shapes[0].positions;
}
/// The normals at rest, of unit length as glTF wants them, or zero; BART's triangles have some of other
/// lengths.
std::vector<glm::vec3> rest_normals(const Mesh& mesh) {
  std::vector<glm::vec3> normals = mesh.shapes.empty() ? mesh.normals : mesh.shapes[0].normals;
  for (glm::vec3& n : normals) {
    const float length = glm::length(n);
    n = length > 0 && std::isfinite(length) ? n / length : glm::vec3(0);
  }
  return normals;
}

Parts split(const Mesh& mesh, const std::vector<glm::vec3>& normals) {
  constexpr std::uint32_t unused = 0xFFFFFFFF;
  const auto is_flat = [&](const glm::uvec3& t) {
    if (normals.empty()) return true;
    return normals[t.x] == glm::vec3(0) || normals[t.y] == glm::vec3(0) || normals[t.z] == glm::vec3(0);
  };
  std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>> chosen;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto& list = chosen[{mesh.materials[i], is_flat(mesh.triangles[i])}];
    for (int c = 0; c < 3; ++c) list.push_back(mesh.triangles[i][c]);
  }
  Parts parts;
  std::vector<std::uint32_t> place(rest_positions(mesh).size(), unused);
  for (const auto& [key, list] : chosen) {
    Part& part = parts[key];
    for (const std::uint32_t vertex : list) {
      if (place[vertex] == unused) {
        place[vertex] = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(vertex);
      }
      part.corners.push_back(place[vertex]);
    }
    for (const std::uint32_t vertex : part.vertices) place[vertex] = unused;
  }
  return parts;
}

/// `values` of the part's vertices, against `base` where one is given.
std::vector<glm::vec3> pick(const std::vector<glm::vec3>& values, const Part& part,
                            const std::vector<glm::vec3>* base = nullptr) {
  std::vector<glm::vec3> picked;
  if (values.empty()) return picked;
  picked.reserve(part.vertices.size());
  for (const std::uint32_t v : part.vertices) picked.push_back(base ? values[v] - (*base)[v] : values[v]);
  return picked;
}

/// Texture coordinates and colours. glTF counts sets from 0 on: where only the second is there, the first is
/// zeros.
void write_coordinates(const Mesh& mesh, const Part& part, GlbBinary& binary, GlbJson& attributes) {
  const auto& sets = mesh.texture_coordinates;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const bool stands_in = s == 0 && sets[0].empty() && !sets[1].empty();
    if (sets[s].empty() && !stands_in) continue;
    std::vector<float> values;
    for (const std::uint32_t v : part.vertices) {
      const glm::vec2 uv = stands_in ? glm::vec2(0) : sets[s][v];
      values.insert(values.end(), {uv.x, uv.y});
    }
    attributes[s == 0 ? "TEXCOORD_0" : "TEXCOORD_1"] = binary.add_floats(values, 2, false);
  }
  if (mesh.colors.empty()) return;
  std::vector<float> values;
  for (const std::uint32_t v : part.vertices)
    for (int c = 0; c < 4; ++c) values.push_back(mesh.colors[v][c]);
  attributes["COLOR_0"] = binary.add_floats(values, 4, false);
}

/// Left out where a vertex has none: readers make all of them then.
void write_tangents(const Mesh& mesh, const Part& part, GlbBinary& binary, GlbJson& attributes) {
  std::vector<float> values;
  for (const std::uint32_t v : part.vertices) {
    const glm::vec4& t = mesh.tangents[v];
    if (t == glm::vec4(0)) return;
    values.insert(values.end(), {t.x, t.y, t.z, t.w});
  }
  attributes["TANGENT"] = binary.add_floats(values, 4, false);
}

void write_influences(const std::vector<glm::u16vec4>& all_joints, const std::vector<glm::vec4>& all_weights,
                      const Part& part, const std::string& set, GlbJson& attributes, GlbBinary& binary) {
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;
  for (const std::uint32_t v : part.vertices)
    for (int c = 0; c < 4; ++c) {
      joints.push_back(all_weights[v][c] == 0 ? std::uint16_t{0} : all_joints[v][c]);
      weights.push_back(all_weights[v][c]);
    }
  attributes["JOINTS_" + set] = binary.add(joints, 4, 5123, false);
  attributes["WEIGHTS_" + set] = binary.add_floats(weights, 4, false);
}

GlbJson write_attributes(const Mesh& mesh, const Part& part, const std::vector<glm::vec3>& normals,
                         GlbBinary& binary) {
  GlbJson attributes = {{"POSITION", binary.add_vec3(pick(rest_positions(mesh), part), true)}};
  if (!normals.empty()) attributes["NORMAL"] = binary.add_vec3(pick(normals, part), false);
  if (!normals.empty() && !mesh.tangents.empty()) write_tangents(mesh, part, binary, attributes);
  write_coordinates(mesh, part, binary, attributes);
  if (!mesh.joints.empty()) write_influences(mesh.joints, mesh.weights, part, "0", attributes, binary);
  if (!mesh.more_joints.empty())
    write_influences(mesh.more_joints, mesh.more_weights, part, "1", attributes, binary);
  return attributes;
}

/// Displacements of glTF's targets, or of the shapes after the first against the first.
GlbJson write_targets(const Mesh& mesh, const Part& part, const std::vector<glm::vec3>& normals,
                      GlbBinary& binary) {
  GlbJson targets = GlbJson::array();
  const auto add = [&](std::vector<glm::vec3> positions, const std::vector<glm::vec3>& turns,
                       const std::vector<glm::vec3>& tangents) {
    if (positions.empty()) positions.resize(part.vertices.size());
    GlbJson target = {{"POSITION", binary.add_vec3(positions, true)}};
    if (!turns.empty()) target["NORMAL"] = binary.add_vec3(turns, false);
    if (!tangents.empty()) target["TANGENT"] = binary.add_vec3(tangents, false);
    targets.push_back(std::move(target));
  };
  for (std::size_t s = 1; s < mesh.shapes.size(); ++s)
    add(pick(mesh.shapes[s].positions, part, &mesh.shapes[0].positions),
        normals.empty() ? normals : pick(mesh.shapes[s].normals, part, &normals), {});
  if (mesh.shapes.empty())
    for (const MorphTarget& target : mesh.morph_targets)
      add(pick(target.positions, part), normals.empty() ? normals : pick(target.normals, part),
          normals.empty() ? normals : pick(target.tangents, part));
  return targets;
}

}  // namespace

int GlbBinary::add_floats(const std::vector<float>& values, int components, bool bounds) {
  not_finite += static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); }));
  return add(values, components, 5126, bounds);
}

int GlbBinary::add_vec3(const std::vector<glm::vec3>& values, bool bounds) {
  std::vector<float> flat;
  flat.reserve(values.size() * 3);
  for (const glm::vec3& v : values) flat.insert(flat.end(), {v.x, v.y, v.z});
  return add_floats(flat, 3, bounds);
}

void GlbWriter::write_primitives(std::size_t index, GlbJson& written) {
  const Mesh& mesh = scene_.meshes[index];
  const std::vector<glm::vec3> smooth = rest_normals(mesh), none;
  for (const auto& [key, part] : split(mesh, smooth)) {
    const auto [material, flat] = key;
    const auto& normals = flat ? none : smooth;
    GlbJson primitive = {{"attributes", write_attributes(mesh, part, normals, binary_)},
                         {"indices", binary_.add(part.corners, 1, 5125, false)},
                         {"material", material}};
    if (index < additions_.numbers.size() && !additions_.numbers[index].empty()) {
      std::vector<float> numbers;
      for (const std::uint32_t vertex : part.vertices) numbers.push_back(additions_.numbers[index][vertex]);
      primitive["attributes"][additions_.attribute] = binary_.add_floats(numbers, 1, true);
    }
    GlbJson targets = write_targets(mesh, part, normals, binary_);
    if (!targets.empty()) primitive["targets"] = std::move(targets);
    written["primitives"].push_back(std::move(primitive));
  }
}

void GlbWriter::write_meshes() {
  for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
    const Mesh& mesh = scene_.meshes[i];
    mesh_of_.push_back(-1);
    if (mesh.triangles.empty()) continue;
    GlbJson written = {{"name", mesh.name.empty() ? mesh.source : mesh.name}};
    write_primitives(i, written);
    if (mesh.shapes.empty() && !mesh.default_weights.empty()) written["weights"] = mesh.default_weights;
    if (!mesh.casts_shadow) written["extras"]["casts_shadow"] = false;
    mesh_of_.back() = static_cast<int>(root_["meshes"].size());
    root_["meshes"].push_back(std::move(written));
  }
}

}  // namespace tenebra::formats
