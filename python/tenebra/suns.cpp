// Places of the sun, and what points and faces see of many suns, with numpy arrays. sun.py has seen to shapes
// and ranges.
#include <limits>
#include <string>

#include "arrays.h"
#include "long_calls.h"
#include "module_parts.h"
#include "point_arrays.h"
#include "stage/additions.h"
#include "sun/seasons.h"

namespace tenebra::python {
namespace {

sun::Refraction refraction_of(bool air) {
  return air ? sun::Refraction::standard : sun::Refraction::none;
}

py::tuple positions(double latitude_deg, double longitude_deg, const Array<double>& utc_s, bool air) {
  const auto count = static_cast<py::ssize_t>(utc_s.size());
  std::vector<double> azimuth, altitude;
  for (py::ssize_t i = 0; i < count; ++i) {
    const sun::Position at =
        sun::position({latitude_deg, longitude_deg}, utc_s.data()[i], refraction_of(air));
    azimuth.push_back(at.azimuth_deg), altitude.push_back(at.altitude_deg);
  }
  return py::make_tuple(given_away(std::move(azimuth), {count}), given_away(std::move(altitude), {count}));
}

py::array directions(const Array<double>& azimuth_deg, const Array<double>& altitude_deg, double north_deg,
                     bool z_up) {
  const FileFrame frame{.up = z_up ? UpAxis::z : UpAxis::y};
  const auto count = static_cast<py::ssize_t>(azimuth_deg.size());
  std::vector<glm::dvec3> out;
  for (py::ssize_t i = 0; i < count; ++i)
    out.push_back(
        frame.direction_to_file(sun::direction({azimuth_deg.data()[i], altitude_deg.data()[i]}, north_deg)));
  return given_away_vectors(std::move(out), {count});
}

template <class T>
T read(const char* name, Expected<T>&& value) {
  if (!value) throw py::value_error(std::string(name) + ": " + value.error().message);
  return *value;
}

/// Seconds since 1970 and hours of the suns of these days that stand above the horizon.
py::tuple suns_of_days(double latitude_deg, double longitude_deg, const std::string& days, double step_min,
                       const std::string& zone, bool air) {
  const bool one = days.find(':') == days.npos;
  const sun::Suns suns =
      read("days", sun::suns_of({.place = {latitude_deg, longitude_deg},
                                 .days = read("days", sun::parse_days(one ? days + ":" + days : days)),
                                 .step_min = step_min,
                                 .zone_min = read("zone", sun::parse_zone(zone)),
                                 .refraction = refraction_of(air)}));
  std::vector<double> times, hours;
  for (const sun::Sun& sun : suns.list) times.push_back(sun.utc_s), hours.push_back(sun.weight / 60);
  const auto count = static_cast<py::ssize_t>(times.size());
  return py::make_tuple(given_away(std::move(times), {count}), given_away(std::move(hours), {count}));
}

/// `directions`: in the axes of `frame`'s file, none of them zero.
std::vector<sun::Sun> sun_list(const Array<double>& directions, const Array<double>& weights,
                               const FileFrame& frame) {
  std::vector<sun::Sun> suns;
  for (const glm::dvec3& given : vectors<glm::dvec3>(directions))
    suns.push_back({glm::normalize(frame.direction_to_scene(given)), weights.data()[suns.size()]});
  return suns;
}

py::dict hours_dict(sun::SunHours&& hours) {
  const auto count = static_cast<py::ssize_t>(hours.sums.size());
  py::dict out;
  out["sum"] = given_away(std::move(hours.sums), {count});
  out["first"] = given_away(std::move(hours.first), {count});
  out["last"] = given_away(std::move(hours.last), {count});
  return out;
}

py::dict sun_hours(const Geometry& geometry, const PointArrays& points, const Array<double>& directions,
                   const Array<double>& weights, double disc_deg, int threads, const Report& report) {
  const QueryPoints query = points.query();
  const std::vector<sun::Sun> suns = sun_list(directions, weights, {});
  std::vector<std::uint32_t> ends(query.positions.size());
  for (std::size_t i = 0; i < ends.size(); ++i) ends[i] = static_cast<std::uint32_t>(i + 1);
  sun::SunHours hours;
  Beside beside;
  run_beside(beside, report, threads, [&](Work& work) -> Expected<void> {
    auto seen =
        sun::sun_hours(geometry, query, ends, suns, {.disc_deg = disc_deg}, &work.stop, noted_in(work));
    if (!seen) return tl::unexpected(seen.error());
    hours = std::move(*seen);
    return {};
  });
  return hours_dict(std::move(hours));
}

/// A row of `mask` for each sun: 255 or 0.
void sun_masks(const Geometry& geometry, const PointArrays& points, const Array<double>& directions,
               Array<std::uint8_t>& mask, int threads, const Report& report) {
  const QueryPoints query = points.query();
  std::vector<ShadowLight> lights;
  for (const glm::dvec3& to_sun : vectors<glm::dvec3>(directions))
    lights.push_back({.directional = true, .to_light = glm::vec3(glm::normalize(to_sun))});
  const auto to = room(mask);
  Beside beside;
  run_beside(beside, report, threads, [&](Work& work) {
    PointTracer tracer;
    return tracer.hard_masks(
        geometry, query, lights, {},
        [&](std::size_t sun, std::span<const std::uint8_t> seen) {
          std::copy(seen.begin(), seen.end(), to.begin() + static_cast<std::ptrdiff_t>(sun * seen.size()));
          work.done = static_cast<double>(sun + 1) / static_cast<double>(lights.size());
        },
        &work.stop);
  });
}

/// Where a scene's sun is counted: faces or, with a height, the ground.
struct SceneChoice {
  sun::FaceChoice faces;
  std::optional<double> ground;
  double cell_m = 1;
};

void add_places(const FileFrame& frame, const sun::Receivers& receivers, py::dict& out) {
  const auto count = static_cast<py::ssize_t>(receivers.list.size());
  std::vector<double> columns[4];  // x, y, z and the area
  for (const sun::Receiver& receiver : receivers.list) {
    const glm::dvec3 at = frame.to_file(receiver.centre);
    for (int axis = 0; axis < 3; ++axis) columns[axis].push_back(at[axis]);
    columns[3].push_back(receiver.area_m2);
  }
  const char* names[] = {"x", "y", "z", "area_m2"};
  for (int i = 0; i < 4; ++i) out[names[i]] = given_away(std::move(columns[i]), {count});
}

/// The numbers of faces, their nodes and materials; or the rows and columns of cells.
void add_numbers(const FrameGeometry& geometry, const sun::Receivers& receivers, py::dict& out) {
  const auto count = static_cast<py::ssize_t>(receivers.list.size());
  std::vector<std::uint32_t> columns[3];
  const bool faces = receivers.kind == sun::ReceiverKind::faces;
  for (const sun::Receiver& receiver : receivers.list) {
    const std::size_t cell = columns[0].size();
    const auto across = static_cast<std::size_t>(receivers.grid.columns);
    columns[0].push_back(faces ? receiver.triangle : static_cast<std::uint32_t>(cell / across));
    columns[1].push_back(faces ? static_cast<std::uint32_t>(receiver.node)
                               : static_cast<std::uint32_t>(cell % across));
    if (faces) columns[2].push_back(geometry.materials[receiver.triangle]);
  }
  const char* names[] = {faces ? "face" : "row", faces ? "node" : "column", "material"};
  for (int i = 0; i < (faces ? 3 : 2); ++i) out[names[i]] = given_away(std::move(columns[i]), {count});
}

py::dict scene_sun_hours(LoadedScene& scene, double time_s, const Array<double>& directions,
                         const Array<double>& weights, const SceneChoice& choice, double disc_deg,
                         int threads, const Report& report) {
  const Scene& staged = scene.staged().scene;
  const std::vector<sun::Sun> suns = sun_list(directions, weights, staged.frame);
  FrameGeometry frame;
  sun::Receivers receivers;
  sun::SunHours hours;
  run_beside(scene.beside, report, threads, [&](Work& work) -> Expected<void> {
    frame = std::move(scene.at(time_s).geometry);
    constexpr double below_all = -std::numeric_limits<double>::infinity();
    stage::hide_floor_from_below(scene.staged().added, below_all, frame);  // it is for pictures alone
    auto found = choice.ground ? sun::ground_receivers(frame, staged.frame, *choice.ground, choice.cell_m)
                               : sun::face_receivers(staged, frame, choice.faces);
    if (!found) return tl::unexpected(found.error());
    receivers = std::move(*found);
    auto seen = sun::hours_of({staged, frame, {}}, receivers, {.list = suns}, {.disc_deg = disc_deg},
                              &work.stop, noted_in(work));
    if (!seen) return tl::unexpected(seen.error());
    hours = std::move(*seen);
    return {};
  });
  py::dict out;
  add_numbers(frame, receivers, out);
  add_places(staged.frame, receivers, out);
  for (const auto& [name, values] : hours_dict(std::move(hours))) out[name] = values;
  return out;
}

template <class Table>
std::vector<std::string> names_in(const Table& table) {
  std::vector<std::string> names;
  for (const auto& row : table) names.push_back(row.name);
  return names;
}

}  // namespace

void add_suns(py::module_& module) {
  module.def("sun_positions", &positions);
  module.def("sun_directions", &directions);
  module.def("suns_of", &suns_of_days);
  module.def("sun_hours", &sun_hours);
  module.def("sun_masks", &sun_masks);
  module.def("scene_sun_hours",
             [](LoadedScene& scene, double time_s, const Array<double>& suns, const Array<double>& weights,
                const std::vector<std::string>& nodes, const std::vector<std::string>& materials, bool upward,
                bool both_sides, int per_face, double per_m2, std::optional<double> ground, double cell_m,
                double disc_deg, int threads, const Report& report) {
               const SceneChoice choice{.faces = {.nodes = nodes,
                                                  .materials = materials,
                                                  .upward = upward,
                                                  .both_sides = both_sides,
                                                  .per_face = per_face,
                                                  .per_m2 = per_m2},
                                        .ground = ground,
                                        .cell_m = cell_m};
               return scene_sun_hours(scene, time_s, suns, weights, choice, disc_deg, threads, report);
             });
  module.def("node_names", [](const LoadedScene& scene) { return names_in(scene.staged().scene.nodes); });
  module.def("material_names",
             [](const LoadedScene& scene) { return names_in(scene.staged().scene.materials); });
}

}  // namespace tenebra::python
