#include "formats/format_list.h"

#include <algorithm>

#include "base/lower_case.h"
#include "formats/converted.h"
#include "formats/place_scene.h"

namespace tenebra::formats {
namespace {

Expected<Scene> placed(Expected<Scene> scene, const Placement& placement) {
  if (scene) place_scene(placement, *scene);
  return scene;
}

/// `of_places`: places of nodes are floats, too.
Expected<Scene> placed_floats(Expected<Scene> scene, const Placement& placement, bool of_places) {
  scene = placed(std::move(scene), placement);
  if (scene) warn_of_stored_floats(of_places, *scene);
  return scene;
}

Expected<Scene> read_gltf_placed(const std::filesystem::path& path, const ImportOptions& options) {
  return placed_floats(import_gltf(path, options), options.placement, false);
}

Expected<Scene> read_aff_placed(const std::filesystem::path& path, const ImportOptions& options) {
  Placement placement = options.placement;  // BART's scenes keep their floats: pictures of them are compared
  if (placement.offset == OffsetChoice::automatic) placement.offset = OffsetChoice::none;
  return placed(import_aff(path, options), placement);
}

Expected<Scene> read_converted(const std::filesystem::path& path, const ImportOptions& options) {
  return placed_floats(import_converted(path, options, find_converter()), options.placement, true);
}

/// Assimp leaves Blender's axes as they are.
Expected<Scene> read_blend(const std::filesystem::path& path, const ImportOptions& options) {
  Placement placement = options.placement;
  placement.up = placement.up.value_or(UpAxis::z);
  return placed_floats(import_converted(path, options, find_converter()), placement, true);
}

constexpr std::string_view all_by_assimp = "meshes, materials, pictures, lights, cameras, animations, skins";
constexpr std::string_view looks_by_assimp = "meshes, materials, pictures, animations, skins";

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
    {".fbx", "Autodesk FBX", "Assimp",
     "meshes, materials, pictures, lights, cameras, animations, skins, morph targets", true, read_converted},
    {".dae .zae", "COLLADA", "Assimp", all_by_assimp, true, read_converted},
    {".3mf .amf", "3MF, AMF (printing)", "Assimp", "meshes, colours", false, read_converted},
    {".3ds .ase .ask", "3D Studio", "Assimp", all_by_assimp, false, read_converted},
    {".lwo .lws .lxo", "LightWave, Modo", "Assimp", all_by_assimp, false, read_converted},
    {".x .x3d", "DirectX X, X3D", "Assimp", looks_by_assimp, false, read_converted},
    {".dxf", "AutoCAD DXF", "Assimp", "faces and polylines; no solids", false, read_converted},
    {".ac .cob .ms3d", "AC3D, trueSpace, MilkShape", "Assimp", looks_by_assimp, false, read_converted},
    {".off .ogex .ter", "OFF, OpenGEX, Terragen", "Assimp", looks_by_assimp, false, read_converted},
    {".b3d .q3o .q3s", "Blitz3D, Quick3D", "Assimp", looks_by_assimp, false, read_converted},
    {".blend", "Blender up to 2.7", "Assimp", "meshes, materials, pictures, lights, cameras; in parts", true,
     read_blend},
    {".ifc", "IFC2x3 (buildings)", "Assimp", "bodies with their openings, colours; in parts", true,
     read_converted},
    {".xgl .zgl", "XGL", "Assimp", looks_by_assimp, false, read_converted},
    {".md2 .md3 .md5mesh", "Quake 2 and 3, Doom 3", "Assimp", looks_by_assimp, false, read_converted},
    {".mdl .hmp .smd", "Quake, 3DGS, Valve", "Assimp", looks_by_assimp, false, read_converted},
    {".iqm .pmx", "IQM, MikuMikuDance", "Assimp", looks_by_assimp, false, read_converted},
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
    {".blend", "open it in Blender, and there: File > Export > glTF 2.0"},
    {".step .stp .iges .igs .brep .fcstd",
     "it holds exact surfaces, not triangles; in FreeCAD: File > Open, then File > Export > glTF 2.0"},
    {".ifc .ifczip", "in Blender with the add-on Bonsai: File > Open IFC, then File > Export > glTF 2.0"},
    {".skp", "in SketchUp: File > Export > 3D Model, as glTF or OBJ"},
    {".dwg .rvt .rfa",
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

std::string_view way_to_gltf(const std::filesystem::path& file) {
  const std::string extension = base::extension_of(file);
  for (const Way& known : ways)
    if (lists(known.extensions, extension)) return known.way;
  return "export it as glTF (in Blender: File > Export > glTF 2.0)";
}

}  // namespace tenebra::formats
