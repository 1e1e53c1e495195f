// The module tenebra._core: numpy arrays in and out of queries.h and of the program's renderer. What a user
// calls, with its checks of shapes and types, is in __init__.py; this is the thinnest way there.
//
// Calls that take long run on a thread of their object's with Python's lock released, while the caller's
// thread wakes now and then to see whether Ctrl-C was pressed and to report progress.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <tenebra/queries.h>
#include <tenebra/threads.h>

#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "beside.h"
#include "loaded_scene.h"
#include "math/whole_origin.h"
#include "render/log/frame_columns.h"
#include "session/scene_summary.h"

namespace py = pybind11;

namespace tenebra::python {
namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style>;
template <class T>
using MaybeArray = std::optional<Array<T>>;
using Report = std::optional<py::function>;  ///< gets the part that is done, 0 to 1

template <class T>
T checked(Expected<T>&& result) {
  if (!result) throw py::value_error(result.error().message);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

// ---- Arrays ----

static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::dvec3) == 3 * sizeof(double) &&
              sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));

/// Rows of three numbers as vectors. __init__.py has seen to the shapes.
template <class Vector, class T>
std::span<const Vector> vectors(const Array<T>& array) {
  return {reinterpret_cast<const Vector*>(array.data()), static_cast<std::size_t>(array.size()) / 3};
}
template <class Vector, class T>
std::span<const Vector> vectors(const MaybeArray<T>& array) {
  return array ? vectors<Vector>(*array) : std::span<const Vector>();
}
template <class T>
std::span<const T> values(const MaybeArray<T>& array) {
  return array ? std::span<const T>(array->data(), static_cast<std::size_t>(array->size()))
               : std::span<const T>();
}
template <class T>
std::span<T> room(Array<T>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// An array that owns what was in `values`: nothing is copied.
template <class T>
py::array given_away(std::vector<T>&& values, std::vector<py::ssize_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
template <class Vector>
py::array given_away_vectors(std::vector<Vector>&& values, std::vector<py::ssize_t> shape) {
  using T = typename Vector::value_type;
  auto* const kept = new std::vector<Vector>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<Vector>*>(p); });
  shape.push_back(3);
  return py::array_t<T>(std::move(shape), reinterpret_cast<const T*>(kept->data()), owner);
}
template <class T>
py::array image(io::Image<T>&& from) {
  std::vector<py::ssize_t> shape{from.height, from.width};
  if (from.channels > 1) shape.push_back(from.channels);
  return given_away(std::move(from.pixels), std::move(shape));
}
template <class T>
py::tuple tuple_of(const glm::vec<3, T>& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

// ---- Long calls ----

/// Runs body(work), which gives Expected<void>, beside Python: signals and `report` are seen to every 20 ms.
template <class Body>
void run_beside(Beside& beside, const Report& report, int threads, const Body& body) {
  Work work;
  std::exception_ptr interrupted;
  Expected<void> result;
  {
    const py::gil_scoped_release released;
    double said = 0;
    const auto job = [&] {
      Expected<void> out;
      with_threads(threads, [&] { out = body(work); });
      return out;
    };
    const auto meanwhile = [&] {
      if (interrupted) return;
      const py::gil_scoped_acquire acquired;
      try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        const double done = work.done;
        if (report && done != said) (*report)(said = done);
      } catch (...) {
        interrupted = std::current_exception();
        work.stop.request();
      }
    };
    try {
      result = beside.run(job, std::chrono::milliseconds(20), meanwhile);
    } catch (...) {  // what the job threw: Ctrl-C goes before it
      if (!interrupted) throw;
    }
  }
  if (interrupted) std::rethrow_exception(interrupted);
  checked(std::move(result));
  if (report) (*report)(1.0);
}

// ---- Points and triangles ----

struct PointArrays {
  Array<double> positions;
  MaybeArray<std::uint32_t> triangles;
  MaybeArray<float> normals;
  MaybeArray<std::int8_t> sides;
  int width = 0;

  QueryPoints query() const {
    return {.positions = vectors<glm::dvec3>(positions),
            .triangles = values(triangles),
            .normals = vectors<glm::vec3>(normals),
            .sides = values(sides),
            .width = width};
  }
};

struct Tracer {
  PointTracer points;
  Beside beside;
};

QueryProgress noted_in(Work& work) {
  return [&work](double done) { work.done = done; };
}

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

// ---- Scenes ----

/// Positions of a scene, or directions, in the coordinates of its file.
template <class Vector>
std::vector<glm::dvec3> in_file(const FileFrame& frame, const std::vector<Vector>& positions) {
  std::vector<glm::dvec3> out;
  out.reserve(positions.size());
  for (const Vector& p : positions) out.push_back(frame.to_file(glm::dvec3(p)));
  return out;
}
void turn_to_file(const FileFrame& frame, std::vector<glm::vec3>& directions) {
  for (glm::vec3& d : directions) d = glm::vec3(frame.direction_to_file(glm::dvec3(d)));
}

py::dict geometry_dict(const FileFrame& frame, FrameGeometry&& geometry) {
  const auto vertices = static_cast<py::ssize_t>(geometry.positions.size());
  const auto triangles = static_cast<py::ssize_t>(geometry.triangles.size());
  py::dict out;
  turn_to_file(frame, geometry.normals);
  out["positions"] = frame.is_identity() ? given_away_vectors(std::move(geometry.positions), {vertices})
                                         : given_away_vectors(in_file(frame, geometry.positions), {vertices});
  out["normals"] = given_away_vectors(std::move(geometry.normals), {vertices});
  out["triangles"] = given_away_vectors(std::move(geometry.triangles), {triangles});
  out["materials"] = given_away(std::move(geometry.materials), {triangles});
  out["casts_shadow"] = given_away(std::move(geometry.casts_shadow), {triangles});
  return out;
}

py::list light_list(const LoadedScene& scene, double time_s) {
  py::list out;
  const render::FrameInput input = scene.at(time_s);
  Scene edited;
  edited.lights = stage::lights_of(scene.staged().scene, scene.edits());
  const FileFrame& frame = scene.staged().scene.frame;
  const auto turned = [&](const glm::vec3& v) { return tuple_of(frame.direction_to_file(glm::dvec3(v))); };
  for (const WorldLight& placed : input.lights) {
    const Light light = light_at(edited, placed);
    py::dict entry;
    entry["type"] = std::string(session::light_type_name(light.type));
    entry["name"] = light.name;
    entry["position"] = tuple_of(frame.to_file(glm::dvec3(placed.position)));
    entry["direction"] = turned(placed.direction);
    entry["half_x"] = turned(placed.axis_x);
    entry["half_y"] = turned(placed.axis_y);
    entry["color"] = tuple_of(light.color);
    entry["intensity"] = light.intensity;
    entry["range_m"] = light.range_m.value_or(0.0f);
    entry["outer_cone_rad"] = light.outer_cone_rad;
    out.append(entry);
  }
  return out;
}

py::dict view_dict(const FileFrame& frame, const ViewRays& view) {
  const auto turned = [&](const glm::vec3& v) { return tuple_of(frame.direction_to_file(glm::dvec3(v))); };
  py::dict out;
  out["eye"] = tuple_of(frame.to_file(glm::dvec3(view.eye))), out["d0"] = turned(view.d0);
  out["dx"] = turned(view.dx), out["dy"] = turned(view.dy);
  out["orthographic"] = view.orthographic;
  return out;
}

py::dict timings_dict(const FrameTimings& timings) {
  py::dict out;
  const auto add = [&](const auto& columns) {
    for (const render::TimingColumn& column : columns)
      out[py::str(std::string(column.name))] = timings.*column.value;
  };
  add(render::leading_timings);
  add(render::closing_timings);
  return out;
}

/// What was asked for with --aov, under the words of that option.
void add_aovs(const render::AovChoice& wanted, render::Aovs&& aovs, py::ssize_t height, py::ssize_t width,
              py::dict& out) {
  const auto add_picture = [&](const char* name, io::ImageF& from) {
    if (!from.pixels.empty()) out[name] = image(std::move(from));
  };
  const auto add_numbers = [&](const char* name, std::vector<std::uint32_t>& from) {
    if (!from.empty()) out[name] = given_away(std::move(from), {height, width});
  };
  add_picture("depth", aovs.depth);
  add_numbers("id", aovs.ids);
  add_numbers("part", aovs.parts);
  add_numbers("material", aovs.materials);
  add_picture("normal", aovs.normal);
  add_picture("irradiance", aovs.irradiance);
  add_picture("ao", aovs.openness);
  add_picture("albedo", aovs.albedo);
  if (!wanted.visibility) return;
  py::dict visibility;
  for (render::LightVisibility& of : aovs.visibility)
    visibility[py::int_(of.light)] = image(std::move(of.fraction));
  out["visibility"] = visibility;
}

/// The masks' numbers are the lights' places in the list that light_list gives.
py::dict picture_dict(const FileFrame& frame, LoadedScene::Picture&& picture) {
  render::FrameResult& result = picture.result;
  const py::ssize_t height = result.image.height, width = result.image.width;
  py::dict out, masks, fractions;
  for (render::LightMask& mask : result.masks) {
    masks[py::int_(mask.light)] = image(std::move(mask.mask));
    if (!mask.visible_fraction.pixels.empty())
      fractions[py::int_(mask.light)] = image(std::move(mask.visible_fraction));
  }
  out["image"] = image(std::move(result.image));
  if (!result.linear.pixels.empty()) out["linear"] = image(std::move(result.linear));
  out["masks"] = masks;
  out["visible_fraction"] = fractions;
  if (!picture.points.positions.empty()) {
    turn_to_file(frame, picture.normals);
    out["positions"] = given_away_vectors(in_file(frame, picture.points.positions), {height, width});
    out["normals"] = given_away_vectors(std::move(picture.normals), {height, width});
  }
  add_aovs(picture.aovs, std::move(result.aovs), height, width, out);
  out["triangles"] = given_away(std::move(picture.points.triangles), {height, width});
  out["view"] = view_dict(frame, picture.view);
  out["timings"] = timings_dict(result.timings);
  out["notes"] = result.notes;
  return out;
}

void add_scenes(py::module_& module) {
  using Loaded = LoadedScene;
  module.def("names_of_scene", &names_of_scene);
  module.def("names_of_render", &names_of_render);
  py::class_<Loaded>(module, "Scene")
      .def(py::init([](const std::string& path, const Keywords& keywords) {
        std::unique_ptr<Loaded> loaded;
        Beside beside;
        run_beside(beside, {}, 0, [&](Work&) -> Expected<void> {
          auto made = Loaded::load(path, keywords);
          if (!made) return tl::unexpected(made.error());
          loaded = std::move(*made);
          return {};
        });
        return loaded;
      }))
      .def("render",
           [](Loaded& scene, int frame, std::optional<double> time_s, const Keywords& keywords,
              bool with_points, bool linear, const Report& report) {
             std::optional<Loaded::Picture> picture;
             run_beside(scene.beside, report, 0, [&](Work& work) -> Expected<void> {
               auto drawn = scene.render(frame, time_s, keywords, {with_points, linear}, work);
               if (!drawn) return tl::unexpected(drawn.error());
               picture = std::move(*drawn);
               return {};
             });
             return picture_dict(scene.staged().scene.frame, std::move(*picture));
           })
      .def("time_of", [](const Loaded& scene, int frame) { return checked(scene.time_of(frame)); })
      .def("geometry",
           [](const Loaded& scene, double time_s) {
             return geometry_dict(scene.staged().scene.frame, std::move(scene.at(time_s).geometry));
           })
      .def("lights", &light_list)
      .def_property_readonly("frames", [](const Loaded& scene) { return scene.staged().frames(); })
      .def_property_readonly("size",
                             [](const Loaded& scene) {
                               return py::make_tuple(scene.staged().size.width, scene.staged().size.height);
                             })
      .def_property_readonly("name", [](const Loaded& scene) { return scene.staged().scene.name; })
      .def_property_readonly("warnings", [](const Loaded& scene) { return scene.staged().scene.warnings; });
}

}  // namespace
}  // namespace tenebra::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package tenebra is made of; use that.";
  module.attr("version") = TENEBRA_VERSION;
  module.attr("no_triangle") = tenebra::no_triangle;
  tenebra::python::add_queries(module);
  tenebra::python::add_scenes(module);
}
