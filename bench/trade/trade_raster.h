// What the rasteriser gives the trade of hard shadows: triangle ids and depth of a view, and depth maps
// around a lamp or along the rays of a sun.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "bench/common/bench_frame.h"
#include "raster/gbuffer.h"

namespace tenebra::bench {

/// Distances from a light along the axes of a cube: six square maps; or from a sun along its rays: one.
struct DepthMap {
  int size = 0;
  glm::vec3 light{0.0f};
  std::optional<ViewRays> sun;              ///< that its map was drawn with
  std::array<std::vector<float>, 6> depth;  ///< of a lamp reversed: near_t over the distance; 0: nothing
  float near_t = 0, far_t = 0;

  /// Distance along the axis of face `face` (axis * 2, + 1 for the negative side; 0 of a sun) to what texel
  /// (x, y) sees; infinity: nothing.
  float distance(int face, int x, int y) const;

  /// Where a point lies: its face, the distance along the axis, the place in texels, and how wide one is
  /// there.
  struct Place {
    int face = 0;
    float t = 0, x = 0, y = 0, texel_m = 0;
  };
  Place place_of(const glm::dvec3& point) const;
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
                           DepthMap& out);
  /// The same along the rays of a sun, over the whole scene.
  Expected<void> draw_sun(const FrameGeometry& geometry, glm::vec3 to_light, int size, DepthMap& out);

private:
  Expected<void> upload_casters(const FrameGeometry& geometry);
  Expected<void> draw_face(const ViewRays& view, int face, DepthMap& out);

  struct State;
  explicit TradeRaster(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tenebra::bench
