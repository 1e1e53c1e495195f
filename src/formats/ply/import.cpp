// import_ply: PLY (the Stanford format), ASCII and binary, as one mesh.
#include <algorithm>
#include <cmath>

#include "formats/file_points.h"
#include "formats/images/scene_images.h"
#include "formats/import_guard.h"
#include "formats/ply/parts.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace {

using ply::Element;

class PlyReader {
public:
  PlyReader(std::string_view file, const ImportOptions& options, Scene& scene)
      : header_(ply::read_header(file)), values_(header_, file), options_(options), scene_(scene) {}

  Mesh read(SceneImages& images) {
    mesh_.name = scene_.name;
    mesh_.source = scene_.name;
    constexpr std::size_t most_pictures = 1000;
    for (const std::string& picture : header_.pictures)
      if (scene_.materials.size() < most_pictures) add_picture(picture, images);
    if (scene_.materials.empty()) scene_.materials.emplace_back();
    for (const Element& element : header_.elements) read_element(element);
    if (mesh_.positions.empty() || !has_faces_)
      refuse(
          "found {} points and no faces, expected a mesh: a point cloud becomes one in MeshLab (Filters > "
          "Remeshing > Surface Reconstruction)",
          mesh_.positions.size());
    finish();
    return std::move(mesh_);
  }

private:
  void add_picture(const std::string& name, SceneImages& images) {
    Material material;
    material.base_color_map.image = images.find(name, "comment TextureFile");
    textured_ |= material.base_color_map.image >= 0;
    scene_.materials.push_back(std::move(material));
  }

  void read_element(const Element& element) {
    values_.check_count(element);
    const bool faces = element.name == "face" || element.name == "tristrips";
    if (element.name == "vertex") return read_vertices(element);
    if (faces && element.count > 0) {
      has_faces_ = true;
      ply::read_faces(element, textured_, scene_.materials.size(), values_, mesh_, scene_.unused, faces_);
      return;
    }
    if (!faces && element.count > 0) scene_.unused.push_back({shown(element.name), element.count});
    values_.skip(element);
  }

  void read_vertices(const Element& element) {
    const std::vector<glm::dvec3> points =
        ply::read_vertices(element, textured_, values_, mesh_, scene_.unused);
    faces_.vertices = points.size();
    scene_.frame = choose_frame(options_.placement, {}, points);
    warn_of_odd_positions(points, scene_);
    const auto is_double = [](const ply::Property& p) {
      return p.name == "x" && p.type == ply::Type::float64;
    };
    const auto& properties = element.properties;
    if (header_.encoding != ply::Encoding::ascii &&
        std::none_of(properties.begin(), properties.end(), is_double))
      warn_of_floats(points, scene_);
    add_positions(points, scene_.frame, options_.keep_unrounded, mesh_);
    for (glm::vec3& n : mesh_.normals) n = unit_or_zero(scene_.frame.direction_to_scene(n));
  }

  void finish() {
    // With a picture they show the same again, or the grey that MeshLab writes where it has none.
    if (textured_ && !mesh_.colors.empty()) {
      scene_.unused.push_back({"vertex colours", mesh_.colors.size()});
      mesh_.colors.clear();
    }
    if (textured_ || !mesh_.colors.empty())
      for (Material& material : scene_.materials) material.base_color = glm::vec3(1);
    for (glm::vec2& place : mesh_.texture_coordinates[0])
      if (std::isnan(place.x)) place = glm::vec2(0);
    if (faces_.left_out > 0)
      scene_.warnings.push_back(
          fmt::format("Left out {} faces of fewer than three corners.", faces_.left_out));
    const auto solid = [](const glm::vec4& color) { return !(color.a > 0 && color.a < 1); };
    // Of alpha that is 0 everywhere the program that wrote it knew nothing.
    if (mesh_.colors.empty()) return;
    if (std::all_of(mesh_.colors.begin(), mesh_.colors.end(), solid))
      for (glm::vec4& color : mesh_.colors) color.a = 1;
    else
      for (Material& material : scene_.materials) material.alpha_mode = AlphaMode::blend;
  }

  const ply::Header header_;
  ply::Values values_;
  const ImportOptions& options_;
  Scene& scene_;
  Mesh mesh_;
  ply::FaceLists faces_;
  bool has_faces_ = false;
  bool textured_ = false;  ///< a picture was found
};

Scene read_ply(const std::filesystem::path& path, const ImportOptions& options) {
  const std::string bytes = read_scene_file(path, options.files_read);
  Scene scene;
  scene.name = path.filename().string();
  SceneImages images(scene, path.parent_path(), options);
  scene.meshes.push_back(PlyReader(bytes, options, scene).read(images));
  Node node;
  node.name = scene.name;
  node.mesh = 0;
  scene.nodes.push_back(std::move(node));
  return scene;
}

}  // namespace

Expected<Scene> import_ply(const std::filesystem::path& path, const ImportOptions& options) {
  return guarded_import(path, "a PLY file", [&] { return read_ply(path, options); });
}

}  // namespace tenebra::formats
