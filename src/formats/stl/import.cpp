// import_stl: STL, ASCII and binary; a mesh for each solid.
#include "formats/file_points.h"
#include "formats/import_guard.h"
#include "formats/import_scene.h"
#include "formats/scene_file.h"
#include "formats/stl/stl_file.h"

namespace tenebra::formats {
namespace {

/// Programs for printing and machining, which the format is for, have Z up.
constexpr FormatCoordinates stl_coordinates{UpAxis::z, 1};

void add_solid(const StlFile& file, std::size_t s, const ImportOptions& options, Scene& scene) {
  const StlFile::Solid& solid = file.solids[s];
  const bool last = s + 1 == file.solids.size();
  const std::size_t end_position = last ? file.positions.size() : file.solids[s + 1].first_position,
                    end_triangle = last ? file.triangles.size() : file.solids[s + 1].first_triangle;
  if (end_triangle == solid.first_triangle) return;
  Mesh mesh;
  mesh.name = shown(solid.name);
  mesh.source = fmt::format("{}:{}", scene.name, mesh.name);
  add_positions(std::span(file.positions).subspan(solid.first_position, end_position - solid.first_position),
                scene.frame, options.keep_unrounded, mesh);
  mesh.triangles.reserve(end_triangle - solid.first_triangle);
  const auto first = glm::uvec3(static_cast<std::uint32_t>(solid.first_position));
  for (std::size_t t = solid.first_triangle; t < end_triangle; ++t)
    mesh.triangles.push_back(file.triangles[t] - first);
  mesh.materials.assign(mesh.triangles.size(), 0);
  Node node;
  node.name = mesh.name;
  node.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(std::move(mesh));
  scene.nodes.push_back(std::move(node));
}

Scene read_stl(const std::filesystem::path& path, const ImportOptions& options) {
  Scene scene;
  scene.name = path.filename().string();
  StlFile file = parse_stl(read_scene_file(path, options.files_read));
  scene.warnings = std::move(file.warnings);
  scene.frame = choose_frame(options.placement, stl_coordinates, file.positions);
  warn_of_odd_positions(file.positions, scene);
  if (file.floats) warn_of_floats(file.positions, scene);
  for (std::size_t s = 0; s < file.solids.size(); ++s) add_solid(file, s, options, scene);
  if (!scene.meshes.empty()) scene.materials.emplace_back();
  if (file.colored > 0) scene.unused.push_back({"colours of facets", file.colored});
  return scene;
}

}  // namespace

Expected<Scene> import_stl(const std::filesystem::path& path, const ImportOptions& options) {
  return guarded_import(path, "an STL file", [&] { return read_stl(path, options); });
}

}  // namespace tenebra::formats
