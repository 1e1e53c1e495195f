#include "soft/point_lanes.h"

namespace tenebra {

void PointLanes::take(const PointGroups& groups, const PointGroup& group, const glm::dvec3& origin) {
  const auto pixels = groups.pixels_of(group);
  count = (pixels.size() + 15) / 16 * 16;
  for (auto* values : {&x, &y, &z, &column, &row})
    if (values->size() < count) values->resize(count);
  if (triangles.size() < count) triangles.resize(count);

  // Rows by a product in place of a quotient: pixel + 1/2 is at least half a pixel from the next row.
  const auto width = static_cast<std::uint32_t>(groups.width);
  const double rows = 1.0 / width;
  double column_sum = 0, row_sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    put(i, groups, pixels[i], origin);
    const auto at = static_cast<std::uint32_t>((pixels[i] + 0.5) * rows);
    column[i] = pixels[i] - at * width, row[i] = at;
    column_sum += column[i], row_sum += row[i];
  }
  const double share = 1.0 / static_cast<double>(pixels.size());
  const double mean_column = column_sum * share, mean_row = row_sum * share;
  for (std::size_t i = 0; i < pixels.size(); ++i) column[i] -= mean_column, row[i] -= mean_row;
  for (std::size_t i = pixels.size(); i < count; ++i) {
    put(i, groups, pixels[0], origin);
    column[i] = row[i] = 0;
  }
}

void PointLanes::put(std::size_t i, const PointGroups& groups, std::uint32_t pixel,
                     const glm::dvec3& origin) {
  const glm::dvec3& p = groups.points->positions[pixel];
  x[i] = p.x - origin.x, y[i] = p.y - origin.y, z[i] = p.z - origin.z;
  triangles[i] = groups.points->triangles[pixel];
}

}  // namespace tenebra
