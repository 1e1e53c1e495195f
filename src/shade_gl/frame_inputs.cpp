#include "shade_gl/frame_inputs.h"

#include <glad/gl.h>

#include <fmt/core.h>

#include <glm/gtc/type_ptr.hpp>

namespace tenebra::shade_gl {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

/// As Material of shaders/surfaces.glsl.
struct MaterialRecord {
  vec4 base, emissive, ambient, specular, more;
};

MaterialRecord record_of(const Material& m) {
  const float passing = m.tinted_transmission && m.transmission > 0 ? m.transmission : 0.0f;
  const float opaque = m.alpha_mode == AlphaMode::opaque ? 1.0f : 0.0f;
  return {vec4(m.base_color, m.alpha), vec4(m.emissive, static_cast<float>(m.model)),
          vec4(m.ambient, passing), vec4(m.specular, m.roughness),
          vec4(m.metallic, m.phong_exponent, opaque, 0.0f)};
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

}  // namespace

std::string lacks(const shade::Subject& subject, const shade::Lighting& lighting) {
  if (lighting.environment != nullptr) return "an environment is not drawn by OpenGL yet";
  if (lighting.lights.size() > most_lights) return fmt::format("OpenGL draws at most {} lights", most_lights);
  for (const shade::DrawnLight& light : lighting.lights)
    if (light.area && light.area->polygon.size() > 14) return "a light has too many corners for OpenGL";
  const shade::SurfaceTable& surfaces = subject.surfaces;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (surfaces.maps(i).any()) return "textures are not drawn by OpenGL yet";
  if (subject.geometry.triangles.empty()) return "there is nothing for OpenGL to draw";
  return "";
}

Expected<void> FrameInputs::send_geometry(const FrameGeometry& geometry, std::size_t& sent_bytes) {
  has_normals_ = !geometry.normals.empty();
  triangle_count_ = static_cast<unsigned>(geometry.triangles.size());
  if (auto sent = positions_.send(bytes_of(geometry.positions), sent_bytes); !sent) return sent;
  if (auto sent = triangles_.send(bytes_of(geometry.triangles), sent_bytes); !sent) return sent;
  if (auto sent = normals_.send(bytes_of(geometry.normals), sent_bytes); !sent) return sent;
  return material_numbers_.send(bytes_of(geometry.materials), sent_bytes);
}

Expected<void> FrameInputs::send_materials(const shade::SurfaceTable& surfaces, std::size_t& sent_bytes) {
  material_count_ = static_cast<unsigned>(surfaces.size());
  std::vector<MaterialRecord> records;
  for (std::size_t i = 0; i < surfaces.size(); ++i) records.push_back(record_of(surfaces.material(i)));
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
  return send_geometry(subject.geometry, sent_bytes);
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
  bind_storage(0, positions_), bind_storage(1, triangles_), bind_storage(2, normals_);
  bind_storage(3, material_numbers_), bind_storage(4, materials_), bind_storage(7, vertex_colors_);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, lights_.buffer().name());
}

}  // namespace tenebra::shade_gl
