#include "shade/block_shader.h"

#include <algorithm>
#include <cstring>

#include "shade/corner_tangents.h"

namespace tenebra::shade {
namespace {

const float* copied(std::span<const float> values, std::size_t first, std::size_t count, float* to) {
  std::copy_n(values.data() + first, count, to);
  return to;
}

void put(const glm::vec3& value, SampleBlock::Channel (&channels)[3], std::size_t i) {
  for (int c = 0; c < 3; ++c) channels[c][i] = value[c];
}

}  // namespace

FrameTerms::FrameTerms(const Subject& of, const Lighting& lit_by)
    : subject(of), lighting(lit_by), code(kernels(lit_by.simd)) {
  if (lighting.environment == nullptr) ambient_light = lighting.ambient_light;
  for (const DrawnLight& light : lighting.lights) lights.push_back(light_terms(light, subject.view));
  for (std::size_t i = 0; i < subject.surfaces.size(); ++i) {
    surfaces.push_back(subject.surfaces[i]);
    surfaces.back().ambient *= ambient_light;
  }
}

void BlockShader::place_background(const float* x, const float* y, std::size_t first, std::size_t count) {
  const Surface background{.emissive = frame_.lighting.background};
  frame_.code.place({}, false, x, y, first, count, block_);
  frame_.code.cover(background, first, count, block_);
  if (frame_.lighting.environment == nullptr) return;
  const ViewRays& view = frame_.subject.view;
  for (std::size_t i = first; i < first + count; ++i) {
    const glm::vec3 across = view.orthographic ? glm::vec3(0.0f) : x[i] * view.dx + y[i] * view.dy;
    put(glm::normalize(view.d0 + across), before_, i);  // scratch that no light uses yet
  }
  frame_.code.see(frame_.lighting.environment->radiance(), before_, nullptr, first, count, block_.emissive);
}

void BlockShader::locate_run(const TriangleSetup& setup, std::size_t material, const glm::uvec3& corners,
                             std::size_t first, std::size_t count) {
  const SurfaceTable& surfaces = frame_.subject.surfaces;
  if (stretch_.count == 0) stretch_ = {material, first, 0};
  stretch_.count += count;
  const SurfaceMaps& maps = surfaces.maps(material);
  for (std::size_t i = 0; i < maps.rules.size(); ++i) {
    const CoordinatePlane plane = surfaces.coordinates(maps.rules[i], corners);
    frame_.code.locate(setup, plane, block_, first, count, places_[i]);
    if (!maps.normal || static_cast<std::size_t>(maps.normal.coordinates) != i) continue;
    const auto tangents = corner_tangents(frame_.subject.geometry, setup, corners, plane);
    frame_.code.blend(tangents.data(), block_, first, count, tangents_);
  }
  if (const auto& colors = surfaces.colors(); !colors.empty()) {
    const glm::vec4 of_corners[3] = {colors[corners.x], colors[corners.y], colors[corners.z]};
    frame_.code.blend(of_corners, block_, first, count, vertices_);
  }
}

const texture::TextureValues* BlockShader::sampled(const MapUse& use, const TextureMap& map,
                                                   texture::TextureValues& to) {
  if (!use) return nullptr;
  frame_.code.sample(frame_.subject.surfaces.texture(use), map,
                     places_[static_cast<std::size_t>(use.coordinates)], stretch_.first, stretch_.count, to);
  return &to;
}

void BlockShader::narrow_places(std::size_t rules) {
  for (texture::TexturePlaces* places = places_; places != places_ + rules; ++places) {
    for (auto* channels : {places->by_x, places->by_y})
      for (int axis = 0; axis < 2; ++axis)
        for (std::size_t i = stretch_.first; i < stretch_.first + stretch_.count; ++i)
          channels[axis][i] *= width_px_;
  }
}

void BlockShader::finish_stretch() {
  if (stretch_.count == 0) return;
  const SurfaceTable& surfaces = frame_.subject.surfaces;
  const Material& m = surfaces.material(stretch_.material);
  const SurfaceMaps& maps = surfaces.maps(stretch_.material);
  if (width_px_ != 1) narrow_places(maps.rules.size());
  SurfaceInputs in;
  if (!surfaces.colors().empty()) in.vertices = &vertices_;
  in.base = sampled(maps.base, m.base_color_map, base_values_);
  in.emissive = sampled(maps.emissive, m.emissive_map, emissive_values_);
  in.gloss = sampled(maps.gloss, gloss_map(m), gloss_values_);
  in.specular = sampled(maps.specular, m.specular_map, specular_values_);
  in.specular_share = sampled(maps.specular_share, m.specular_share_map, share_values_);
  in.transmission = sampled(maps.transmission, m.transmission_map, passing_values_);
  in.occlusion = sampled(maps.occlusion, m.occlusion_map, occlusion_values_);
  frame_.code.resolve(m, in, frame_.ambient_light, stretch_.first, stretch_.count, block_);
  if (const auto* normals = sampled(maps.normal, m.normal_map, normal_values_))
    frame_.code.bend(m.normal_scale, *normals, tangents_, stretch_.first, stretch_.count, block_);
  stretch_.count = 0;
}

/// A stretch is finished before a run that is not part of it is placed: finishing it may write up to fifteen
/// samples behind it.
void BlockShader::place_run(std::uint32_t id, const float* x, const float* y, std::size_t first,
                            std::size_t count) {
  const Subject& subject = frame_.subject;
  if (id >= subject.geometry.triangles.size()) {
    finish_stretch();
    return place_background(x, y, first, count);
  }
  anything_seen_ = true;
  const std::size_t material = subject.surfaces.held(subject.geometry.materials[id]);
  const glm::uvec3& corners = subject.geometry.triangles[id];
  const bool varies = subject.surfaces.varies(material, corners);
  if (!varies || material != stretch_.material) finish_stretch();
  const TriangleSetup& setup = setups_.find(subject.geometry, subject.view, id, {x[first], y[first]});
  const Surface& surface = frame_.surfaces[material];
  frame_.code.place(setup, subject.smooth_terminator, x, y, first, count, block_);
  block_.glossy = block_.glossy || surface.is_glossy();
  if (varies) {
    locate_run(setup, material, corners, first, count);
  } else {
    frame_.code.cover(surface, first, count, block_);
  }
}

void BlockShader::place(std::span<const std::uint32_t> ids, const float* x, const float* y) {
  block_.count = ids.size();
  block_.keeps_gloss = frame_.subject.surfaces.any_glossy();
  block_.keeps_unbent = frame_.subject.surfaces.any_bent();
  block_.keeps_occlusion = frame_.subject.surfaces.any_occluded();
  block_.glossy = false;
  anything_seen_ = false;
  for (std::size_t i = 0, end = 0; i < ids.size(); i = end) {
    while (end < ids.size() && ids[end] == ids[i]) ++end;
    place_run(ids[i], x, y, i, end - i);
  }
  finish_stretch();
}

void BlockShader::surround() {
  const Lighting& lighting = frame_.lighting;
  const ViewRays& view = frame_.subject.view;
  if (block_.glossy) {
    const glm::vec3 towards = -glm::normalize(view.d0);
    frame_.code.look(view.orthographic ? &towards : nullptr, block_);
  }
  if (lighting.environment == nullptr) {
    const glm::vec3 brighter = glm::max(lighting.background - lighting.ambient_light, glm::vec3(0.0f));
    return frame_.code.reflect(lighting.ambient_light, brighter, block_);
  }
  frame_.code.surround(lighting.environment->irradiance(), lighting.environment->radiance(), block_);
}

void BlockShader::shade(std::span<const LightFactors> factors, std::span<const float> openness,
                        std::size_t first) {
  if (anything_seen_ && (block_.glossy || frame_.lighting.environment != nullptr)) surround();
  frame_.code.begin(openness.empty() ? nullptr : copied(openness, first, block_.count, factor_), block_);
  for (std::size_t i = 0; anything_seen_ && i < frame_.lights.size(); ++i) add_light(i, factors[i], first);
}

void BlockShader::add_light(std::size_t light, const LightFactors& factors, std::size_t first) {
  const float* factor = nullptr;
  if (!factors.irradiance.empty()) {
    factor = copied(factors.irradiance, first, block_.count, factor_);
  } else if (!factors.mask.empty()) {
    const auto mask = factors.mask.subspan(first, block_.count);
    unsigned some = 0, all = 255;
    for (const std::uint8_t value : mask) {
      some |= value;
      all &= value;
    }
    if (some == 0) return;
    for (std::size_t i = 0; all != 255 && i < mask.size(); ++i)
      factor_[i] = static_cast<float>(mask[i]) / 255.0f;
    if (all != 255) factor = factor_;
  }
  if (is_coloured(factors.tint, first)) {
    add_coloured(light, factor, factors.tint.factors.subspan(first, block_.count));
  } else {
    frame_.code.light(frame_.lights[light], factor, block_);
  }
}

bool BlockShader::is_coloured(const TintFactors& tint, std::size_t first) const {
  if (tint.factors.empty()) return false;
  const std::size_t last = first + block_.count - 1;
  for (std::size_t run = first / TintFactors::run; run <= last / TintFactors::run; ++run)
    if (tint.coloured[run] != 0) return true;
  return false;
}

/// The light alone, coloured, and then added: the same bits as by itself where the tint is white.
void BlockShader::add_coloured(std::size_t light, const float* factor, std::span<const glm::vec3> tint) {
  std::memcpy(before_, block_.color, sizeof(before_));
  std::memset(block_.color, 0, sizeof(before_));
  frame_.code.light(frame_.lights[light], factor, block_);
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < tint.size(); ++i)
      block_.color[c][i] = before_[c][i] + block_.color[c][i] * tint[i][c];
}

void BlockShader::shade_light(std::size_t light) {
  for (auto& channel : block_.color) std::fill_n(channel, SampleBlock::room, 0.0f);
  block_.glossy = false;  // the paper's light buffer is diffuse
  if (anything_seen_) frame_.code.light(frame_.lights[light], nullptr, block_);
}

}  // namespace tenebra::shade
