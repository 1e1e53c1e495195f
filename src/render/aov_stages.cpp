// Data about the visible surfaces of a frame, made from the results of its stages: ids, the light of each
// light, and openness. The picture is made before and keeps its bits.
#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "parallel/parallel.h"
#include "render/mask_colour.h"
#include "render/renderer_state.h"

namespace tenebra::render {
namespace {

constexpr std::size_t pixels_at_once = 4096;

io::ImageF empty_picture(const visibility::VisibleIds& seen, int channels, float value) {
  const auto count = static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height);
  return {seen.width, seen.height, channels,
          std::vector<float>(count * static_cast<std::size_t>(channels), value)};
}

/// The unit direction that depth is measured along: across the picture's rows and columns.
glm::dvec3 view_axis(const ViewRays& view) {
  const glm::dvec3 d0(view.d0);
  if (view.orthographic) return glm::normalize(d0);
  const glm::dvec3 axis = glm::normalize(glm::cross(glm::dvec3(view.dx), glm::dvec3(view.dy)));
  return glm::dot(axis, d0) < 0 ? -axis : axis;
}

io::ImageF colors_of(const shade::Subject& subject, const shade::Lighting& lighting,
                     const shade::PixelSamples& pixels) {
  io::Image8 unused;
  std::vector<glm::vec3> colors;
  shade::shade_picture(subject, lighting, pixels, {}, unused, &colors);
  io::ImageF out{pixels.width, pixels.height, 3, std::vector<float>(3 * colors.size())};
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) out.pixels[3 * i + c] = colors[i][static_cast<int>(c)];
  return out;
}

void find_numbers(const FrameGeometry& geometry, const std::vector<std::uint32_t>& ids, Aovs& out) {
  out.ids = out.parts = out.materials = ids;
  const auto part_of = [&parts = geometry.parts](std::uint32_t id) {
    return static_cast<std::uint32_t>(std::upper_bound(parts.begin(), parts.end(), id) - parts.begin() - 1);
  };
  parallel::parallel_ranges(ids.size(), pixels_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (ids[i] == no_triangle) continue;
      const bool same = i > first && ids[i] == ids[i - 1];
      out.parts[i] = same ? out.parts[i - 1] : part_of(ids[i]);
      out.materials[i] = geometry.materials[ids[i]];
    }
  });
}

std::vector<LightVisibility> visibilities(const std::vector<LightMask>& masks) {
  std::vector<LightVisibility> out;
  for (const LightMask& mask : masks) {
    io::ImageF& fraction = out.emplace_back(LightVisibility{mask.light, {}}).fraction;
    fraction = {mask.mask.width, mask.mask.height, 1, std::vector<float>(mask.mask.pixels.size())};
    for (std::size_t i = 0; i < fraction.pixels.size(); ++i) fraction.pixels[i] = visible_fraction(mask, i);
  }
  return out;
}

}  // namespace

void Renderer::State::find_surfaces_seen(const FrameInput& input, const AovChoice& wanted, Aovs& out) const {
  const TriangleView triangles = triangle_view(input.geometry);
  VisiblePoints at;
  std::vector<glm::vec3> facing;
  compute_visible_points(seen.ids, seen.width, seen.height, input.view, triangles, at);
  if (wanted.depth) out.depth = empty_picture(seen, 1, std::numeric_limits<float>::infinity());
  if (wanted.normal) {
    compute_shading_normals(at, input.geometry.normals, input.view, triangles, facing);
    out.normal = empty_picture(seen, 3, 0.0f);
  }
  const glm::dvec3 axis = view_axis(input.view), eye(input.view.eye);
  parallel::parallel_ranges(seen.ids.size(), pixels_at_once, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (at.triangles[i] == no_triangle) continue;
      if (wanted.depth) out.depth.pixels[i] = static_cast<float>(glm::dot(at.positions[i] - eye, axis));
      for (std::size_t c = 0; wanted.normal && c < 3; ++c)
        out.normal.pixels[3 * i + c] = facing[i][static_cast<int>(c)];
    }
  });
}

/// What white diffuse surfaces without textures show, times pi where the lights have units.
io::ImageF Renderer::State::irradiance_seen(const shade::Subject& subject,
                                            const std::vector<DrawnLight>& lights,
                                            const shade::PixelSamples& pixels) const {
  const Material white{.base_color = glm::vec3(1.0f), .model = SurfaceModel::phong};
  const shade::SurfaceTable surface(std::span(&white, 1));
  std::vector<DrawnLight> without_units = lights;
  for (DrawnLight& light : without_units)
    if (light.light.falloff == Falloff::inverse_square) light.light.color *= glm::pi<float>();
  const shade::Subject all_white{subject.geometry, subject.view, surface, subject.smooth_terminator};
  return colors_of(all_white, {without_units, glm::vec3(0.0f)}, pixels);
}

/// What shows where each surface shines by itself in its base colour. The surfaces are as before afterwards.
io::ImageF Renderer::State::albedo_seen(const FrameInput& input, const shade::PixelSamples& pixels) {
  std::vector<Material> shining = scene.materials;
  for (Material& material : shining) {
    material.model = SurfaceModel::unlit;
    material.emissive = glm::vec3(0.0f);
  }
  surfaces.set_factors(shining);
  io::ImageF out = colors_of({input.geometry, input.view, surfaces}, {{}, glm::vec3(0.0f)}, pixels);
  surfaces.set_factors(scene.materials);
  return out;
}

void Renderer::State::fill_aovs(const FrameInput& input, const std::vector<DrawnLight>& lights,
                                const RenderSettings& settings, std::span<const shade::LightFactors> factors,
                                FrameResult& result) {
  const AovChoice& wanted = settings.aovs;
  Aovs& out = result.aovs;
  out = {};
  if (!wanted.any()) return;
  if (wanted.ids) find_numbers(input.geometry, seen.ids, out);
  if (wanted.openness && settings.ao.mode != AoMode::none) {
    out.openness = empty_picture(seen, 1, 1.0f);
    for (std::size_t i = 0; i < seen.ids.size(); ++i)
      if (seen.ids[i] != no_triangle) out.openness.pixels[i] = openness[i];
  }
  if (wanted.visibility) out.visibility = visibilities(result.masks);
  const shade::PixelSamples pixels{seen.width, seen.height, seen.ids, factors, {}};
  const shade::PixelSamples unlit{seen.width, seen.height, seen.ids, {}, {}};
  const shade::Subject subject{input.geometry, input.view, surfaces, lifts_points(settings)};
  if (wanted.depth || wanted.normal) find_surfaces_seen(input, wanted, out);
  if (wanted.irradiance) out.irradiance = irradiance_seen(subject, lights, pixels);
  if (wanted.albedo) out.albedo = albedo_seen(input, unlit);
}

}  // namespace tenebra::render
