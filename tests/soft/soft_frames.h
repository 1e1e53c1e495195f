// Frames of the bundled and the BART scenes as cases of the soft shadows.
#pragma once

#include <fmt/core.h>
#include "soft/soft_case.h"
#include "stage/left_out.h"
#include "support/bart.h"

namespace tenebra::testing {

struct SceneFrame {
  const char* scene;  ///< of BART, or a bundled one
  int frame;
  const char* no_cast = "";
};
/// The views of the issue; robots without its sky dome as a caster.
inline const SceneFrame bart_frames[] = {
    {"robots/Robot.aff", 100, "city2.aff:69"}, {"museum/museum5.aff", 20}, {"kitchen/kitchen.aff", 100}};
inline const SceneFrame bundled_frames[] = {{"city.glb", 150}, {"gallery.glb", 100}, {"court.glb", 150}};

inline std::filesystem::path path_of(const SceneFrame& frame) {
  const std::filesystem::path bundled = std::filesystem::path(TENEBRA_SCENES_DIR) / frame.scene;
  return std::filesystem::exists(bundled) ? bundled : bart_folder() / frame.scene;
}

/// What a frame's own camera sees.
struct LoadedFrame {
  Scene scene;
  FrameGeometry geometry;
  double time_s = 0;
  Soup soup;
  ViewRays view;
  VisiblePoints points;
};
inline LoadedFrame load_frame(const SceneFrame& frame, int width, int height) {
  Expected<Scene> scene = formats::import_scene(path_of(frame));
  if (!scene) throw std::runtime_error(scene.error().message);
  std::string unmatched;
  if (*frame.no_cast != 0 && !stage::leave_out_casters(*scene, {frame.no_cast}, unmatched))
    throw std::runtime_error(unmatched + " matches nothing in " + frame.scene);
  LoadedFrame out;
  out.time_s = frame_time_s(scene->clips.at(0), frame.frame, 30.0);
  evaluate_frame(*scene, 0, out.time_s, out.geometry);
  out.soup.positions = out.geometry.positions, out.soup.triangles = out.geometry.triangles;
  out.soup.casts = out.geometry.casts_shadow;
  out.view = evaluate_camera(*scene, 0, out.time_s, 0, width, height);
  out.points = view_samples(out.soup.view(), out.view, width, height);
  out.scene = std::move(*scene);
  return out;
}

/// Light number `light` made a square of `percent` of the scene's diagonal that faces the scene's centre;
/// points and shading normals of the frame's own camera.
inline SoftCase frame_case(const SceneFrame& frame, int width, int height, double percent = 4,
                           std::size_t light = 0) {
  SoftCase c;
  c.name = fmt::format("{} frame {} light {} of {} %", frame.scene, frame.frame, light, percent);
  LoadedFrame loaded = load_frame(frame, width, height);
  compute_shading_normals(loaded.points, loaded.geometry.normals, loaded.soup.view(), c.normals);
  c.soup = std::move(loaded.soup), c.view = loaded.view, c.points = std::move(loaded.points);
  const WorldLight placed = evaluate_lights(loaded.scene, 0, loaded.time_s).at(light);
  const glm::dvec3 low = c.soup.low(), high = c.soup.high();
  c.light =
      square_light(glm::dvec3(placed.position), 0.5 * (low + high), percent / 100 * glm::length(high - low));
  return c;
}

}  // namespace tenebra::testing
