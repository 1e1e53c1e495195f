#include "formats/obj/build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "formats/file_points.h"
#include "formats/polygon.h"

namespace tenebra::formats {
namespace {

constexpr std::uint32_t none = ~0u;

/// The vertices of a mesh by position, normal and coordinates: for each position of the file a chain.
class KnownVertices {
public:
  explicit KnownVertices(std::size_t positions) : heads_(positions) {}

  void begin_mesh() {
    ++mesh_;
    links_.clear();
  }
  /// The vertex of `corner`; a new one gets the next number. Of a chain only so many are looked at: a
  /// vertex that is there twice does no harm.
  std::uint32_t find(const Corner& corner, bool& is_new) {
    constexpr int most_steps = 64;
    Head& head = heads_[corner.position];
    if (head.mesh != mesh_) head = {mesh_, none};
    int steps = 0;
    for (std::uint32_t v = head.vertex; v != none && steps < most_steps; v = links_[v].next, ++steps)
      if (links_[v].coordinates == corner.coordinates && links_[v].normal == corner.normal) return v;
    is_new = true;
    links_.push_back({corner.coordinates, corner.normal, head.vertex});
    return head.vertex = static_cast<std::uint32_t>(links_.size()) - 1;
  }

private:
  struct Head {
    std::uint32_t mesh = 0, vertex = none;
  };
  struct Link {
    std::int32_t coordinates, normal;
    std::uint32_t next;
  };
  std::vector<Head> heads_;  ///< one for each position; of another mesh: empty
  std::vector<Link> links_;  ///< one for each vertex of the mesh
  std::uint32_t mesh_ = 0;
};

class MeshBuilder {
public:
  MeshBuilder(const ObjFile& file, const ObjLooks& looks)
      : file_(file), looks_(looks), known_(file.positions.size()) {}

  /// The next `faces` faces.
  Mesh build(const std::string& name, std::size_t faces) {
    Mesh mesh;
    mesh.name = name;
    known_.begin_mesh();
    has_normal_ = has_coordinates_ = has_color_ = false;
    for (const std::size_t end = face_ + faces; face_ < end; ++face_) {
      while (use_ < file_.uses.size() && file_.uses[use_].first_face <= face_) ++use_;
      add_face(mesh);
    }
    if (!has_normal_) mesh.normals.clear();
    if (!has_coordinates_) mesh.texture_coordinates[0].clear();
    if (!has_color_) mesh.colors.clear();
    return mesh;
  }
  bool used_grey() const { return used_grey_; }

private:
  void add_face(Mesh& mesh) {
    const auto corners = std::span(file_.corners).subspan(corner_, file_.faces[face_]);
    corner_ += corners.size();
    ids_.clear();
    for (const Corner& corner : corners) ids_.push_back(vertex(corner, mesh));
    const std::int32_t name = use_ > 0 ? file_.uses[use_ - 1].name : -1;
    const std::uint32_t material = name < 0 ? looks_.grey : looks_.materials[static_cast<std::size_t>(name)];
    used_grey_ |= material == looks_.grey;
    add_polygon(ids_, work_, mesh);
    mesh.materials.resize(mesh.triangles.size(), material);
  }

  std::uint32_t vertex(Corner corner, Mesh& mesh) {
    if (!looks_.textured || corner.coordinates >= static_cast<std::int64_t>(file_.coordinates.size()))
      corner.coordinates = -1;
    if (corner.normal >= static_cast<std::int64_t>(file_.normals.size())) corner.normal = -1;
    bool is_new = false;
    const std::uint32_t id = known_.find(corner, is_new);
    if (!is_new) return id;
    const glm::dvec3 place = looks_.frame.to_scene(file_.positions[corner.position]);
    mesh.positions.emplace_back(place);
    if (looks_.keep_unrounded) mesh.unrounded.push_back(place);
    mesh.normals.push_back(normal(corner.normal));
    if (looks_.textured) mesh.texture_coordinates[0].push_back(coordinates(corner.coordinates));
    if (!file_.colors.empty()) mesh.colors.push_back(color(corner.position));
    return id;
  }

  glm::vec3 normal(std::int32_t i) {
    if (i < 0) return glm::vec3(0);
    const glm::vec3 n =
        unit_or_zero(looks_.frame.direction_to_scene(file_.normals[static_cast<std::size_t>(i)]));
    has_normal_ |= n != glm::vec3(0);
    return n;
  }

  /// OBJ's v points up, ours down.
  glm::vec2 coordinates(std::int32_t i) {
    if (i < 0) return glm::vec2(0);
    has_coordinates_ = true;
    const glm::vec2 uv = file_.coordinates[static_cast<std::size_t>(i)];
    return std::isfinite(uv.x) && std::isfinite(uv.y) ? glm::vec2(uv.x, 1 - uv.y) : glm::vec2(0);
  }

  glm::vec4 color(std::uint32_t i) {
    const glm::vec3 rgb = file_.colors[i];
    if (rgb == ObjFile::not_colored) return glm::vec4(1);
    has_color_ = true;
    return glm::vec4(glm::clamp(rgb, 0.0f, 1.0f), 1);
  }

  const ObjFile& file_;
  const ObjLooks& looks_;
  KnownVertices known_;
  std::size_t face_ = 0, corner_ = 0,
              use_ = 0;             ///< next face, its first corner, the use after its material's
  std::vector<std::uint32_t> ids_;  ///< of the face's corners
  std::uint64_t work_ = 0;
  bool has_normal_ = false, has_coordinates_ = false, has_color_ = false;  ///< the mesh has some
  bool used_grey_ = false;
};

}  // namespace

bool add_meshes(const ObjFile& file, const ObjLooks& looks, Scene& scene) {
  MeshBuilder builder(file, looks);
  for (std::size_t s = 0; s < file.shapes.size(); ++s) {
    const ObjFile::Shape& shape = file.shapes[s];
    const std::size_t end = s + 1 < file.shapes.size() ? file.shapes[s + 1].first_face : file.faces.size();
    if (end == shape.first_face) continue;
    Node node;
    node.name = shape.name;
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(builder.build(shape.name, end - shape.first_face));
    scene.meshes.back().source = fmt::format("{}:{}", scene.name, shape.name);
    scene.nodes.push_back(std::move(node));
  }
  return builder.used_grey();
}

}  // namespace tenebra::formats
