// Points and triangles of the caller's: queries.h with numpy arrays.
#include <tenebra/queries.h>

#include <array>
#include <functional>

#include "arrays.h"
#include "long_calls.h"
#include "math/whole_origin.h"
#include "module_parts.h"
#include "point_arrays.h"

namespace tenebra::python {
namespace {

struct Tracer {
  PointTracer points;
  Beside beside;
};

/// A light without an area, its place in the caller's coordinates.
struct PlacedLight {
  ShadowLight light;
  glm::dvec3 position{0.0};

  ShadowLight relative_to(const glm::dvec3& origin) const {
    ShadowLight out = light;
    out.position = glm::vec3(position - origin);
    return out;
  }
};

/// A light with an area, in the caller's coordinates; a sun has no place in them.
struct PlacedAreaLight {
  using Make = std::function<Expected<AreaLight>(const glm::dvec3& origin)>;
  glm::dvec3 origin{0.0};
  AreaLight light;  ///< relative to `origin`
  Make make;        ///< the same relative to another

  static PlacedAreaLight near(const glm::dvec3& origin, Make make) {
    return {origin, checked(make(origin)), std::move(make)};
  }
  AreaLight relative_to(const glm::dvec3& other) const {
    return light.at_infinity || other == origin ? light : checked(make(other));
  }
};

glm::dvec3 vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}
glm::vec3 floats_of(const std::array<double, 3>& v) {
  return glm::vec3(vector_of(v));
}

PlacedAreaLight polygon_light(const Array<double>& vertices) {
  const std::span<const glm::dvec3> given = vectors<glm::dvec3>(vertices);
  const std::vector<glm::dvec3> corners(given.begin(), given.end());
  return PlacedAreaLight::near(math::whole_origin(corners), [corners](const glm::dvec3& origin) {
    std::vector<glm::vec3> relative;
    relative.reserve(corners.size());
    for (const glm::dvec3& corner : corners) relative.emplace_back(corner - origin);
    return make_area_light(relative);
  });
}

PlacedAreaLight disc_light(const std::array<double, 3>& centre, const std::array<double, 3>& half_x,
                           const std::array<double, 3>& half_y) {
  const glm::dvec3 middle = vector_of(centre);
  const glm::vec3 x = floats_of(half_x), y = floats_of(half_y);
  return PlacedAreaLight::near(glm::round(middle), [=](const glm::dvec3& origin) {
    return make_disc_light(glm::vec3(middle - origin), x, y);
  });
}

PlacedAreaLight sun_light(const std::array<double, 3>& to_sun, double diameter_deg) {
  return {glm::dvec3(0.0), checked(make_sun(floats_of(to_sun), diameter_deg)), {}};
}

py::array vertices_of(const PlacedAreaLight& light) {
  std::vector<glm::dvec3> vertices;
  for (const glm::vec3& v : light.light.vertices) vertices.push_back(light.origin + glm::dvec3(v));
  const auto count = static_cast<py::ssize_t>(vertices.size());
  return given_away_vectors(std::move(vertices), {count});
}

void hard_mask(Tracer& tracer, const Geometry& geometry, const PointArrays& points, const PlacedLight& placed,
               Array<std::uint8_t>& mask, int threads, const Report& report) {
  const ShadowLight light = placed.relative_to(geometry.origin());
  const QueryPoints query = points.query();
  const auto to = room(mask);
  run_beside(tracer.beside, report, threads, [&](Work& work) {
    return tracer.points.hard_mask(geometry, query, light, {}, to, &work.stop, noted_in(work));
  });
}

void soft_visibility(Tracer& tracer, const Geometry& geometry, const PointArrays& points,
                     const PlacedAreaLight& placed, double error, std::optional<std::size_t> memory_bytes,
                     Array<float>& fraction, Array<float>& irradiance, int threads, const Report& report) {
  const AreaLight light = placed.relative_to(geometry.origin());
  const QueryPoints query = points.query();
  const auto to_fraction = room(fraction), to_irradiance = room(irradiance);
  SoftShadowConfig config;
  config.error_255 = error;
  config.memory_bytes = memory_bytes;
  run_beside(tracer.beside, report, threads, [&](Work& work) {
    return tracer.points.soft_visibility(geometry, query, light, config, to_fraction, to_irradiance,
                                         &work.stop, noted_in(work));
  });
}

void ambient_occlusion(Tracer& tracer, const Geometry& geometry, const PointArrays& points, double distance_m,
                       double error, Array<float>& openness, int threads, const Report& report) {
  const QueryPoints query = points.query();
  const auto to = room(openness);
  const AoConfig config{.mode = AoMode::adaptive, .error_255 = error, .distance_m = distance_m};
  run_beside(tracer.beside, report, threads, [&](Work& work) {
    return tracer.points.ambient_occlusion(geometry, query, config, to, &work.stop, noted_in(work));
  });
}

}  // namespace

void add_queries(py::module_& module) {
  py::class_<Geometry>(module, "Geometry")
      .def(py::init([](const py::array& positions, const Array<std::uint32_t>& triangles,
                       const MaybeArray<std::uint8_t>& casts) {
        const auto made = [&](auto vertices) {
          return checked(Geometry::create(vertices, vectors<glm::uvec3>(triangles), values(casts)));
        };
        if (py::isinstance<Array<double>>(positions))
          return made(vectors<glm::dvec3>(py::cast<Array<double>>(positions)));
        return made(vectors<glm::vec3>(py::cast<Array<float>>(positions)));
      }))
      .def(
          "move_vertices",
          [](Geometry& geometry, const py::array& positions) {
            if (py::isinstance<Array<double>>(positions))
              return checked(geometry.move_vertices(vectors<glm::dvec3>(py::cast<Array<double>>(positions))));
            checked(geometry.move_vertices(vectors<glm::vec3>(py::cast<Array<float>>(positions))));
          })
      .def_property_readonly("origin", [](const Geometry& geometry) { return tuple_of(geometry.origin()); });
  py::class_<PointArrays>(module, "PointArrays")
      .def(py::init<Array<double>, MaybeArray<std::uint32_t>, MaybeArray<float>, MaybeArray<std::int8_t>,
                    int>());
  py::class_<PlacedLight>(module, "ShadowLight")
      .def(py::init([](bool directional, const std::array<double, 3>& v, const std::array<double, 3>& axis,
                       float cos_outer, float range_m) {
        return PlacedLight{{directional, floats_of(v), floats_of(v), floats_of(axis), cos_outer, range_m},
                           vector_of(v)};
      }));
  py::class_<PlacedAreaLight>(module, "AreaLight")
      .def(py::init(&polygon_light))
      .def_static("disc", &disc_light)
      .def_static("sun", &sun_light)
      .def_property_readonly("vertices", &vertices_of)
      .def_property_readonly("area_m2", [](const PlacedAreaLight& light) { return light.light.area_m2; });
  py::class_<Tracer>(module, "PointTracer")
      .def(py::init<>())
      .def("hard_mask", &hard_mask)
      .def("soft_visibility", &soft_visibility)
      .def("ambient_occlusion", &ambient_occlusion);
}

}  // namespace tenebra::python
