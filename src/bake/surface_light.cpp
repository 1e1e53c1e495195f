#include "bake/surface_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <tenebra/threads.h>
#include "base/fail.h"
#include "parallel/parallel.h"
#include "render/light_casters.h"
#include "render/shadow_lights.h"
#include "shade/light_terms.h"
#include "soft/light/even_emission.h"

namespace tenebra::bake {
namespace {

using glm::dvec3;

/// Where samples are, and the side that is lit there.
struct Places {
  std::vector<dvec3> positions;
  std::vector<std::uint32_t> triangles;
  std::vector<std::int8_t> sides;
  std::vector<glm::vec3> normals;  ///< unit, on that side
  std::vector<glm::vec3> faces;    ///< the same of the triangles

  void resize(std::size_t count) {
    positions.resize(count), triangles.resize(count), sides.resize(count);
    normals.resize(count), faces.resize(count);
  }
  QueryPoints points() const {
    return {.positions = positions, .triangles = triangles, .normals = normals, .sides = sides};
  }
};

void place(const FrameGeometry& geometry, const Sample& sample, std::size_t i, Places& out) {
  const glm::uvec3 t = geometry.triangles[sample.triangle];
  dvec3 position(0.0), normal(0.0), corners[3];
  for (int k = 0; k < 3; ++k) {
    corners[k] = dvec3(geometry.positions[t[k]]);
    position += sample.weights[k] * corners[k];
    normal += sample.weights[k] * dvec3(geometry.normals[t[k]]);
  }
  const dvec3 face = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double length = glm::length(normal), side = glm::dot(face, normal) < 0 ? -1 : 1;
  out.positions[i] = position;
  out.triangles[i] = sample.triangle;
  out.sides[i] = static_cast<std::int8_t>(side);
  out.faces[i] = glm::vec3(side * face);
  out.normals[i] = length > 1e-6 ? glm::vec3(normal / length) : out.faces[i];
}

/// What a white diffuse surface shows of a light that nothing hides, per unit of its colour; `irradiance`
/// that of its polygon, if it has one.
double received(const shade::LightTerms& terms, const Places& places, std::size_t i, float irradiance) {
  const dvec3 path = dvec3(terms.from_eye) - places.positions[i];
  const double distance = glm::length(path);
  if (!terms.directional && !(distance > 0)) return 0;
  const dvec3 to_light = terms.directional ? -dvec3(terms.direction) : path / distance;
  const double fade = terms.directional ? 1 : shade::fade_of(terms, to_light, distance);
  if (terms.by_irradiance) return fade * static_cast<double>(irradiance);
  if (!(glm::dot(dvec3(places.faces[i]), to_light) > 0)) return 0;
  return fade * std::max(glm::dot(dvec3(places.normals[i]), to_light), 0.0);
}

struct TracedLight {
  render::DrawnLight drawn;
  shade::LightTerms terms;
  std::shared_ptr<Geometry> geometry;   ///< with the triangles that cast its shadows
  std::unique_ptr<PointTracer> tracer;  ///< its trees are of that geometry
};

bool shines_back(const render::DrawnLight& light) {
  const bool narrow =
      light.light.type == LightType::spot && light.light.outer_cone_rad <= 0.5f * std::numbers::pi_v<float>;
  return light.back && !narrow;
}

}  // namespace

struct SurfaceLight::State {
  const FrameGeometry* frame = nullptr;
  LightRequest request;
  std::vector<TracedLight> lights;
  std::shared_ptr<Geometry> geometry;
  PointTracer occlusion;

  Places places;
  std::vector<std::uint8_t> mask;
  SoftMask soft, behind;
  std::vector<float> openness;
  VisiblePoints points;  ///< for weigh_evenly

  Expected<void> occlude(std::span<const Sample> samples, std::span<Light> out, const StopFlag* stop);
  Expected<void> trace(TracedLight& light, const StopFlag* stop);
  Expected<void> trace_area(TracedLight& light, const StopFlag* stop);
  Expected<void> trace_side(TracedLight& light, const AreaLight& area, const StopFlag* stop, SoftMask& out);
  void add(const TracedLight& light, std::span<Light> out) const;
};

Expected<void> SurfaceLight::State::trace_side(TracedLight& light, const AreaLight& area,
                                               const StopFlag* stop, SoftMask& out) {
  const std::size_t count = places.positions.size();
  out.visible_fraction.resize(count), out.irradiance.resize(count);
  auto done = light.tracer->soft_visibility(*light.geometry, places.points(), area, request.settings.soft,
                                            out.visible_fraction, out.irradiance, stop);
  if (done && light.drawn.back)
    soft::weigh_evenly(points, places.normals, area, request.settings.soft.simd, out);
  return done;
}

Expected<void> SurfaceLight::State::trace_area(TracedLight& light, const StopFlag* stop) {
  if (light.drawn.back) points.positions = places.positions, points.triangles = places.triangles;
  const AreaLight& front = *light.drawn.area;
  if (auto done = trace_side(light, front, stop, soft); !done || !shines_back(light.drawn)) return done;
  if (auto done = trace_side(light, *light.drawn.back, stop, behind); !done) return done;
  for (std::size_t i = 0; i < places.positions.size(); ++i)
    if (glm::dot(front.normal, places.positions[i] - front.centre) < 0)
      soft.irradiance[i] = std::max(soft.irradiance[i], behind.irradiance[i]);
  return {};
}

Expected<void> SurfaceLight::State::trace(TracedLight& light, const StopFlag* stop) {
  mask.clear();
  if (light.drawn.area) return trace_area(light, stop);
  if (request.settings.shadows == render::ShadowMode::none) return {};
  mask.resize(places.positions.size());
  return light.tracer->hard_mask(*light.geometry, places.points(),
                                 render::shadow_light(light.drawn.light, light.drawn.placed),
                                 request.settings.hard, mask, stop);
}

void SurfaceLight::State::add(const TracedLight& light, std::span<Light> out) const {
  parallel::parallel_ranges(out.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!mask.empty() && mask[i] == 0) continue;
      const double arrives = received(light.terms, places, i, light.drawn.area ? soft.irradiance[i] : 0.0f);
      if (arrives > 0) out[i] += Light(glm::vec3(dvec3(light.terms.color) * arrives), 0.0f);
    }
  });
}

/// Occlusion varies slowly: of samples of one target that follow each other, the middle one answers for all.
Expected<void> SurfaceLight::State::occlude(std::span<const Sample> samples, std::span<Light> out,
                                            const StopFlag* stop) {
  std::vector<std::size_t> ends;  // of the runs
  Places asked;
  asked.resize(samples.size());
  for (std::size_t first = 0; first < samples.size(); first = ends.back()) {
    std::size_t end = first + 1;
    while (end < samples.size() && samples[end].target == samples[first].target) ++end;
    place(*frame, samples[(first + end) / 2], ends.size(), asked);
    ends.push_back(end);
  }
  asked.resize(ends.size());
  openness.resize(ends.size());
  auto done = occlusion.ambient_occlusion(*geometry, asked.points(), request.settings.ao, openness, stop);
  for (std::size_t run = 0, i = 0; done && run < ends.size(); ++run)
    for (; i < ends[run]; ++i) out[i].a = openness[run];
  return done;
}

SurfaceLight::SurfaceLight(std::unique_ptr<State> state) : state_(std::move(state)) {}
SurfaceLight::SurfaceLight(SurfaceLight&&) noexcept = default;
SurfaceLight& SurfaceLight::operator=(SurfaceLight&&) noexcept = default;
SurfaceLight::~SurfaceLight() = default;

std::size_t SurfaceLight::lights() const {
  return state_->lights.size();
}

Expected<SurfaceLight> SurfaceLight::create(const Scene& scene, const render::FrameInput& input,
                                            const LightRequest& request, std::vector<std::string>& notes) {
  auto state = std::make_unique<State>();
  state->frame = &input.geometry;
  state->request = request;
  const FrameGeometry& frame = input.geometry;
  const auto geometry_of = [&](std::span<const std::uint8_t> casts) -> Expected<std::shared_ptr<Geometry>> {
    auto made = Geometry::create(frame.positions, frame.triangles, casts);
    if (!made) return tl::unexpected(made.error());
    return std::make_shared<Geometry>(std::move(*made));
  };
  auto common = geometry_of(frame.casts_shadow);
  if (!common) return tl::unexpected(common.error());
  state->geometry = *common;
  if (!request.direct) return SurfaceLight(std::move(state));
  auto drawn = render::drawn_lights(scene, input, request.settings, notes);
  if (!drawn) return tl::unexpected(drawn.error());
  for (render::DrawnLight& light : *drawn) {
    TracedLight traced{std::move(light), {}, state->geometry, std::make_unique<PointTracer>()};
    traced.terms = shade::light_terms(traced.drawn, ViewRays{});
    std::vector<std::uint8_t> casters;
    render::casters_of(scene, frame, traced.drawn, casters);
    if (!casters.empty()) {
      auto own = geometry_of(casters);
      if (!own) return tl::unexpected(own.error());
      traced.geometry = *own;
    }
    state->lights.push_back(std::move(traced));
  }
  return SurfaceLight(std::move(state));
}

Expected<void> SurfaceLight::at(std::span<const Sample> samples, std::span<Light> out, const StopFlag* stop,
                                const QueryProgress& progress) {
  State& s = *state_;
  Expected<void> done;
  with_threads(s.request.settings.threads, [&] {
    const parallel::FloatEnvironment ieee;
    s.places.resize(samples.size());
    parallel::parallel_ranges(samples.size(), 4096, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) place(*s.frame, samples[i], i, s.places);
    });
    std::fill(out.begin(), out.end(), Light(0, 0, 0, 1));
    if (samples.empty()) return;
    const bool open = s.request.settings.ao.mode == AoMode::none;
    const double steps = static_cast<double>(s.lights.size()) + (open ? 0 : 1);
    double step = 0;
    for (TracedLight& light : s.lights) {
      done = s.trace(light, stop);
      if (!done) return;
      s.add(light, out);
      if (progress) progress(++step / steps);
    }
    if (!open) done = s.occlude(samples, out, stop);
    if (!done) return;
    for (Light& light : out) light += Light(light.a * s.request.ambient, 0.0f);
    if (progress) progress(1.0);
  });
  return done;
}

}  // namespace tenebra::bake
