// Small scenes for sun hours, and their suns.
#pragma once

#include <fstream>
#include <string>

#include "formats/import_scene.h"
#include "sun/sun_hours.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

/// An OBJ file with Z up, whose numbers `shift` is added to.
inline Scene map_scene(const std::vector<glm::dvec3>& vertices, const std::string& faces,
                       glm::dvec3 shift = glm::dvec3(0.0)) {
  const TemporaryFolder folder;
  std::ofstream out(folder / "map.obj");
  out.precision(17);
  for (const glm::dvec3& v : vertices) {
    const glm::dvec3 at = v + shift;
    out << "v " << at.x << ' ' << at.y << ' ' << at.z << '\n';
  }
  out << faces;
  out.close();
  formats::ImportOptions options;
  options.placement.up = UpAxis::z;
  return formats::import_scene(folder / "map.obj", options).value();
}

/// A floor of 40 x 40 m, faces 0 and 1, and on it a wall that runs from west to east, 2 m high, faces 2
/// and 3.
inline Scene wall_scene(glm::dvec3 shift = glm::dvec3(0.0)) {
  return map_scene({{-20, -20, 0},
                    {20, -20, 0},
                    {20, 20, 0},
                    {-20, 20, 0},
                    {-20, 0, 0},
                    {20, 0, 0},
                    {20, 0, 2},
                    {-20, 0, 2}},
                   "f 1 2 3 4\nf 5 6 7 8\n", shift);
}

inline FrameGeometry frame_of(const Scene& scene) {
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  return frame;
}

inline Geometry geometry_of(const FrameGeometry& frame) {
  return Geometry::create(frame.positions, frame.triangles, frame.casts_shadow).value();
}

inline sun::Suns day_of_suns(double latitude, const std::string& day, double step_min = 10) {
  const sun::Day at = sun::parse_day(day).value();
  sun::SunTimes times;
  times.place = {latitude, 0};
  times.days = {at, at, 1};
  times.step_min = step_min;
  return sun::suns_of(times).value();
}

/// Hours on points of the floor of a scene, given in the file's x and y.
inline sun::SunHours hours_at(const Scene& scene, const std::vector<glm::dvec3>& places,
                              const sun::Suns& suns, const sun::HoursConfig& config = {}) {
  const FrameGeometry frame = frame_of(scene);
  sun::Receivers receivers;
  for (const glm::dvec3& place : places) {
    receivers.positions.push_back(scene.frame.to_scene(place));
    receivers.normals.emplace_back(0, 1, 0);
    receivers.list.push_back({static_cast<std::uint32_t>(receivers.positions.size())});
  }
  return sun::sun_hours(geometry_of(frame), receivers, suns, config).value();
}

}  // namespace tenebra::testing
