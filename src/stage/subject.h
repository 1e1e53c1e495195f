// What a camera that is added has to show: all that is drawn, and where it is.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::stage {

/// The smallest box around the vertices in one cell.
struct SubjectPart {
  glm::dvec3 middle{0.0}, half{0.0};
};

/// All that is drawn, at times spread over the first clip.
struct Subject {
  glm::dvec3 low{1.0}, high{-1.0};      ///< smallest box; low > high: there is nothing
  std::vector<SubjectPart> places;      ///< of the box's 64^3 cells those with a vertex, at any of the times
  FrameGeometry first;                  ///< at the start
  std::vector<glm::dvec3> first_cells;  ///< middles of the cells with a vertex at the start
  glm::dvec3 long_axis{1, 0, 0};        ///< unit: along it the places are spread most
  double slenderness = 1;               ///< how many times more than across it, 1 or more

  bool empty() const { return low.x > high.x; }
  glm::dvec3 half_cell() const;
  glm::dvec3 centre() const { return empty() ? glm::dvec3(0.0) : 0.5 * (low + high); }
  double radius_m() const;  ///< half of the box's diagonal; 1 where that is 0
};
Subject subject_of(const Scene& scene);

}  // namespace tenebra::stage
