// A camera for a scene that has none: nearby, with all of the subject in the picture, and some of its shadow.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::scene {

/// All that is drawn, at times spread over the first clip.
struct Subject {
  glm::dvec3 low{1.0}, high{-1.0};  ///< smallest box; low > high: there is nothing
  /// Middles of the box's 64^3 cells that hold a vertex: no vertex is further from one than `pad_m`.
  std::vector<glm::dvec3> places;
  double pad_m = 0;
  FrameGeometry first;                   ///< at the start
  std::vector<glm::dvec3> first_places;  ///< of its vertices

  bool empty() const { return low.x > high.x; }
  /// Half the sides of a cell.
  glm::dvec3 half_cell() const;
  glm::dvec3 centre() const { return empty() ? glm::dvec3(0.0) : 0.5 * (low + high); }
  double radius_m() const;  ///< half of the box's diagonal; 1 where that is 0
};
Subject subject_of(const Scene& scene);

/// Horizontal unit vectors: to the right of a view, and back towards its camera.
struct Compass {
  glm::dvec3 right{1, 0, 0}, back{0, 0, 1};
};
Compass compass_of(const glm::dvec3& right);

/// Unit, to a sun at the left behind the camera, 50 degrees high: the shadow falls to the right and away.
glm::dvec3 towards_sun(const Compass& compass);

struct Framing {
  glm::dvec3 eye{0.0};
  glm::dmat3 basis{1.0};  ///< right, up, back
  float vertical_fov_rad = 0.6f;
  float aspect = 4 / 3.0f;
  float near_m = 0.1f;
  double subject_share = 0;  ///< of the picture's area, at the start; of many small triangles by their cells
  double shadow_share = 0;   ///< of its shadow on the floor beside it; 0 without a floor
};

/// Of some directions, shares of the shadow and, without `aspect`, shapes of the picture: the first with
/// which the subject fills a third of the picture and its shadow is seen beside it; else the one that
/// comes nearest. `floor_y`: where the shadow falls; none: nowhere.
Framing frame_subject(const Subject& subject, std::optional<double> floor_y, std::optional<float> aspect);

}  // namespace tenebra::scene
