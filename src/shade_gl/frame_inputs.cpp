#include "shade_gl/frame_inputs.h"

#include <glad/gl.h>

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <glm/gtc/type_ptr.hpp>

#include "parallel/parallel.h"

namespace tenebra::shade_gl {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

/// As Material of shaders/surfaces.glsl.
struct MaterialRecord {
  vec4 base, emissive, ambient, specular, more, detail;
  glm::ivec4 maps[4];
};

/// As texture_at of shaders/textures.glsl takes them.
glm::ivec2 map_of(const shade::MapUse& use, const TextureMap& map) {
  return {use.texture, use.coordinates | static_cast<int>(map.magnify) << 8 |
                           static_cast<int>(map.minify) << 9 | static_cast<int>(map.mip) << 10};
}
static_assert(static_cast<int>(Filter::linear) == 1 && static_cast<int>(MipFilter::nearest) == 1 &&
              static_cast<int>(Wrap::repeat) == 0 && static_cast<int>(Wrap::clamp_to_edge) == 1);

MaterialRecord record_of(const Material& m, const shade::SurfaceMaps& maps) {
  const float passing = m.tinted_transmission && m.transmission > 0 ? m.transmission : 0.0f;
  const float opaque = m.alpha_mode == AlphaMode::opaque ? 1.0f : 0.0f;
  return {vec4(m.base_color, m.alpha),
          vec4(m.emissive, static_cast<float>(m.model)),
          vec4(m.ambient, passing),
          vec4(m.model == SurfaceModel::metallic_roughness ? m.dielectric : m.specular, m.roughness),
          vec4(m.metallic, m.phong_exponent, opaque, m.specular_share),
          vec4(m.normal_scale, m.occlusion_strength, 0.0f, 0.0f),
          {{map_of(maps.base, m.base_color_map), map_of(maps.emissive, m.emissive_map)},
           {map_of(maps.gloss, shade::gloss_map(m)), map_of(maps.specular, m.specular_map)},
           {map_of(maps.transmission, m.transmission_map), map_of(maps.specular_share, m.specular_share_map)},
           {map_of(maps.normal, m.normal_map), map_of(maps.occlusion, m.occlusion_map)}}};
}
static_assert(static_cast<int>(SurfaceModel::phong) == 0 &&
              static_cast<int>(SurfaceModel::metallic_roughness) == 1 &&
              static_cast<int>(SurfaceModel::specular_glossiness) == 2 &&
              static_cast<int>(SurfaceModel::unlit) == 3);

/// As Light of shaders/lights.glsl.
struct LightRecord {
  vec4 color, from_eye, direction, cone, area_from_eye, area_normal, axis_x, axis_y;
  vec4 corners[7];
  glm::ivec4 kind;
};
static_assert(sizeof(LightRecord) == 256);

LightRecord record_of(const shade::LightTerms& terms) {
  LightRecord out{};
  out.color = vec4(terms.color, terms.range_m);
  out.from_eye = vec4(terms.from_eye, static_cast<float>(terms.distance_power));
  out.direction = vec4(terms.direction, 0.0f);
  out.cone = vec4(terms.cone, 0.0f, 0.0f);
  out.area_from_eye = vec4(terms.area_from_eye, terms.area_weight);
  out.area_normal = vec4(terms.area_normal, terms.radius_m);
  out.axis_x = vec4(terms.axis_x, 0.0f);
  out.axis_y = vec4(terms.axis_y, 0.0f);
  static_assert(std::tuple_size_v<decltype(terms.corners)> == 14);
  for (std::size_t i = 0; i < 7; ++i) out.corners[i] = vec4(terms.corners[2 * i], terms.corners[2 * i + 1]);
  out.kind = {(terms.directional ? 1 : 0) + (terms.spot ? 2 : 0) + (terms.cosine_emitter ? 4 : 0) +
                  (terms.by_irradiance ? 8 : 0),
              terms.corner_count, 0, 0};
  return out;
}

void bind_storage(GLuint at, const gl::SentBuffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, at, buffer.buffer().name());
}

template <class T>
auto bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

constexpr std::size_t most_block_bytes = std::size_t{1} << 27;  // every OpenGL 4.5 takes as many
constexpr std::size_t plane_floats = 6, head_words = 38;        // of shaders/textures.glsl

std::size_t most_rules(const shade::SurfaceTable& surfaces) {
  std::size_t most = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) most = std::max(most, surfaces.maps(i).rules.size());
  return most;
}

/// By their numbers.
std::vector<const texture::MipTexture*> textures_of(const shade::SurfaceTable& surfaces) {
  std::vector<const texture::MipTexture*> out;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const shade::SurfaceMaps& maps = surfaces.maps(i);
    for (const shade::MapUse& use : {maps.base, maps.emissive, maps.gloss, maps.specular, maps.specular_share,
                                     maps.transmission, maps.normal, maps.occlusion}) {
      if (!use) continue;
      const auto number = static_cast<std::size_t>(use.texture);
      if (number >= out.size()) out.resize(number + 1);
      out[number] = &surfaces.texture(use);
    }
  }
  return out;
}

std::size_t texel_count(const texture::MipTexture& texture) {
  const int last = texture.level_count() - 1, stride = texture.width(last) + 2;
  const std::int32_t start = texture.starts()[static_cast<std::size_t>(last)];
  return static_cast<std::size_t>(start - stride - 1 + stride * (texture.height(last) + 2));
}

std::size_t texture_bytes(const shade::SurfaceTable& surfaces) {
  std::size_t bytes = 0;
  for (const texture::MipTexture* texture : textures_of(surfaces))
    if (texture != nullptr) bytes += 8 * texel_count(*texture);
  return bytes;
}

/// Heads and texels, as `texture_words` of shaders/textures.glsl.
std::vector<std::uint32_t> texture_words(const shade::SurfaceTable& surfaces) {
  const auto textures = textures_of(surfaces);
  std::vector<std::uint32_t> words(head_words * textures.size());
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (textures[i] == nullptr) continue;
    const texture::MipTexture& texture = *textures[i];
    const std::uint32_t head[] = {
        static_cast<std::uint32_t>(texture.width()),       static_cast<std::uint32_t>(texture.height()),
        static_cast<std::uint32_t>(texture.level_count()), static_cast<std::uint32_t>(texture.wrap_u()),
        static_cast<std::uint32_t>(texture.wrap_v()),      static_cast<std::uint32_t>(words.size())};
    const auto at = words.begin() + static_cast<std::ptrdiff_t>(head_words * i);
    std::copy(texture.starts().begin(), texture.starts().end(),
              std::copy(std::begin(head), std::end(head), at));
    const std::size_t first = words.size(), count = texel_count(texture);
    words.resize(first + 2 * count);
    std::memcpy(&words[first], texture.texels(), 8 * count);
  }
  return words;
}

/// As `planes` of shaders/textures.glsl.
std::vector<float> planes_of(const shade::Subject& subject, std::size_t rules) {
  const FrameGeometry& geometry = subject.geometry;
  const shade::SurfaceTable& surfaces = subject.surfaces;
  std::vector<float> planes(plane_floats * rules * geometry.triangles.size());
  parallel::parallel_ranges(geometry.triangles.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t id = first; id < last; ++id) {
      const std::size_t material = surfaces.held(geometry.materials[id]);
      const glm::uvec3& corners = geometry.triangles[id];
      float* to = &planes[plane_floats * rules * id];
      if (!surfaces.varies(material, corners)) {
        *to = std::bit_cast<float>(0x7fc00000u);
        continue;
      }
      for (const shade::CoordinateRule& rule : surfaces.maps(material).rules) {
        const shade::CoordinatePlane plane = surfaces.coordinates(rule, corners);
        std::memcpy(to, &plane, sizeof(plane));
        to += plane_floats;
      }
    }
  });
  return planes;
}
static_assert(sizeof(shade::CoordinatePlane) == plane_floats * sizeof(float));

}  // namespace

std::string lacks(const shade::Subject& subject, const shade::Lighting& lighting) {
  if (lighting.environment != nullptr) return "an environment is not drawn by OpenGL yet";
  if (lighting.lights.size() > most_lights) return fmt::format("OpenGL draws at most {} lights", most_lights);
  for (const shade::DrawnLight& light : lighting.lights)
    if (light.area && light.area->polygon.size() > 14) return "a light has too many corners for OpenGL";
  const shade::SurfaceTable& surfaces = subject.surfaces;
  const auto too_large = [](std::size_t bytes) { return bytes > most_block_bytes; };
  if (too_large(texture_bytes(surfaces)))
    return "the textures have more than 128 MB, which not every OpenGL takes";
  if (too_large(subject.geometry.positions.size() * sizeof(vec3)) ||
      too_large(subject.geometry.triangles.size() * sizeof(float) * plane_floats * most_rules(surfaces)))
    return "the triangles have more than 128 MB, which not every OpenGL takes";
  if (subject.geometry.triangles.empty()) return "there is nothing for OpenGL to draw";
  return "";
}

Expected<void> FrameInputs::send_geometry(const FrameGeometry& geometry, std::size_t& sent_bytes,
                                          std::size_t& of_triangles) {
  has_normals_ = !geometry.normals.empty();
  triangle_count_ = static_cast<unsigned>(geometry.triangles.size());
  if (auto sent = positions_.send(bytes_of(geometry.positions), sent_bytes); !sent) return sent;
  if (auto sent = triangles_.send(bytes_of(geometry.triangles), of_triangles); !sent) return sent;
  if (auto sent = normals_.send(bytes_of(geometry.normals), sent_bytes); !sent) return sent;
  has_tangents_ = !geometry.tangents.empty();
  if (auto sent = tangents_.send(bytes_of(geometry.tangents), sent_bytes); !sent) return sent;
  auto sent = material_numbers_.send(bytes_of(geometry.materials), of_triangles);
  sent_bytes += of_triangles;
  return sent;
}

Expected<void> FrameInputs::send_materials(const shade::SurfaceTable& surfaces, std::size_t& sent_bytes) {
  material_count_ = static_cast<unsigned>(surfaces.size());
  std::vector<MaterialRecord> records;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    records.push_back(record_of(surfaces.material(i), surfaces.maps(i)));
  if (auto sent = materials_.send(bytes_of(records), sent_bytes); !sent) return sent;
  colored_vertices_ = static_cast<unsigned>(surfaces.colors().size());
  return vertex_colors_.send(bytes_of(surfaces.colors()), sent_bytes);
}

Expected<void> FrameInputs::send(const shade::Subject& subject, const shade::Lighting& lighting,
                                 std::size_t& sent_bytes) {
  view_ = subject.view;
  smooth_terminator_ = subject.smooth_terminator;
  ambient_light_ = lighting.ambient_light;
  background_ = lighting.background;
  std::vector<LightRecord> records(most_lights);
  for (std::size_t i = 0; i < lighting.lights.size(); ++i)
    records[i] = record_of(shade::light_terms(lighting.lights[i], subject.view));
  if (auto sent = lights_.send(bytes_of(records), sent_bytes); !sent) return sent;
  if (auto sent = send_materials(subject.surfaces, sent_bytes); !sent) return sent;
  std::size_t of_triangles = 0;
  if (auto sent = send_geometry(subject.geometry, sent_bytes, of_triangles); !sent) return sent;
  return send_textures(subject, of_triangles > 0, sent_bytes);
}

Expected<void> FrameInputs::send_textures(const shade::Subject& subject, bool triangles_changed,
                                          std::size_t& sent_bytes) {
  const bool is_new = textured_ != &subject.surfaces;
  if (is_new) {
    rules_ = static_cast<unsigned>(most_rules(subject.surfaces));
    const std::vector<std::uint32_t> words = texture_words(subject.surfaces);
    if (auto sent = textures_.send(bytes_of(words), sent_bytes); !sent) return sent;
    textured_ = &subject.surfaces;
  }
  if (rules_ == 0 || (!is_new && !triangles_changed)) return {};
  return planes_.send(bytes_of(planes_of(subject, rules_)), sent_bytes);
}

void FrameInputs::bind(const gl::Program& program) const {
  const GLuint name = program.name();
  const auto set = [&](GLint location, const vec3& value) {
    glProgramUniform3fv(name, location, 1, glm::value_ptr(value));
  };
  set(0, view_.eye), set(1, view_.d0), set(2, view_.dx), set(3, view_.dy);
  glProgramUniform1i(name, 4, view_.orthographic ? 1 : 0);
  glProgramUniform1ui(name, 5, triangle_count_);
  glProgramUniform1i(name, 6, has_normals_ ? 1 : 0);
  glProgramUniform1i(name, 7, smooth_terminator_ ? 1 : 0);
  set(8, ambient_light_), set(9, background_), set(10, ambient_light_);
  set(11, glm::max(background_ - ambient_light_, vec3(0.0f)));
  glProgramUniform1ui(name, 12, colored_vertices_);
  glProgramUniform1ui(name, 13, material_count_);
  glProgramUniform1ui(name, 18, rules_);
  glProgramUniform1i(name, 23, has_tangents_ ? 1 : 0);
  bind_storage(8, textures_), bind_storage(9, planes_), bind_storage(10, tangents_);
  bind_storage(0, positions_), bind_storage(1, triangles_), bind_storage(2, normals_);
  bind_storage(3, material_numbers_), bind_storage(4, materials_), bind_storage(7, vertex_colors_);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, lights_.buffer().name());
}

}  // namespace tenebra::shade_gl
