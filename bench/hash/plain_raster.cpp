#include "bench/hash/plain_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The view in double, and how its pixels are found from points.
struct PlainCamera {
  PlainCamera(const ViewRays& view, int width, int height)
      : eye(view.eye),
        d0(view.d0),
        dx(view.dx),
        dy(view.dy),
        orthographic(view.orthographic),
        width(width),
        height(height) {
    const dvec3 across = glm::cross(dx, dy);
    const double volume = glm::dot(across, d0);
    to_depth = across / volume;
    to_x = glm::cross(dy, d0) / volume;
    to_y = glm::cross(d0, dx) / volume;
    const double advance = std::abs(glm::dot(d0, across / std::sqrt(glm::dot(across, across))));
    near_t = static_cast<double>(view.near_m) / advance;
  }
  dvec3 eye, d0, dx, dy;
  bool orthographic;
  int width, height;
  dvec3 to_depth, to_x, to_y;  ///< of p - eye: ray parameter, and x and y (times it, in perspective)
  double near_t;               ///< ray parameter of the near plane, the same for all pixels
};

struct Ray {
  dvec3 from, along;
};

Ray ray_of(const PlainCamera& camera, int x, int y) {
  const dvec3 step = (x + 0.5) * camera.dx + (y + 0.5) * camera.dy;
  if (camera.orthographic) return {camera.eye + step, camera.d0};
  return {camera.eye, camera.d0 + step};
}

/// Pixels first ... last - 1 in x and y.
struct PixelBox {
  int first_x, last_x, first_y, last_y;
};

int to_pixel(double place, int size) {
  return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(size)));
}

/// Pixels whose rays may meet the triangle, and one more around them; all where a corner lies before the near
/// plane and another beyond it.
PixelBox pixels_of(const PlainCamera& camera, const dvec3 corners[3]) {
  const PixelBox none{0, 0, 0, 0}, all{0, camera.width, 0, camera.height};
  double low_x = infinity, low_y = infinity, high_x = -infinity, high_y = -infinity;
  int before = 0;
  for (int k = 0; k < 3; ++k) {
    const dvec3 q = corners[k] - camera.eye;
    const double depth = glm::dot(camera.to_depth, q), over = camera.orthographic ? 1.0 : depth;
    if (!(depth >= camera.near_t)) ++before;
    const double x = glm::dot(camera.to_x, q) / over, y = glm::dot(camera.to_y, q) / over;
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  if (before == 3) return none;
  if (before != 0) return all;
  return {to_pixel(low_x - 1, camera.width), to_pixel(high_x + 2, camera.width),
          to_pixel(low_y - 1, camera.height), to_pixel(high_y + 2, camera.height)};
}

/// Ray parameter where the ray meets the triangle, its edges included; infinity: nowhere. Neighbours compute
/// the same products for the edge that they share, so that no ray slips between them.
double meeting(const Ray& ray, const dvec3 corners[3]) {
  const dvec3 a = corners[0] - ray.from, b = corners[1] - ray.from, c = corners[2] - ray.from;
  const double u = glm::dot(ray.along, glm::cross(b, c)), v = glm::dot(ray.along, glm::cross(c, a)),
               w = glm::dot(ray.along, glm::cross(a, b));
  const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  const dvec3 normal = glm::cross(b - a, c - a);
  const double speed = glm::dot(ray.along, normal);
  return inside && speed != 0 ? glm::dot(a, normal) / speed : infinity;
}

/// Rows first ... last - 1 of the picture.
void draw_rows(const TriangleView& triangles, const PlainCamera& camera, int first, int last,
               std::vector<double>& nearest, std::vector<std::uint32_t>& ids) {
  for (std::size_t id = 0; id < triangles.triangles.size(); ++id) {
    const glm::uvec3 t = triangles.triangles[id];
    const dvec3 corners[3] = {triangles.positions[t.x], triangles.positions[t.y], triangles.positions[t.z]};
    const PixelBox box = pixels_of(camera, corners);
    for (int y = std::max(box.first_y, first); y < std::min(box.last_y, last); ++y) {
      for (int x = box.first_x; x < box.last_x; ++x) {
        const double depth = meeting(ray_of(camera, x, y), corners);
        const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) +
                           static_cast<std::size_t>(x);
        if (!(depth >= camera.near_t && depth < nearest[pixel])) continue;
        nearest[pixel] = depth;
        ids[pixel] = static_cast<std::uint32_t>(id);
      }
    }
  }
}

}  // namespace

std::vector<std::uint32_t> plainly_seen_triangles(const TriangleView& triangles, const ViewRays& view,
                                                  int width, int height) {
  const PlainCamera camera(view, width, height);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<double> nearest(pixels, infinity);
  std::vector<std::uint32_t> ids(pixels, no_triangle);
  parallel::parallel_ranges(static_cast<std::size_t>(height), 64, [&](std::size_t first, std::size_t last) {
    draw_rows(triangles, camera, static_cast<int>(first), static_cast<int>(last), nearest, ids);
  });
  return ids;
}

}  // namespace tenebra::bench
