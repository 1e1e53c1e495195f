// Two triangles of a floor, one above it, a light above that: half of the view is in shadow.
#include <cstdio>
#include <vector>

#include <tenebra/hard_shadows.h>

int main() {
  const std::vector<glm::vec3> positions{{-9, 0, 9}, {9, 0, 9}, {9, 0, -9}, {-9, 0, -9},
                                         {0, 1, 9},  {9, 1, 0}, {0, 1, -9}};
  const std::vector<glm::uvec3> indices{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  const tenebra::TriangleView triangles{positions, indices, {}};
  // A picture of 2 x 1 pixels from above that sees the floor at x = -1 and x = 1 (below the third triangle).
  const tenebra::ViewRays view{.eye = {0, 0.5f, 0.1f}, .d0 = {-4, -1, 0}, .dx = {4, 0, 0}, .dy = {0, 0, 0}};
  const std::vector<std::uint32_t> ids{1, 1};
  tenebra::VisiblePoints points;
  tenebra::compute_visible_points(ids, 2, 1, view, triangles, points);
  tenebra::ShadowTracer tracer;
  tenebra::ShadowMask mask;
  tracer.trace_shadow_mask(points, view, triangles, {.position = {0, 5, 0}}, {}, mask);
  std::printf("%d %d\n", mask[0], mask[1]);
  return mask[0] == 255 && mask[1] == 0 ? 0 : 1;
}
