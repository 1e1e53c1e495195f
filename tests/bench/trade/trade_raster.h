// What the rasteriser gives the trade of hard shadows: triangle ids and depth of a view, and depth cubes
// around a light.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bench/common/bench_frame.h"
#include "raster/gbuffer.h"

namespace tenebra::bench {

/// Distances from a light along the axes of a cube: six square maps.
struct CubeMap {
  int size = 0;
  glm::vec3 light{0.0f};
  std::array<std::vector<float>, 6> depth;  ///< reversed: near_t over the distance along the axis; 0: nothing
  float near_t = 0;

  /// Distance along the axis of face `face` (axis * 2, + 1 for the negative side) to what texel (x, y) sees;
  /// infinity: nothing.
  float distance(int face, int x, int y) const;
};

/// The axes of a face: u and v run along x and y of its texels.
struct CubeFace {
  glm::vec3 axis, u, v;
};
CubeFace cube_face(int face);

/// An OpenGL context with the passes of the product.
class TradeRaster {
public:
  static Expected<TradeRaster> create();
  TradeRaster(TradeRaster&&) noexcept;
  TradeRaster& operator=(TradeRaster&&) noexcept;
  ~TradeRaster();

  /// Ids and depth of `view`; what point_from_depth needs is kept in transform().
  Expected<void> draw(const FrameGeometry& geometry, const ViewRays& view, int width, int height,
                      std::vector<std::uint32_t>& ids, std::vector<float>& depth);
  const visibility::ClipTransform& transform() const;

  /// Only casters, two-sided, from `near_m` on.
  Expected<void> draw_cube(const FrameGeometry& geometry, glm::vec3 light, float near_m, int size,
                           CubeMap& out);

private:
  struct State;
  explicit TradeRaster(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::bench
