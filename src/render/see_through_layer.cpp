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

/// Factors of a list of pixels, gathered.
struct Gathered {
  std::vector<std::uint8_t> mask;
  std::vector<float> irradiance;
  std::vector<glm::vec3> tint;
  std::vector<std::uint8_t> coloured;

  Gathered(const shade::LightFactors& from, std::span<const std::uint32_t> pixels) {
    for (const std::uint32_t pixel : pixels) {
      if (!from.mask.empty()) mask.push_back(from.mask[pixel]);
      if (!from.irradiance.empty()) irradiance.push_back(from.irradiance[pixel]);
      if (!from.tint.factors.empty()) tint.push_back(from.tint.factors[pixel]);
    }
    coloured.assign(tint.size() / shade::TintFactors::run + 1, 1);
  }
  shade::LightFactors factors() const {
    shade::LightFactors out{mask, irradiance, {}};
    if (!tint.empty()) out.tint = {tint, coloured};
    return out;
  }
};

std::vector<shade::ShadedSample> shaded(const LayerPicture& picture, std::span<const std::uint32_t> ids,
                                        std::span<const shade::LightFactors> factors,
                                        std::span<const float> openness,
                                        std::span<const std::uint32_t> pixels) {
  const auto width = static_cast<std::uint32_t>(picture.opaque.width);
  std::vector<std::uint32_t> own_ids;
  std::vector<glm::vec2> places;
  std::vector<float> open;
  for (const std::uint32_t pixel : pixels) {
    own_ids.push_back(ids[pixel]);
    places.emplace_back(static_cast<float>(pixel % width) + 0.5f, static_cast<float>(pixel / width) + 0.5f);
    if (!openness.empty()) open.push_back(openness[pixel]);
  }
  std::vector<Gathered> gathered;
  for (const shade::LightFactors& light : factors) gathered.emplace_back(light, pixels);
  std::vector<shade::LightFactors> own;
  for (const Gathered& light : gathered) own.push_back(light.factors());
  std::vector<shade::ShadedSample> out;
  shade_samples(picture.subject, picture.lighting, {own_ids, places, own, open}, out);
  return out;
}

}  // namespace

std::vector<shade::LightFactors> LayerSamples::factors() const {
  std::vector<shade::LightFactors> out(masks.size());
  for (std::size_t i = 0; i < masks.size(); ++i) out[i] = {masks[i], irradiance[i], tints[i].factors()};
  return out;
}

void EyeTint::trace(const VisiblePoints& opaque, const LayerSamples& layer, const ViewRays& view,
                    const TriangleView& triangles, const SeeThroughSurfaces& surfaces, TintMask& out) {
  // To the eye each see-through surface is one, whether it colours light or not.
  all_.assign(surfaces.see_through.begin(), surfaces.see_through.end());
  for (std::uint8_t& through : all_) through = through != 0;
  SeeThroughSurfaces every = surfaces;
  every.see_through = all_;
  lit_.resize(opaque.triangles.size());
  // Where the layer has no sample, nothing see-through stands before what is opaque.
  for (std::size_t i = 0; i < lit_.size(); ++i)
    lit_[i] = opaque.triangles[i] != no_triangle && layer.points.triangles[i] != no_triangle ? 255 : 0;
  ShadowLight eye;
  eye.directional = view.orthographic;
  eye.position = view.eye;
  eye.to_light = -view.d0;
  tracer_.trace(opaque, view, triangles, every, eye, lit_, {}, out);
  crossed_.assign(lit_.size(), 0);
  for (const std::uint32_t pixel : out.pixels) crossed_[pixel] = 1;
  for (std::uint32_t pixel = 0; pixel < lit_.size(); ++pixel) {
    if (crossed_[pixel] != 0 || layer.points.triangles[pixel] == no_triangle) continue;
    const SurfacePlace place =
        place_of(every, triangles, layer.points.triangles[pixel], layer.points.positions[pixel]);
    out.pixels.push_back(pixel);
    out.factors.push_back(texture::transmittance_at(*surfaces.scene, place.material, place.uv, place.vertex));
  }
}

void draw_layer(const LayerPicture& picture, base::Image8& out, base::ImageF& linear) {
  const std::span<const std::uint32_t> pixels = picture.passes.pixels;
  const auto behind =
      shaded(picture, picture.opaque.ids, picture.opaque.factors, picture.opaque.openness, pixels);
  const auto before =
      shaded(picture, picture.layer.ids, picture.layer.factors(), picture.layer.openness, pixels);
  const TriangleView triangles = triangle_view(picture.subject.geometry);
  parallel::parallel_ranges(pixels.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t pixel = pixels[i], id = picture.layer.points.triangles[pixel];
      glm::vec3 color = behind[i].color * picture.passes.factors[i];
      if (id != no_triangle) {
        const SurfacePlace place =
            place_of(picture.surfaces, triangles, id, picture.layer.points.positions[pixel]);
        color += before[i].color *
                 texture::shown_share(*picture.surfaces.scene, place.material, place.uv, place.vertex);
      }
      const std::size_t at = 3 * std::size_t{pixel};
      encode_shown(picture.display, shown(picture.display, color), &out.pixels[at]);
      for (int c = 0; c < 3 && !linear.pixels.empty(); ++c)
        linear.pixels[at + static_cast<std::size_t>(c)] = color[c];
    }
  });
}

}  // namespace tenebra::render
