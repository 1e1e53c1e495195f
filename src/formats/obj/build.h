// Meshes from an OBJ file's tables.
#pragma once

#include <tenebra/scene.h>
#include "formats/obj/obj_file.h"

namespace tenebra::formats {

/// How an ObjFile becomes meshes.
struct ObjLooks {
  FileFrame frame;  ///< places the positions
  std::vector<std::uint32_t>
      materials;                ///< for each of ObjFile::material_names, an index into Scene::materials
  std::uint32_t grey = 0;       ///< the material of faces without one
  bool keep_unrounded = false;  ///< ImportOptions::keep_unrounded
  bool textured = false;  ///< whether a material has a picture: else coordinates would only split vertices
};

/// Adds a node and a mesh for each shape with faces; polygons are cut into triangles. True if a triangle has
/// ObjLooks::grey. Throws ImportFailure for polygons that would take minutes to cut.
bool add_meshes(const ObjFile& file, const ObjLooks& looks, Scene& scene);

}  // namespace tenebra::formats
