// What a scene's file says where the frame that is drawn says something else: coordinates far from the origin
// are rounded to floats, and their contact tolerance is large.
#pragma once

#include <optional>
#include <vector>

#include <tenebra/visible_points.h>
#include "render/renderer.h"
#include "session/staged_scene.h"

namespace tenebra::viewer {

/// A frame as its file has it, in double, relative to an origin of its own near by.
struct FileNumbers {
  glm::dvec3 origin{0.0};             ///< in the coordinates of the frame that is drawn, metres
  std::vector<glm::dvec3> positions;  ///< of FrameGeometry's vertices
  ViewRays view;
  VisiblePoints points;   ///< at the same places of their triangles
  double rounding_m = 0;  ///< the most by which a coordinate of the frame that is drawn differs

  /// A light of that frame.
  ShadowLight light(const session::StagedScene& staged, double time_s, const WorldLight& placed,
                    ShadowLight drawn) const;
};

/// None where floats are fine: where the frame's coordinates are not large beside its size and differ from
/// the file's by the rounding of floats of their size alone. `points`: with positions.
std::optional<FileNumbers> file_numbers(const session::StagedScene& staged, double time_s,
                                        const render::FrameInput& input, const VisiblePoints& points);

}  // namespace tenebra::viewer
