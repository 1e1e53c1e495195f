// The share of light that passes a see-through surface: one formula for shadows, ambient occlusion and
// pictures.
#pragma once

#include <glm/glm.hpp>

#include <tenebra/scene.h>

namespace tenebra::texture {

/// The share of light, 0 to 1 in each channel, that passes `material` at one place:
///   (1 - a) + a t c,  a = alpha, its texture's and the vertex's (AlphaMode::blend; else 1),
///                     t = transmission times its texture, c = base colour where transmission is tinted (else
///                     1).
/// `base`: base colour texture, colour as Scene::transfer has it; `transmission`: red of its texture;
/// `vertex`: colour of the vertices. White or 1 where there is none.
glm::vec3 transmittance(const Material& material, const glm::vec4& base, float transmission,
                        const glm::vec4& vertex);

/// Whether the two textures affect it.
bool uses_base_map(const Scene& scene, const Material& material);
bool uses_transmission_map(const Scene& scene, const Material& material);
/// Whether the vertices' colours affect it.
bool uses_vertex_colors(const Material& material);

/// The transmittance at texture coordinates `uv` (both sets) and with a vertex colour. Textures bilinear as
/// stored, then decoded where the scene's colours are linear.
glm::vec3 transmittance_at(const Scene& scene, const Material& material, const glm::vec2 uv[2],
                           const glm::vec4& vertex);

/// The share of a surface of `material` that is there: alpha as above. What passes where it is there is taken
/// from its diffuse reflectance alone, by shading.
float shown_share(const Scene& scene, const Material& material, const glm::vec2 uv[2],
                  const glm::vec4& vertex);

/// transmittance() for the mean of each texture's pixels and white vertices.
glm::vec3 mean_transmittance(const Scene& scene, const Material& material);

}  // namespace tenebra::texture
