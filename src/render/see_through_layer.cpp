#include "render/see_through_layer.h"

#include <algorithm>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "points/sample_points.h"
#include "points/triangle_corners.h"
#include "texture/transmittance.h"
#include "tint/panes.h"

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

/// The colours of some samples, which see these triangles.
Expected<std::vector<shade::ShadedSample>> shaded(const shade::PixelSamples& all,
                                                  std::span<const glm::vec2> places,
                                                  std::span<const std::uint32_t> some,
                                                  FrameShading& shading) {
  const auto width = static_cast<std::uint32_t>(all.width);
  std::vector<std::uint32_t> ids;
  std::vector<glm::vec2> own_places;
  std::vector<float> open;
  for (const std::uint32_t i : some) {
    ids.push_back(all.ids[i]);
    own_places.push_back(
        places.empty() ? glm::vec2(static_cast<float>(i % width) + 0.5f, static_cast<float>(i / width) + 0.5f)
                       : places[i]);
    if (!all.openness.empty()) open.push_back(all.openness[i]);
  }
  const GatheredFactors gathered(all.factors, some);
  const auto factors = gathered.factors();
  std::vector<shade::ShadedSample> out;
  if (auto done = shading.shade_samples({ids, own_places, factors, open}, out); !done)
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
  if (!tracer_.trace(opaque, triangles, every, eye, lit_, {}, out, stop)) return false;
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

Expected<SeeThroughLayer::Colors> SeeThroughLayer::color(const Frame& frame, LitSamples& layer,
                                                         const OpaqueSamples& opaque, Lighter& lighter,
                                                         FrameShading& shading) {
  const SeeThroughSurfaces surfaces = frame.see_through();
  const TriangleView triangles = frame.triangles();
  if (auto lit = lighter.light(frame, LightKinds::all, layer); !lit) return tl::unexpected(lit.error());
  if (!eye_tint_.trace(opaque.points, layer, frame.input.view, triangles, surfaces, passes_, frame.stop))
    return base::stopped();

  const std::span<const std::uint32_t> samples = passes_.pixels;
  const auto factors = layer.factors();
  const shade::PixelSamples of_layer{opaque.lit.width, opaque.lit.height, layer.points.triangles, factors,
                                     layer.openness};
  const auto behind = shaded(opaque.lit, opaque.places, samples, shading);
  if (!behind) return tl::unexpected(behind.error());
  const auto before = shaded(of_layer, opaque.places, samples, shading);
  if (!before) return tl::unexpected(before.error());

  Colors out{samples, std::vector<glm::vec3>(samples.size())};
  parallel::parallel_ranges(samples.size(), 1024, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const std::uint32_t sample = samples[i], id = layer.points.triangles[sample];
      out.colors[i] = (*behind)[i].color * passes_.factors[i];
      if (id == no_triangle) continue;
      const SurfacePlace place = place_of(surfaces, triangles, id, layer.points.positions[sample]);
      out.colors[i] +=
          (*before)[i].color * texture::shown_share(*surfaces.scene, place.material, place.uv, place.vertex);
    }
  });
  return out;
}

Expected<SeeThroughLayer::Colors> SeeThroughLayer::color(const Frame& frame,
                                                         std::span<const std::uint32_t> layer,
                                                         std::size_t count, const OpaqueSamples& opaque,
                                                         Lighter& lighter, FrameShading& shading) {
  LitSamples& before = before_samples_;
  points::compute_sample_points(layer, opaque.places, count, frame.input.view, frame.triangles(),
                                before.points);
  compute_shading_normals(before.points, frame.input.geometry.normals, frame.triangles(), before.normals);
  return color(frame, before, opaque, lighter, shading);
}

const VisiblePoints& SeeThroughLayer::points_behind(const Frame& frame, const Centres& centres) {
  const visibility::VisibleIds& seen = centres.seen;
  const bool found = frame.has_occlusion() || frame.has_shadows();
  if (found && frame.settings.samples == SampleSource::ids && !frame.lifts_points())
    return centres.lit.points;
  ids_behind_.resize(seen.ids.size());
  parallel::parallel_ranges(ids_behind_.size(), 1 << 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      ids_behind_[i] = seen.layer[i] == no_triangle ? no_triangle : seen.ids[i];
  });
  compute_visible_points(ids_behind_, seen.width, seen.height, frame.input.view, frame.triangles(), behind_,
                         PointLayout::rows_and_tiles);
  return behind_;
}

Expected<void> SeeThroughLayer::draw(const Frame& frame, const Centres& centres, Lighter& lighter,
                                     FrameShading& shading, io::Image8& picture) {
  const visibility::VisibleIds& seen = centres.seen;
  if (!seen.has_layer) return {};
  if (std::all_of(seen.layer.begin(), seen.layer.end(), [](std::uint32_t id) { return id == no_triangle; }))
    return {};
  LitSamples& before = before_centres_;
  compute_visible_points(seen.layer, seen.width, seen.height, frame.input.view, frame.triangles(),
                         before.points, PointLayout::rows_and_tiles);
  compute_shading_normals(before.points, frame.input.geometry.normals, frame.triangles(), before.normals);
  const shade::PixelSamples lit = centres.samples();
  const auto drawn = color(frame, before, {points_behind(frame, centres), lit, {}}, lighter, shading);
  if (!drawn) return tl::unexpected(drawn.error());
  return shading.replace_centres(drawn->samples, drawn->colors, picture);
}

}  // namespace tenebra::render
