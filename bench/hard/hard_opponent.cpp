#include "bench/hard/hard_opponent.h"

#include <algorithm>

#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

/// Planes of the triangles that pixels nearby see.
class PlaneCache {
public:
  PlaneCache(const TriangleView& triangles, const glm::vec3& eye) : triangles_(triangles), eye_(eye) {}

  void fill(const std::uint32_t ids[16], TilePlanes& planes) {
    std::uint32_t different = 0;
    for (int i = 1; i < 16; ++i) different |= ids[i] ^ ids[0];
    if (different == 0) return spread(of(ids[0]), planes);
    for (int i = 0; i < 16; ++i) {
      const Plane& plane = of(ids[i]);
      planes.nx[i] = plane.n.x, planes.ny[i] = plane.n.y, planes.nz[i] = plane.n.z, planes.d[i] = plane.d;
    }
  }

private:
  struct Plane {
    std::uint32_t id = no_triangle;
    glm::vec3 n{0.0f};
    float d = 0;
  };

  static void spread(const Plane& plane, TilePlanes& planes) {
    std::fill_n(planes.nx, 16, plane.n.x), std::fill_n(planes.ny, 16, plane.n.y);
    std::fill_n(planes.nz, 16, plane.n.z), std::fill_n(planes.d, 16, plane.d);
  }
  const Plane& of(std::uint32_t id) {
    static constexpr Plane none;
    if (id == no_triangle) return none;
    Plane& plane = known_[id % known_.size()];
    if (plane.id == id) return plane;
    const glm::uvec3 t = triangles_.triangles[id];
    const glm::vec3 a = triangles_.positions[t.x];
    plane.id = id;
    plane.n = glm::cross(triangles_.positions[t.y] - a, triangles_.positions[t.z] - a);
    plane.d = glm::dot(plane.n, a - eye_);
    return plane;
  }

  const TriangleView& triangles_;
  const glm::vec3 eye_;
  std::array<Plane, 1024> known_{};
};

/// Squares of one row.
void trace_row(const MaskTask& task, const TileGrid& grid, int row, std::span<const LightAim> lights,
               PacketTracer& tracer, std::span<ShadowMask> masks) {
  PlaneCache cache(task.triangles, task.view.eye);
  TilePlanes planes[16];
  TilePoints points[16];
  for (int column = 0; column < grid.square_columns(); ++column) {
    for (int tile = 0; tile < 16; ++tile) {
      const glm::ivec2 at = grid.first({column, row}, tile);
      std::uint32_t ids[16];
      grid.take(task.ids.data(), at, ids);
      cache.fill(ids, planes[tile]);
      tracer.place(task.view, static_cast<float>(at.x), static_cast<float>(at.y), planes[tile], points[tile]);
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
      for (int tile = 0; tile < 16; ++tile)
        grid.put_bits(tracer.lit(planes[tile], points[tile], lights[i]), grid.first({column, row}, tile),
                      masks[i].data());
    }
  }
}

}  // namespace

void trace_masks(const MaskTask& task, const EmbreeTree& tree, const PacketPlan& plan,
                 std::span<ShadowMask> masks) {
  const TileGrid grid(task.width, task.height, plan.shape);
  std::vector<LightAim> lights;
  for (const ShadowLight& light : task.lights)
    lights.push_back(aim_at(light, task.view.eye, plan.way, task.wide_m));
  for (ShadowMask& mask : masks) mask.resize(task.ids.size());
  parallel::parallel_tasks(grid.square_rows(), [&](int row) {
    PacketTracer tracer(tree, plan, task.simd);
    trace_row(task, grid, row, lights, tracer, masks);
  });
}

}  // namespace tenebra::bench
