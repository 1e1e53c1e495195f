// import_gltf: the stages in their order; the only place that knows them all.
#include "formats/converted.h"
#include "formats/gltf/model.h"
#include "formats/import_guard.h"
#include "formats/import_scene.h"
#include "formats/scene_file.h"

namespace tenebra::formats {
namespace {

Scene read_gltf(const std::filesystem::path& path, const std::string& bytes, const ImportOptions& options) {
  gltf::Asset asset;
  asset.root = options.root;
  asset.files_read = options.files_read;
  asset.scene.name = path.filename().string();
  constexpr std::uint64_t least = std::uint64_t{96} << 20;  // of the 256 MiB that a file of any size may take
  asset.budget = gltf::Budget(least + 8 * bytes.size());
  gltf::load_model(path, bytes, asset);
  gltf::choose_scene(asset, options.scene);
  gltf::check_accessors(asset);
  gltf::build_materials(asset, path.parent_path(), options);
  gltf::build_cameras(asset);
  gltf::build_lights(asset);
  gltf::build_meshes(asset);
  const std::vector<int> scene_node = gltf::build_nodes(asset);
  gltf::build_surroundings(asset);
  gltf::build_skins(asset, scene_node);
  gltf::build_clips(asset, scene_node);
  return std::move(asset.scene);
}

}  // namespace

Expected<Scene> import_gltf(const std::filesystem::path& path, const ImportOptions& options) {
  return guarded_import(path, "a glTF file",
                        [&] { return read_gltf(path, read_scene_file(path, options.files_read), options); });
}

Expected<Scene> import_gltf_bytes(const std::filesystem::path& path, const std::string& bytes,
                                  const ImportOptions& options) {
  return guarded_import(path, "glTF", [&] { return read_gltf(path, bytes, options); });
}

}  // namespace tenebra::formats
