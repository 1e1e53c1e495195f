#include "ao/adaptive/pixel_surfaces.h"

#include <cmath>

#include "parallel/parallel.h"

namespace tenebra::ao {

void find_surfaces(const AoFrame& frame, double reach, PixelSurfaces& out) {
  const VisiblePoints& points = frame.points;
  out.width = points.width, out.height = points.height;
  out.pixels.assign(points.triangles.size(), {});
  glm::dvec3 origin(0.0);
  for (std::size_t i = 0; i < points.triangles.size(); ++i) {
    if (points.triangles[i] == no_triangle) continue;
    origin = points.positions[i];
    break;
  }
  parallel::parallel_ranges(out.pixels.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (points.triangles[i] == no_triangle) continue;
      const glm::vec3 at((points.positions[i] - origin) / reach), normal = frame.normals[i];
      const float square = glm::dot(normal, normal);
      if (std::isfinite(at.x + at.y + at.z) && square > 0.25f && square < 4.0f) out.pixels[i] = {at, normal};
    }
  });
}

}  // namespace tenebra::ao
