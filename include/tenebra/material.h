// Materials: how surfaces reflect and emit light, what shows through them, and their pictures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace tenebra {

/// A decoded picture. Values as its file stores them: colour encoded (sRGB in glTF, display values in BART).
struct TextureImage {
  std::string name;  ///< file name, or where the scene's file has it: "images[3]"
  int width = 0;     ///< pixels
  int height = 0;    ///< pixels
  std::vector<std::uint8_t>
      rgba;  ///< four values for each pixel, row 0 at the top; alpha 255 where it has none
};

/// What a texture shows beyond texture coordinates 0 to 1.
enum class Wrap { repeat, clamp_to_edge, mirrored_repeat };
/// How a texture's pixels are made smaller or larger; the names are those of glTF.
enum class Filter { nearest, linear };
/// How a texture's smaller copies are chosen and mixed where its pixels are made smaller.
enum class MipFilter { none, nearest, linear };

/// A picture on a surface: which one, by which coordinates, and how it is sampled.
struct TextureMap {
  int image = -1;  ///< index into Scene::images; -1: none
  int uv_set = 0;  ///< index into Mesh::texture_coordinates
  /// Applied to the coordinates, (0,0) the top left corner of the picture: transform * (u, v, 1).
  glm::mat3x2 transform{1, 0, 0, 1, 0, 0};
  Wrap wrap_u = Wrap::repeat;         ///< along u
  Wrap wrap_v = Wrap::repeat;         ///< along v
  Filter magnify = Filter::linear;    ///< where a pixel of the texture covers several of the picture
  Filter minify = Filter::linear;     ///< where a pixel of the picture covers several of the texture
  MipFilter mip = MipFilter::linear;  ///< between smaller copies

  explicit operator bool() const { return image >= 0; }  ///< whether there is a picture
};

/// Which formula reflects light (docs/materials.md).
enum class SurfaceModel {
  phong,                ///< BART and OBJ: base_color diffuse, specular with phong_exponent
  metallic_roughness,   ///< glTF
  specular_glossiness,  ///< KHR_materials_pbrSpecularGlossiness: base_color diffuse, specular, roughness
  unlit                 ///< KHR_materials_unlit: base_color as it is
};

/// What the alpha of base colour, its texture and the vertices means.
enum class AlphaMode {
  opaque,  ///< nothing
  mask,    ///< the surface ends where alpha falls below the cutoff
  blend    ///< the share of the surface that is there
};

/// How a surface reflects light, what passes through it, and whether it emits light.
struct Material {
  std::string name;  ///< the file's; may be empty
  glm::vec3 base_color{
      0.8f};                 ///< diffuse reflectance, linear (Transfer::display: as shown); BART may exceed 1
  glm::vec3 ambient{-1.0f};  ///< reflectance of the scene's ambient light; negative: base_color
  glm::vec3 emissive{0.0f};  ///< light that the surface emits, linear factor of its map
  bool casts_shadow = true;  ///< false: triangles of it never occlude

  SurfaceModel model = SurfaceModel::phong;  ///< which of the members below count
  glm::vec3 specular{
      0.0f};  ///< phong: reflectance (BART's ks); specular_glossiness: reflectance at 0 degrees
  float phong_exponent = 1.0f;  ///< phong: of the cosine to the mirrored light
  float metallic = 0.0f;        ///< metallic_roughness: 0 to 1
  float roughness = 1.0f;       ///< as glTF's: the square root of GGX's alpha
  glm::vec3 dielectric{0.04f};  ///< metallic_roughness: reflectance at 0 degrees where it is no metal
  float specular_share = 1.0f;  ///< metallic_roughness: of what it reflects there at any angle, 0 to 1
  bool double_sided = true;     ///< read and kept; every triangle is drawn from both sides

  AlphaMode alpha_mode = AlphaMode::opaque;  ///< what `alpha` means
  float alpha = 1.0f;                        ///< factor of the texture's and the vertices'
  float alpha_cutoff = 0.5f;                 ///< AlphaMode::mask
  /// Share of light that passes the part of the surface that alpha leaves: BART's T, glTF's transmission.
  /// Times base_color where `tinted` (glTF); nothing refracts.
  float transmission = 0.0f;
  bool tinted_transmission = false;  ///< light that passes is coloured by base_color

  TextureMap base_color_map;          ///< colour and alpha
  TextureMap emissive_map;            ///< colour
  TextureMap metallic_roughness_map;  ///< linear: roughness in green, metallic in blue
  TextureMap specular_map;            ///< colour of specular or dielectric; specular_glossiness: alpha too
  TextureMap specular_share_map;      ///< metallic_roughness: alpha
  TextureMap exponent_map;            ///< phong, linear: red, times the exponent
  TextureMap transmission_map;        ///< linear: red
  TextureMap normal_map;      ///< linear: a unit normal of the surface's tangent space, 0 to 1 for -1 to 1
  float normal_scale = 1.0f;  ///< times its first two components
  TextureMap occlusion_map;   ///< linear: red, the share of ambient light that arrives
  float occlusion_strength = 1.0f;  ///< 0: the map dims nothing; 1: as it says

  /// Whether light passes through some of it, so that it casts no opaque shadow.
  bool see_through() const { return alpha_mode == AlphaMode::blend || transmission > 0; }
};

/// What the colours of a scene mean, and so how a picture of it is written.
enum class Transfer {
  srgb,    ///< linear light; pictures are sRGB-encoded, colour textures decoded (glTF, OBJ)
  display  ///< display values, lit and written as they are (AFF and NFF, of 1999)
};

}  // namespace tenebra
