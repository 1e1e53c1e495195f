// A scene as imported: plain tables and indices, no OpenGL, nothing evaluated yet.
// Right-handed, Y up, metres where the file means metres, from Scene::frame's origin; colours as
// Scene::transfer says.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

#include <tenebra/animation.h>
#include <tenebra/material.h>

namespace tenebra {

/// Displacements of every vertex of a mesh (glTF morph target).
struct MorphTarget {
  std::vector<glm::vec3> positions;  ///< size of Mesh::positions, or empty
  std::vector<glm::vec3> normals;    ///< size of Mesh::normals, or empty
  std::vector<glm::vec3> tangents;   ///< size of Mesh::tangents, or empty
};

/// Triangles in the space of their node. All arrays of vertices have the size of `positions` or are empty.
struct Mesh {
  std::string name;                  ///< glTF or OBJ name; may be empty
  std::string source;                ///< where the file has it: "city2.aff:69", without the folder
  std::vector<glm::vec3> positions;  ///< metres, in the space of the node
  std::vector<glm::vec3> normals;    ///< unit; empty: the face normal
  std::vector<glm::vec4> tangents;   ///< where a normal map's x points to; w: side of its y; 0: FrameGeometry
  std::vector<glm::uvec3> triangles;     ///< counter-clockwise seen from the front; indices in range
  std::vector<std::uint32_t> materials;  ///< one for each triangle, an index into Scene::materials

  std::array<std::vector<glm::vec2>, 2> texture_coordinates;  ///< glTF's sense: (0,0) the picture's top left
  std::vector<glm::vec4> colors;                              ///< linear factor of base colour and alpha

  std::vector<glm::u16vec4> joints;       ///< skin: four for each vertex, indices into Skin::joints
  std::vector<glm::vec4> weights;         ///< skin: their weights, used as stored
  std::vector<glm::u16vec4> more_joints;  ///< the fifth to eighth; empty where no vertex has them
  std::vector<glm::vec4> more_weights;    ///< their weights

  std::vector<MorphTarget> morph_targets;  ///< added with the weights of the node
  std::vector<float> default_weights;      ///< one for each morph target

  /// BART's animated triangles: whole positions and normals at each key time, linear between, clamped
  /// outside.
  struct Shape {
    double time_s = 0;                 ///< of this key, seconds
    std::vector<glm::vec3> positions;  ///< as many as Mesh::positions
    std::vector<glm::vec3> normals;    ///< as many, or empty
  };
  std::vector<Shape> shapes;  ///< ascending times; if not empty, replaces positions and normals
  bool casts_shadow = true;   ///< false: it is drawn and never occludes

  /// The positions before they were rounded to floats, where the importer was asked to keep them. Empty: they
  /// were not rounded.
  std::vector<glm::dvec3> unrounded;
};

/// The nodes that move a mesh's vertices.
struct Skin {
  std::vector<int> joints;              ///< node indices
  std::vector<glm::mat4> inverse_bind;  ///< one for each joint
};

/// What a light is.
enum class LightType { point, spot, directional, area_rect, area_disk };
/// Whether light gets weaker with the distance: BART's lights do not, glTF's do.
enum class Falloff { none, inverse_square };

/// A light in the space of its node: at its origin, shining along -Z.
struct Light {
  std::string name;                           ///< the file's; may be empty
  LightType type = LightType::point;          ///< which of the members below count
  Falloff falloff = Falloff::inverse_square;  ///< of point and spot lights
  glm::vec3 color{1.0f};                      ///< linear factor, as Scene::transfer says
  float intensity = 1.0f;        ///< candela (point, spot), lux (directional), nits (area); BART: no unit
  std::optional<float> range_m;  ///< no light beyond
  float inner_cone_rad = 0.0f;   ///< spot half-angles
  float outer_cone_rad = 0.785398163f;  ///< no light beyond
  glm::vec2 size_m{1.0f};               ///< area: width and height; for a disc its diameter, twice
  float diameter_deg = 0;               ///< directional: as seen from the scene, 0 to 90; 0: hard shadows
  std::vector<int> left_out_nodes;      ///< their meshes cast no shadow from this light
};

/// How a camera projects.
enum class Projection { perspective, orthographic };

/// A camera in the space of its node: at its origin, looking along -Z, +Y up.
struct Camera {
  std::string name;                                 ///< the file's; may be empty
  Projection projection = Projection::perspective;  ///< which of the members below count
  float vertical_fov_rad = 0.785398163f;            ///< full angle, bottom to top
  float vertical_extent_m = 2.0f;                   ///< orthographic: full height of the view
  std::optional<float> aspect;  ///< width / height the file asks for; the picture's size decides
  float near_m = 0.1f;          ///< distance of the near plane along the view axis
};

/// A place in the scene's tree, and what is there. The transform to its parent's space is
/// translation * rotation * scale, or `matrix` where the file gives one that does not decompose.
struct Node {
  std::string name;                         ///< the file's; may be empty
  int parent = -1;                          ///< smaller than the node's own index; -1 for roots
  glm::dvec3 translation{0.0};              ///< metres
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit
  glm::dvec3 scale{1.0};                    ///< along the axes of the node
  std::optional<glm::dmat4> matrix;         ///< if set, replaces the three above
  int mesh = -1;                            ///< index into Scene::meshes; -1: none
  int skin = -1;                            ///< index into Scene::skins; -1: none
  int light = -1;                           ///< index into Scene::lights; -1: none
  int camera = -1;                          ///< index into Scene::cameras; -1: none
  bool visible = true;                      ///< false hides the subtree
  std::vector<float> weights;               ///< morph weights of this instance; empty: the mesh's
};

/// Which axis of a file points up.
enum class UpAxis { y, z };

/// From the coordinates of the scene's file to those of the scene, in double: (file - origin) *
/// metres_per_unit, and Z up becomes Y up by (x, z, -y). As it stands here, both are the same. Positions that
/// a user gives or gets are the file's; lengths are metres.
struct FileFrame {
  glm::dvec3 origin{0.0};      ///< in the file's coordinates; whole numbers where the program chose it
  UpAxis up = UpAxis::y;       ///< of the file
  double metres_per_unit = 1;  ///< of the file; above 0

  /// Whether the file's coordinates are the scene's.
  bool is_identity() const { return origin == glm::dvec3(0.0) && up == UpAxis::y && metres_per_unit == 1; }
  glm::dvec3 to_scene(const glm::dvec3& file) const {
    return direction_to_scene((file - origin) * metres_per_unit);
  }
  glm::dvec3 to_file(const glm::dvec3& scene) const {
    return origin + direction_to_file(scene) / metres_per_unit;
  }
  glm::dvec3 direction_to_scene(const glm::dvec3& d) const {
    return up == UpAxis::y ? d : glm::dvec3(d.x, d.z, -d.y);
  }
  glm::dvec3 direction_to_file(const glm::dvec3& d) const {
    return up == UpAxis::y ? d : glm::dvec3(d.x, -d.z, d.y);
  }
};

/// Something that a scene file holds and nothing uses: "normalTexture", "KHR_materials_clearcoat".
struct UnusedContent {
  std::string name;       ///< as the file calls it
  std::size_t count = 0;  ///< how many times
};

/// Everything that was imported.
struct Scene {
  std::string name;                     ///< file name without folder
  FileFrame frame;                      ///< where the file has what stands at a place of the scene
  std::vector<Node> nodes;              ///< parents before children
  std::vector<Mesh> meshes;             ///< indexed by Node::mesh
  std::vector<Skin> skins;              ///< indexed by Node::skin
  std::vector<Material> materials;      ///< at least one if there is any triangle
  std::vector<TextureImage> images;     ///< indexed by TextureMap::image
  std::vector<Light> lights;            ///< indexed by Node::light
  std::vector<Camera> cameras;          ///< indexed by Node::camera
  std::vector<Clip> clips;              ///< animations; empty: the scene does not move
  Transfer transfer = Transfer::srgb;   ///< what all colours of the scene mean
  glm::vec3 background{0.0f};           ///< colour where nothing is seen
  glm::vec3 ambient_light{0.1f};        ///< times the materials' ambient; formats that state one set it
  std::vector<std::string> extensions;  ///< that the file says it uses (glTF)
  std::vector<UnusedContent> unused;    ///< no warnings: `info` has one line for all
  std::vector<std::string> warnings;    ///< what was skipped, guessed or added at import, one sentence each
};

}  // namespace tenebra
