// Scene files with numpy arrays: their triangles, lights and pictures.
#include <memory>
#include <string>

#include "arrays.h"
#include "loaded_scene.h"
#include "long_calls.h"
#include "module_parts.h"
#include "render/log/frame_columns.h"
#include "session/scene_summary.h"
#include "settings/nearest_word.h"

namespace tenebra::python {
namespace {

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
/// Three numbers a pixel.
void turn_to_file(const FileFrame& frame, io::ImageF& directions) {
  std::vector<float>& d = directions.pixels;
  for (std::size_t i = 0; i < d.size(); i += 3) {
    const glm::vec3 turned(frame.direction_to_file({d[i], d[i + 1], d[i + 2]}));
    d[i] = turned.x, d[i + 1] = turned.y, d[i + 2] = turned.z;
  }
}
/// A way through the scene, in the axes and units of its file.
py::tuple way_in_file(const FileFrame& frame, const glm::vec3& way) {
  return tuple_of(frame.direction_to_file(glm::dvec3(way)) / frame.metres_per_unit);
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
  edited.lights = stage::lights_of(scene.staged().scene, scene.edits(), scene.staged().light_has_units);
  const FileFrame& frame = scene.staged().scene.frame;
  for (const WorldLight& placed : input.lights) {
    const Light light = light_at(edited, placed);
    py::dict entry;
    entry["type"] = std::string(session::light_type_name(light.type));
    entry["name"] = light.name;
    entry["position"] = tuple_of(frame.to_file(glm::dvec3(placed.position)));
    entry["direction"] = tuple_of(frame.direction_to_file(glm::dvec3(placed.direction)));
    entry["half_x"] = way_in_file(frame, placed.axis_x);
    entry["half_y"] = way_in_file(frame, placed.axis_y);
    entry["color"] = tuple_of(light.color);
    entry["intensity"] = light.intensity;
    entry["range_m"] = light.range_m.value_or(0.0f);
    entry["outer_cone_rad"] = light.outer_cone_rad;
    out.append(entry);
  }
  return out;
}

py::dict view_dict(const FileFrame& frame, const ViewRays& view) {
  py::dict out;
  out["eye"] = tuple_of(frame.to_file(glm::dvec3(view.eye)));
  out["d0"] = way_in_file(frame, view.d0);
  out["dx"] = way_in_file(frame, view.dx), out["dy"] = way_in_file(frame, view.dy);
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
void add_aovs(const FileFrame& frame, const render::AovChoice& wanted, render::Aovs&& aovs,
              py::ssize_t height, py::ssize_t width, py::dict& out) {
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
  turn_to_file(frame, aovs.normal);
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
  add_aovs(frame, picture.aovs, std::move(result.aovs), height, width, out);
  out["triangles"] = given_away(std::move(picture.points.triangles), {height, width});
  out["view"] = view_dict(frame, picture.view);
  out["timings"] = timings_dict(result.timings);
  out["notes"] = result.notes;
  return out;
}

}  // namespace

void add_scenes(py::module_& module) {
  using Loaded = LoadedScene;
  module.def("names_of_scene", &names_of_scene);
  module.def("names_of_render", &names_of_render);
  module.def("did_you_mean", [](const std::string& name, const std::vector<std::string>& known) {
    return settings::did_you_mean(name, known);
  });
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
      .def_property_readonly(
          "up_axis",
          [](const Loaded& scene) { return scene.staged().scene.frame.up == UpAxis::z ? "z" : "y"; })
      .def_property_readonly("name", [](const Loaded& scene) { return scene.staged().scene.name; })
      .def_property_readonly("warnings", [](const Loaded& scene) { return scene.staged().scene.warnings; });
}

}  // namespace tenebra::python
