// The materials of a scene, their textures and what they need of each vertex, as shading reads them.
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

  bool is_glossy() const { return roughness >= 0 || specular != glm::vec3(0.0f); }
};

/// A material's textures: indices into SurfaceTable's; -1: none.
struct SurfaceMaps {
  int base = -1, emissive = -1, metallic_roughness = -1, specular = -1;
  bool any() const { return base >= 0 || emissive >= 0 || metallic_roughness >= 0 || specular >= 0; }
};

/// A place on a triangle: the weights of its second and third vertex, and what these change by from pixel to
/// pixel.
struct SurfacePlace {
  glm::vec2 weights{0.0f};
  glm::vec2 by_x{0.0f}, by_y{0.0f};
};

/// Made once a scene.
class SurfaceTable {
public:
  SurfaceTable() = default;
  /// Without textures.
  explicit SurfaceTable(std::span<const Material> materials);
  /// With textures and vertex colours. Smaller copies of all images are made here, by all threads.
  explicit SurfaceTable(const Scene& scene);

  /// A material without its textures. Indices beyond the last material mean the last; without any, everything
  /// is black.
  const Surface& operator[](std::size_t material) const { return surfaces_[held(material)]; }
  std::size_t held(std::size_t material) const { return std::min(material, surfaces_.size() - 1); }
  std::size_t size() const { return surfaces_.size(); }
  /// Whether a triangle's surface changes over it: the functions below then have it.
  bool varies(std::size_t material) const { return !colors_.empty() || maps_[held(material)].any(); }
  /// Whether some material reflects more than diffusely.
  bool any_glossy() const { return any_glossy_; }

  /// A material at a place of a triangle with vertices `corners`, of FrameGeometry's.
  Surface at(std::size_t material, const glm::uvec3& corners, const SurfacePlace& place) const;

private:
  glm::vec4 read(int texture, const TextureMap& map, const glm::uvec3& corners,
                 const SurfacePlace& place) const;
  void add_textures(const Scene& scene);

  std::vector<Material> materials_{1};
  std::vector<Surface> surfaces_{1};
  std::vector<SurfaceMaps> maps_{1};
  std::vector<texture::MipTexture> textures_;
  std::array<std::vector<glm::vec2>, 2> coordinates_;
  std::vector<glm::vec4> colors_;
  bool any_glossy_ = false;
};

}  // namespace tenebra::shade
