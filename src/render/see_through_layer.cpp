#include "render/see_through_layer.h"

#include <algorithm>

#include "parallel/parallel.h"
#include "points/triangle_corners.h"
#include "texture/transmittance.h"
#include "tint/surfaces.h"

namespace tenebra::render {
namespace {

using glm::dvec3;

/// A place of a triangle as materials see it.
struct SurfacePlace {
  const Material& material;
  glm::vec2 uv[2];
  glm::vec4 vertex;
};
SurfacePlace place_of(const SeeThroughSurfaces& surfaces, const TriangleView& triangles, std::uint32_t id,
                      const dvec3& point) {
  const glm::uvec3 t = triangles.triangles[id];
  const points::Corners corners = points::corners_of(triangles, id);
  const dvec3 normal =
      glm::cross(dvec3(corners.v[1]) - dvec3(corners.v[0]), dvec3(corners.v[2]) - dvec3(corners.v[0]));
  const glm::vec3 at(tint::weights_where(corners.v, point, normal));
  const auto between = [&](const auto& values, auto otherwise) {
    if (values.empty()) return otherwise;
    return values[t.x] * at.x + values[t.y] * at.y + values[t.z] * at.z;
  };
  return {surfaces.scene->materials[surfaces.materials[id]],
          {between(surfaces.texture_coordinates[0], glm::vec2(0.0f)),
           between(surfaces.texture_coordinates[1], glm::vec2(0.0f))},
          between(surfaces.colors, glm::vec4(1.0f))};
}

Expected<std::vector<shade::ShadedSample>> shaded(const LayerPicture& picture, FrameShading& shading,
                                                  std::span<const std::uint32_t> ids,
                                                  std::span<const shade::LightFactors> factors,
                                                  std::span<const float> openness,
                                                  std::span<const std::uint32_t> pixels) {
  const auto width = static_cast<std::uint32_t>(picture.opaque.width);
  std::vector<std::uint32_t> own_ids;
  std::vector<glm::vec2> places;
  std::vector<float> open;
  for (const std::uint32_t pixel : pixels) {
    own_ids.push_back(ids[pixel]);
    places.push_back(picture.places.empty() ? glm::vec2(static_cast<float>(pixel % width) + 0.5f,
                                                        static_cast<float>(pixel / width) + 0.5f)
                                            : picture.places[pixel]);
    if (!openness.empty()) open.push_back(openness[pixel]);
  }
  const GatheredFactors gathered(factors, pixels);
  const auto own = gathered.factors();
  std::vector<shade::ShadedSample> out;
  if (auto done = shading.shade_samples({own_ids, places, own, open}, out); !done)
    return tl::unexpected(done.error());
  return out;
}

}  // namespace

bool EyeTint::trace(const VisiblePoints& opaque, const LitSamples& layer, const ViewRays& view,
                    const TriangleView& triangles, const SeeThroughSurfaces& surfaces, TintMask& out,
                    const StopFlag* stop) {
  // To the eye each see-through surface is one, whether it colours light or not.
  all_.assign(surfaces.see_through.begin(), surfaces.see_through.end());
  for (std::uint8_t& through : all_) through = through != 0;
  SeeThroughSurfaces every = surfaces;
  every.see_through = all_;
  lit_.resize(opaque.triangles.size());
  // Where the layer has no sample, nothing see-through is in front of the opaque surface.
  for (std::size_t i = 0; i < lit_.size(); ++i)
    lit_[i] = opaque.triangles[i] != no_triangle && layer.points.triangles[i] != no_triangle ? 255 : 0;
  ShadowLight eye;
  eye.directional = view.orthographic;
  eye.position = view.eye;
  eye.to_light = -view.d0;
  if (!tracer_.trace(opaque, view, triangles, every, eye, lit_, {}, out, stop)) return false;
  crossed_.assign(lit_.size(), 0);
  for (const std::uint32_t pixel : out.pixels) crossed_[pixel] = 1;
  for (std::uint32_t pixel = 0; pixel < lit_.size(); ++pixel) {
    if (crossed_[pixel] != 0 || layer.points.triangles[pixel] == no_triangle) continue;
    const SurfacePlace place =
        place_of(every, triangles, layer.points.triangles[pixel], layer.points.positions[pixel]);
    out.pixels.push_back(pixel);
    out.factors.push_back(texture::transmittance_at(*surfaces.scene, place.material, place.uv, place.vertex));
  }
  return true;
}

Expected<std::vector<glm::vec3>> layer_colors(const LayerPicture& picture, FrameShading& shading) {
  const std::span<const std::uint32_t> pixels = picture.passes.pixels;
  const auto behind =
      shaded(picture, shading, picture.opaque.ids, picture.opaque.factors, picture.opaque.openness, pixels);
  if (!behind) return tl::unexpected(behind.error());
  const auto before = shaded(picture, shading, picture.layer.points.triangles, picture.layer.factors(),
                             picture.layer.openness, pixels);
  if (!before) return tl::unexpected(before.error());
  std::vector<glm::vec3> colors(pixels.size());
  parallel::parallel_ranges(pixels.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t pixel = pixels[i], id = picture.layer.points.triangles[pixel];
      colors[i] = (*behind)[i].color * picture.passes.factors[i];
      if (id == no_triangle) continue;
      const SurfacePlace place =
          place_of(picture.surfaces, picture.triangles, id, picture.layer.points.positions[pixel]);
      colors[i] += (*before)[i].color *
                   texture::shown_share(*picture.surfaces.scene, place.material, place.uv, place.vertex);
    }
  });
  return colors;
}

}  // namespace tenebra::render
