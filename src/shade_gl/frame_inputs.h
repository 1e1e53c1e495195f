// What all colours of a frame need, in OpenGL's memory: triangles, materials and lights. Internal to
// shade_gl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "gl/transfers.h"
#include "shade/shading.h"

namespace tenebra::shade_gl {

/// Lights of a frame, at most: as many as every OpenGL's uniform block holds.
constexpr std::size_t most_lights = 64;

/// Why these passes cannot make the colours of such a frame, one sentence; empty: they can.
std::string lacks(const shade::Subject& subject, const shade::Lighting& lighting);

class FrameInputs {
public:
  /// Sends what changed since the last frame; adds to `sent_bytes`.
  Expected<void> send(const shade::Subject& subject, const shade::Lighting& lighting,
                      std::size_t& sent_bytes);
  /// Binds all of it for `program`, shaders/colours.comp.
  void bind(const gl::Program& program) const;

private:
  Expected<void> send_geometry(const FrameGeometry& geometry, std::size_t& sent_bytes,
                               std::size_t& of_triangles);
  Expected<void> send_materials(const shade::SurfaceTable& surfaces, std::size_t& sent_bytes);
  Expected<void> send_textures(const shade::Subject& subject, bool triangles_changed,
                               std::size_t& sent_bytes);

  gl::SentBuffer positions_, triangles_, normals_, material_numbers_, materials_, vertex_colors_, lights_;
  gl::SentBuffer textures_, planes_, tangents_;
  const shade::SurfaceTable* textured_ = nullptr;  // whose textures these are: they stay as they were made
  unsigned rules_ = 0;
  ViewRays view_;
  glm::vec3 ambient_light_{1.0f}, background_{0.0f};
  unsigned triangle_count_ = 0, material_count_ = 0, colored_vertices_ = 0;
  bool has_normals_ = false, has_tangents_ = false, smooth_terminator_ = false;
};

}  // namespace tenebra::shade_gl
