// The two lists of a PLY file that make a mesh.
#pragma once

#include <tenebra/scene.h>
#include "formats/ply/header.h"

namespace tenebra::formats::ply {

/// What the vertices say beside their places, into `mesh`; coordinates if `textured`; what is not used into
/// `unused`. Normals keep the file's axes and lengths. Returns the places, in the file's coordinates.
std::vector<glm::dvec3> read_vertices(const Element& element, bool textured, Values& values, Mesh& mesh,
                                      std::vector<UnusedContent>& unused);

/// PLY's v points up, ours down.
glm::vec2 coordinates_of(double s, double t);

inline constexpr std::uint32_t no_vertex = ~0u;

/// What the lists of faces of one file share.
struct FaceLists {
  std::size_t vertices = 0;         ///< of the file: without those that corners got
  std::vector<std::uint32_t> next;  ///< of each vertex another at its place, or no_vertex; or empty
  std::uint64_t left_out = 0;       ///< faces of fewer than three corners
  std::uint64_t work = 0;           ///< corner tests of polygons
};

/// Adds the faces or the strips of `element` to `mesh`, which has its vertices, with the materials below
/// `materials`. If `textured`, corners that have coordinates of their own get vertices of their own.
void read_faces(const Element& element, bool textured, std::size_t materials, Values& values, Mesh& mesh,
                std::vector<UnusedContent>& unused, FaceLists& lists);

}  // namespace tenebra::formats::ply
