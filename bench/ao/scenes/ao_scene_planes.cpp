#include "bench/ao/scenes/ao_scene_planes.h"

#include "parallel/parallel.h"

namespace tenebra::bench {

PixelPlanes::PixelPlanes(const BenchFrame& frame, const PixelGrid& grid)
    : frame_(frame), grid_(grid), layout_(grid.width, grid.height), values_(6 * layout_.size(), 0.0f) {}

void PixelPlanes::take() {
  float* const planes = values_.data();
  const std::size_t size = layout_.size();
  parallel::parallel_ranges(static_cast<std::size_t>(grid_.height), 16,
                            [&](std::size_t first, std::size_t last) {
                              for (auto y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
                                float* out = planes + layout_.at(0, y);
                                for (int x = 0; x < grid_.width; ++x, ++out) {
                                  const std::size_t i = grid_.pixel(x, y, frame_.points.width);
                                  if (frame_.points.triangles[i] == no_triangle) continue;
                                  const glm::vec3 p(frame_.points.positions[i]), n = frame_.normals[i];
                                  out[0] = p.x, out[size] = p.y, out[2 * size] = p.z;
                                  out[3 * size] = n.x, out[4 * size] = n.y, out[5 * size] = n.z;
                                }
                              }
                            });
}

}  // namespace tenebra::bench
