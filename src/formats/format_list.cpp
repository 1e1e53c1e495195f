#include "formats/format_list.h"

#include "base/lower_case.h"
#include "formats/place_scene.h"

namespace tenebra::formats {
namespace {

Expected<Scene> placed(Expected<Scene> scene, const Placement& placement) {
  if (scene) place_scene(placement, *scene);
  return scene;
}

Expected<Scene> read_gltf_placed(const std::filesystem::path& path, const ImportOptions& options) {
  return placed(import_gltf(path, options), options.placement);
}

Expected<Scene> read_aff_placed(const std::filesystem::path& path, const ImportOptions& options) {
  Placement placement = options.placement;  // BART's scenes keep their floats: pictures of them are compared
  if (placement.offset == OffsetChoice::automatic) placement.offset = OffsetChoice::none;
  return placed(import_aff(path, options), placement);
}

constexpr FileFormat formats[] = {
    {".gltf .glb", "glTF 2.0", "own",
     "meshes, nodes, materials, pictures, lights, cameras, animations, skins, morph targets", true,
     read_gltf_placed},
    {".obj", "Wavefront OBJ, MTL", "own", "meshes in double, materials, pictures, colours of vertices", false,
     import_obj},
    {".ply", "PLY (Stanford)", "own", "one mesh in double, colours of vertices, coordinates, pictures", false,
     import_ply},
    {".stl", "STL", "own", "meshes in double where the file is text", false, import_stl},
    {".aff .nff", "BART's AFF, NFF", "own", "meshes, materials, pictures, lights, cameras, animations", false,
     read_aff_placed},
};

/// Whether `extension` is one of `list`, which has a blank between two.
bool lists(std::string_view list, std::string_view extension) {
  while (!list.empty()) {
    const std::string_view one = list.substr(0, list.find(' '));
    if (one == extension) return true;
    list.remove_prefix(std::min(list.size(), one.size() + 1));
  }
  return false;
}

struct Way {
  std::string_view extensions, way;
};
constexpr Way ways[] = {
    {".blend", "in Blender: File > Export > glTF 2.0"},
    {".step .stp .iges .igs .brep .fcstd", "in FreeCAD: File > Export > glTF 2.0"},
    {".ifc", "in Blender with the add-on Bonsai: File > Open IFC, then File > Export > glTF 2.0"},
    {".skp", "in SketchUp: File > Export > 3D Model, as glTF or OBJ"},
    {".dwg .dxf .rvt .rfa",
     "in the program that it comes from export it as FBX or OBJ, then in Blender: File > Export > glTF 2.0"},
    {".max .ma .mb .c4d .3dm .hip", "in the program that it comes from: export it as glTF, FBX or OBJ"},
    {".usd .usda .usdc .usdz .abc .gml .las .laz .e57",
     "in Blender: File > Import, then File > Export > glTF 2.0"},
};

}  // namespace

std::span<const FileFormat> file_formats() {
  return formats;
}

const FileFormat* format_of(const std::filesystem::path& file) {
  const std::string extension = base::extension_of(file);
  for (const FileFormat& format : formats)
    if (lists(format.extensions, extension)) return &format;
  return nullptr;
}

std::string known_extensions() {
  std::string all;
  for (const FileFormat& format : formats) all.append(all.empty() ? "" : " ").append(format.extensions);
  return all;
}

std::string_view way_to_gltf(const std::filesystem::path& file) {
  const std::string extension = base::extension_of(file);
  for (const Way& known : ways)
    if (lists(known.extensions, extension)) return known.way;
  return "export it as glTF (in Blender: File > Export > glTF 2.0)";
}

}  // namespace tenebra::formats
