#include "render/frame_aovs.h"

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "parallel/parallel.h"

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

std::vector<LightVisibility> visibilities(const Frame& frame, const Centres& centres) {
  std::vector<LightVisibility> out;
  if (frame.settings.shadows == ShadowMode::none) return out;
  for (std::size_t light = 0; light < frame.lights.size(); ++light) {
    io::ImageF fraction = empty_picture(centres.seen, 1, 0.0f);
    for (std::size_t i = 0; i < fraction.pixels.size(); ++i)
      fraction.pixels[i] = centres.lit.lights[light].visible_at(i);
    out.push_back({frame.lights[light].number, std::move(fraction)});
  }
  return out;
}

void find_surfaces_seen(const Frame& frame, const visibility::VisibleIds& seen, const AovChoice& wanted,
                        Aovs& out) {
  const ViewRays& view = frame.input.view;
  const TriangleView triangles = frame.triangles();
  VisiblePoints at;
  std::vector<glm::vec3> facing;
  compute_visible_points(seen.ids, seen.width, seen.height, view, triangles, at);
  if (wanted.depth) out.depth = empty_picture(seen, 1, std::numeric_limits<float>::infinity());
  if (wanted.normal) {
    compute_shading_normals(at, frame.input.geometry.normals, triangles, facing);
    out.normal = empty_picture(seen, 3, 0.0f);
  }
  const glm::dvec3 axis = view_axis(view), eye(view.eye);
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
io::ImageF irradiance_seen(const Frame& frame, const shade::PixelSamples& pixels) {
  const Material white{.base_color = glm::vec3(1.0f), .model = SurfaceModel::phong};
  const shade::SurfaceTable surface(std::span(&white, 1));
  std::vector<DrawnLight> lights(frame.lights.begin(), frame.lights.end());
  for (DrawnLight& light : lights)
    if (light.light.falloff == Falloff::inverse_square) light.light.color *= glm::pi<float>();
  const shade::Subject all_white{frame.input.geometry, frame.input.view, surface, frame.lifts_points()};
  return colors_of(all_white, {lights, glm::vec3(0.0f)}, pixels);
}

/// What shows where each surface shines by itself in its base colour.
io::ImageF albedo_seen(const Frame& frame, const visibility::VisibleIds& seen,
                       shade::SurfaceTable& surfaces) {
  const std::vector<Material>& materials = frame.scene.scene.materials;
  std::vector<Material> shining = materials;
  for (Material& material : shining) {
    material.model = SurfaceModel::unlit;
    material.emissive = glm::vec3(0.0f);
  }
  surfaces.set_factors(shining);
  const shade::PixelSamples unlit{seen.width, seen.height, seen.ids, {}, {}};
  io::ImageF out =
      colors_of({frame.input.geometry, frame.input.view, surfaces}, {{}, glm::vec3(0.0f)}, unlit);
  surfaces.set_factors(materials);
  return out;
}

}  // namespace

Aovs find_aovs(const Frame& frame, const Centres& centres, shade::SurfaceTable& surfaces) {
  const AovChoice& wanted = frame.settings.aovs;
  const visibility::VisibleIds& seen = centres.seen;
  Aovs out;
  if (wanted.ids) find_numbers(frame.input.geometry, seen.ids, out);
  if (wanted.openness && frame.has_occlusion()) {
    out.openness = empty_picture(seen, 1, 1.0f);
    for (std::size_t i = 0; i < seen.ids.size(); ++i)
      if (seen.ids[i] != no_triangle) out.openness.pixels[i] = centres.lit.openness[i];
  }
  if (wanted.visibility) out.visibility = visibilities(frame, centres);
  if (wanted.depth || wanted.normal) find_surfaces_seen(frame, seen, wanted, out);
  if (wanted.irradiance) {
    const shade::PixelSamples open{seen.width, seen.height, seen.ids, centres.factors, {}};
    out.irradiance = irradiance_seen(frame, open);
  }
  if (wanted.albedo) out.albedo = albedo_seen(frame, seen, surfaces);
  return out;
}

}  // namespace tenebra::render
