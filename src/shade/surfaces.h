// The materials of a scene, their textures and the vertex data that they need, as shading reads them.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include "texture/mip_texture.h"

namespace tenebra::shade {

/// What a surface is at one place: the parameters of docs/materials.md.
struct Surface {
  glm::vec3 base{0.0f};  ///< diffuse reflectance
  glm::vec3 ambient{0.0f};
  glm::vec3 emissive{0.0f};
  float alpha = 1;           ///< share of the surface that is there
  glm::vec3 specular{0.0f};  ///< Phong: reflectance; GGX: reflectance at 0 degrees
  float roughness = -1;      ///< GGX: as glTF's, the square root of its alpha; negative: Phong
  float exponent = 1;        ///< Phong
  float grazing = 1;         ///< GGX: reflectance at 90 degrees

  bool is_glossy() const { return roughness >= 0 || specular != glm::vec3(0.0f); }
};

/// How a material's texture is read: which (-1: none), and by which of the material's coordinates.
struct MapUse {
  int texture = -1;
  int coordinates = 0;
  explicit operator bool() const { return texture >= 0; }
};
/// Coordinates that textures of a material share: a set of the vertices', and a transform.
struct CoordinateRule {
  int set = 0;
  glm::dmat3x2 transform{1, 0, 0, 1, 0, 0};
  glm::dvec2 period{0.0};  ///< the picture repeats after this; 0: it does not
  bool moves = false;      ///< the transform is not the identity
};
struct SurfaceMaps {
  MapUse base, emissive, gloss, specular, specular_share, transmission, normal, occlusion;
  std::vector<CoordinateRule> rules;  ///< at most eight
  bool any() const { return !rules.empty(); }
};

/// What SurfaceMaps::gloss reads.
inline const TextureMap& gloss_map(const Material& material) {
  return material.model == SurfaceModel::phong ? material.exponent_map : material.metallic_roughness_map;
}

/// Coordinates over a triangle: at its first vertex, and their change towards each of the others.
struct CoordinatePlane {
  glm::vec2 first{0.0f}, by_second{0.0f}, by_third{0.0f};
};

/// Made once for each scene.
class SurfaceTable {
public:
  SurfaceTable() = default;
  /// Without textures.
  explicit SurfaceTable(std::span<const Material> materials);
  /// With textures and vertex colours. Smaller copies of all images are made here, by all threads.
  explicit SurfaceTable(const Scene& scene);

  /// Other colours and factors for the same materials. Maps stay as they were made: a colour that was black
  /// and had its map left out gets none.
  void set_factors(std::span<const Material> materials);

  /// A material without its textures. Indices beyond the last material mean the last; without any, everything
  /// is black.
  const Surface& operator[](std::size_t material) const { return surfaces_[held(material)]; }
  std::size_t held(std::size_t material) const { return std::min(material, surfaces_.size() - 1); }
  std::size_t size() const { return surfaces_.size(); }
  /// Whether the surface of triangles with these vertices, of FrameGeometry's, changes over them.
  bool varies(std::size_t material, const glm::uvec3& corners) const {
    if (!maps_[material].any() && colors_.empty()) return false;
    return std::max({corners.x, corners.y, corners.z}) < coordinates_end_;
  }
  /// Whether some material reflects more than diffusely.
  bool any_glossy() const { return any_glossy_; }
  bool any_bent() const { return any_bent_; }          ///< whether some material has a normal map
  bool any_occluded() const { return any_occluded_; }  ///< whether some material has an occlusion map

  // For materials that vary; `held` as held() returns it:
  const Material& material(std::size_t held) const { return materials_[held]; }
  const SurfaceMaps& maps(std::size_t held) const { return maps_[held]; }
  const texture::MipTexture& texture(const MapUse& use) const {
    return textures_[static_cast<std::size_t>(use.texture)];
  }
  CoordinatePlane coordinates(const CoordinateRule& rule, const glm::uvec3& corners) const;
  /// By FrameGeometry's vertices; empty: all white.
  const std::vector<glm::vec4>& colors() const { return colors_; }

private:
  void add_textures(const Scene& scene);

  std::vector<Material> materials_{1};
  std::vector<Surface> surfaces_{1};
  std::vector<SurfaceMaps> maps_{1};
  std::vector<texture::MipTexture> textures_;
  std::array<std::vector<glm::vec2>, 2> coordinates_;
  std::vector<glm::vec4> colors_;
  std::size_t coordinates_end_ = 0;  ///< vertices that have coordinates and colours
  bool any_glossy_ = false, any_bent_ = false, any_occluded_ = false;
};

}  // namespace tenebra::shade
