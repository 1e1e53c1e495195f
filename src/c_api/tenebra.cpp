// The C interface over queries.h: arrays become spans, errors the handle's sentence, exceptions too.
#include <tenebra/tenebra.h>

#include <tenebra/queries.h>
#include <tenebra/threads.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/fail.h"

struct tenebra_geometry {
  std::optional<tenebra::Geometry> geometry;
  std::string error;
};

struct tenebra_tracer {
  tenebra::PointTracer tracer;
  tenebra::StopFlag stop;
  std::string error;
};

namespace tenebra::c_api {
namespace {

// Arrays of three numbers are read as vectors.
static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::dvec3) == 3 * sizeof(double) &&
              sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));

template <class Element, class Number>
std::span<const Element> span_of(const Number* numbers, std::size_t count) {
  if (numbers == nullptr) return {};
  return {reinterpret_cast<const Element*>(numbers), count};
}
template <class Number>
std::span<Number> answers(Number* to, std::size_t count) {
  return to == nullptr ? std::span<Number>() : std::span<Number>(to, count);
}
glm::vec3 vector_of(const float v[3]) {
  return {v[0], v[1], v[2]};
}

/// The members of `from` that its caller knows; the others as in `to`.
template <class Struct>
Expected<Struct> known_members(const Struct* from, Struct to, const char* name) {
  if (from == nullptr) return base::fail("{}: found null, expected a structure", name);
  if (from->struct_size < sizeof(std::size_t) || from->struct_size > sizeof(Struct))
    return base::fail("{}: struct_size is {}, expected {} (initialise it by its macro)", name,
                      from->struct_size, sizeof(Struct));
  std::memcpy(&to, from, from->struct_size);
  return to;
}

/// Runs body, which gives Expected<void>; what it fails with or throws becomes the handle's sentence.
template <class Handle, class Body>
tenebra_status guarded(Handle* handle, const Body& body) noexcept {
  if (handle == nullptr) return TENEBRA_FAILED;
  try {
    const Expected<void> done = body();
    if (done) return TENEBRA_OK;
    handle->error = done.error().message;
    return is_stop(done) ? TENEBRA_STOPPED : TENEBRA_FAILED;
  } catch (const std::bad_alloc&) {
    handle->error.assign("no memory");  // short: held in place
  } catch (const std::exception& thrown) {
    try {
      handle->error = thrown.what();
    } catch (...) {
      handle->error.clear();
    }
  } catch (...) {
    handle->error.assign("unknown error");
  }
  return TENEBRA_FAILED;
}

/// What a question is asked with.
struct Question {
  const Geometry* geometry;
  QueryPoints points;
  tenebra_options options;
  QueryProgress progress;
};

Expected<Question> question(tenebra_tracer& tracer, const tenebra_geometry* geometry,
                            const tenebra_points* given, const tenebra_options* options) {
  if (geometry == nullptr || !geometry->geometry)
    return base::fail("geometry: found none, expected one that tenebra_geometry_set has filled");
  const auto points = known_members(given, tenebra_points TENEBRA_POINTS_INIT, "points");
  if (!points) return tl::unexpected(points.error());
  if (points->count > 0 && points->positions == nullptr)
    return base::fail("points: found no positions, expected {}", points->count);
  tenebra_options known = TENEBRA_OPTIONS_INIT;
  if (options != nullptr) {
    const auto chosen = known_members(options, known, "options");
    if (!chosen) return tl::unexpected(chosen.error());
    known = *chosen;
  }
  constexpr int most_threads = 1024;
  if (known.threads < 0 || known.threads > most_threads)
    return base::fail("options: found {} threads, expected 1 to {}, or 0 for all cores", known.threads,
                      most_threads);
  Question asked{&*geometry->geometry,
                 {.positions = span_of<glm::dvec3>(points->positions, points->count),
                  .triangles = span_of<std::uint32_t>(points->triangles, points->count),
                  .normals = span_of<glm::vec3>(points->normals, points->count),
                  .sides = span_of<std::int8_t>(points->sides, points->count),
                  .width = points->width},
                 known,
                 {}};
  if (known.progress != nullptr)
    asked.progress = [known, &tracer](double done) {
      if (known.progress(known.user, done) != 0) tracer.stop.request();
    };
  return asked;
}

/// Asks in the caller's number of threads. A request to stop is used up by the call that it ends.
template <class Ask>
tenebra_status ask(tenebra_tracer* tracer, const tenebra_geometry* geometry, const tenebra_points* points,
                   const tenebra_options* options, const Ask& call) noexcept {
  const tenebra_status status = guarded(tracer, [&]() -> Expected<void> {
    const auto asked = question(*tracer, geometry, points, options);
    if (!asked) return tl::unexpected(asked.error());
    Expected<void> done;
    with_threads(asked->options.threads, [&] { done = call(*asked); });
    if (done && tracer->stop.requested()) return base::stopped();
    return done;
  });
  if (status == TENEBRA_STOPPED) tracer->stop.reset();
  return status;
}

template <class Vector, class Number>
tenebra_status set_geometry(tenebra_geometry* geometry, const Number* positions, std::size_t vertex_count,
                            const std::uint32_t* triangles, std::size_t triangle_count,
                            const std::uint8_t* casts_shadow) noexcept {
  return guarded(geometry, [&]() -> Expected<void> {
    if ((vertex_count > 0 && positions == nullptr) || (triangle_count > 0 && triangles == nullptr))
      return base::fail("geometry: found null, expected {} vertices and {} triangles", vertex_count,
                        triangle_count);
    auto made = Geometry::create(span_of<Vector>(positions, vertex_count),
                                 span_of<glm::uvec3>(triangles, triangle_count),
                                 span_of<std::uint8_t>(casts_shadow, triangle_count));
    if (!made) return tl::unexpected(made.error());
    geometry->geometry = std::move(*made);
    return {};
  });
}

template <class Vector, class Number>
tenebra_status move_geometry(tenebra_geometry* geometry, const Number* positions,
                             std::size_t vertex_count) noexcept {
  return guarded(geometry, [&]() -> Expected<void> {
    if (!geometry->geometry) return base::fail("geometry: found none, expected tenebra_geometry_set first");
    return geometry->geometry->move_vertices(span_of<Vector>(positions, vertex_count));
  });
}

constexpr std::size_t most_vertices = 14;  // of make_area_light

/// Three numbers relative to `origin`: of `doubles` unless it is null.
glm::vec3 place_of(const float floats[3], const double* doubles, const glm::dvec3& origin) {
  const glm::dvec3 place =
      doubles == nullptr ? glm::dvec3(vector_of(floats)) : glm::dvec3(doubles[0], doubles[1], doubles[2]);
  return glm::vec3(place - origin);
}

Expected<AreaLight> area_light(const tenebra_area_light& light, const glm::dvec3& origin) {
  if (light.sun_diameter_deg != 0) return make_sun(vector_of(light.to_sun), light.sun_diameter_deg);
  const bool given = light.vertices != nullptr || light.vertices_doubles != nullptr;
  if (given && light.vertex_count > most_vertices)
    return base::fail("area light: found a polygon of {} vertices, expected 3 to {}", light.vertex_count,
                      most_vertices);
  std::vector<glm::vec3> vertices;
  for (std::size_t i = 0; given && i < light.vertex_count; ++i)
    vertices.push_back(light.vertices_doubles != nullptr
                           ? place_of(nullptr, light.vertices_doubles + 3 * i, origin)
                           : place_of(light.vertices + 3 * i, nullptr, origin));
  return make_area_light(vertices);
}

}  // namespace
}  // namespace tenebra::c_api

using namespace tenebra;         // NOLINT: the functions below are not in a namespace
using namespace tenebra::c_api;  // NOLINT

int tenebra_abi_version(void) {
  return TENEBRA_ABI_VERSION;
}

tenebra_geometry* tenebra_geometry_create(void) {
  return new (std::nothrow) tenebra_geometry;
}
void tenebra_geometry_destroy(tenebra_geometry* geometry) {
  delete geometry;
}
const char* tenebra_geometry_error(const tenebra_geometry* geometry) {
  return geometry == nullptr ? "geometry: found null, expected a handle" : geometry->error.c_str();
}

tenebra_status tenebra_geometry_set(tenebra_geometry* geometry, const float* positions, size_t vertex_count,
                                    const uint32_t* triangles, size_t triangle_count,
                                    const uint8_t* casts_shadow) {
  return set_geometry<glm::vec3>(geometry, positions, vertex_count, triangles, triangle_count, casts_shadow);
}
tenebra_status tenebra_geometry_set_doubles(tenebra_geometry* geometry, const double* positions,
                                            size_t vertex_count, const uint32_t* triangles,
                                            size_t triangle_count, const uint8_t* casts_shadow) {
  return set_geometry<glm::dvec3>(geometry, positions, vertex_count, triangles, triangle_count, casts_shadow);
}

tenebra_status tenebra_geometry_move(tenebra_geometry* geometry, const float* positions,
                                     size_t vertex_count) {
  return move_geometry<glm::vec3>(geometry, positions, vertex_count);
}
tenebra_status tenebra_geometry_move_doubles(tenebra_geometry* geometry, const double* positions,
                                             size_t vertex_count) {
  return move_geometry<glm::dvec3>(geometry, positions, vertex_count);
}

tenebra_tracer* tenebra_tracer_create(void) {
  try {
    return new tenebra_tracer;
  } catch (...) {
    return nullptr;
  }
}
void tenebra_tracer_destroy(tenebra_tracer* tracer) {
  delete tracer;
}
const char* tenebra_tracer_error(const tenebra_tracer* tracer) {
  return tracer == nullptr ? "tracer: found null, expected a handle" : tracer->error.c_str();
}
void tenebra_tracer_stop(tenebra_tracer* tracer) {
  if (tracer != nullptr) tracer->stop.request();
}

tenebra_status tenebra_hard_mask(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                 const tenebra_points* points, const tenebra_light* light,
                                 const tenebra_options* options, uint8_t* mask) {
  return ask(tracer, geometry, points, options, [&](const Question& q) -> Expected<void> {
    const auto known = known_members(light, tenebra_light TENEBRA_LIGHT_INIT, "light");
    if (!known) return tl::unexpected(known.error());
    const ShadowLight shadow{
        .directional = known->directional != 0,
        .position = place_of(known->position, known->position_doubles, q.geometry->origin()),
        .to_light = vector_of(known->to_light),
        .spot_axis = vector_of(known->spot_axis),
        .spot_cos_outer = known->spot_cos_outer,
        .range_m = known->range_m};
    return tracer->tracer.hard_mask(*q.geometry, q.points, shadow, {},
                                    answers(mask, q.points.positions.size()), &tracer->stop, q.progress);
  });
}

tenebra_status tenebra_soft_visibility(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                       const tenebra_points* points, const tenebra_area_light* light,
                                       const tenebra_options* options, float* visible_fraction,
                                       float* irradiance) {
  return ask(tracer, geometry, points, options, [&](const Question& q) -> Expected<void> {
    const auto known = known_members(light, tenebra_area_light TENEBRA_AREA_LIGHT_INIT, "light");
    if (!known) return tl::unexpected(known.error());
    const auto area = area_light(*known, q.geometry->origin());
    if (!area) return tl::unexpected(area.error());
    SoftShadowConfig config;
    config.error_255 = q.options.soft_error;
    if (q.options.soft_memory_bytes > 0) config.memory_bytes = q.options.soft_memory_bytes;
    const std::size_t count = q.points.positions.size();
    return tracer->tracer.soft_visibility(*q.geometry, q.points, *area, config,
                                          answers(visible_fraction, count), answers(irradiance, count),
                                          &tracer->stop, q.progress);
  });
}

tenebra_status tenebra_ambient_occlusion(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                         const tenebra_points* points, const tenebra_options* options,
                                         float* openness) {
  return ask(tracer, geometry, points, options, [&](const Question& q) -> Expected<void> {
    AoConfig config{
        .mode = AoMode::adaptive, .error_255 = q.options.ao_error, .distance_m = q.options.ao_distance_m};
    return tracer->tracer.ambient_occlusion(*q.geometry, q.points, config,
                                            answers(openness, q.points.positions.size()), &tracer->stop,
                                            q.progress);
  });
}
