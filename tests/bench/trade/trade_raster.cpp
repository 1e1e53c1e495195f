#include "bench/trade/trade_raster.h"

#include <limits>

#include "gl/context.h"

namespace tenebra::bench {

struct TradeRaster::State {
  gl::Context context;
  raster::GBufferPass pass;
  raster::GeometryBuffers buffers;
  raster::GBuffer view, face;
  FrameGeometry casters;  // the last frame's, without what casts nothing
};

float CubeMap::distance(int side, int x, int y) const {
  const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  const float z = depth[static_cast<std::size_t>(side)][at];
  return z > 0 ? near_t / z : std::numeric_limits<float>::infinity();
}

CubeFace cube_face(int face) {
  CubeFace result{glm::vec3(0), glm::vec3(0), glm::vec3(0)};
  const int axis = face / 2;
  result.axis[axis] = face % 2 == 0 ? 1.0f : -1.0f;
  result.u[(axis + 1) % 3] = 1;
  result.v[(axis + 2) % 3] = 1;
  return result;
}

TradeRaster::TradeRaster(std::unique_ptr<State> state) : state_(std::move(state)) {}
TradeRaster::TradeRaster(TradeRaster&&) noexcept = default;
TradeRaster& TradeRaster::operator=(TradeRaster&&) noexcept = default;
TradeRaster::~TradeRaster() = default;

Expected<TradeRaster> TradeRaster::create() {
  auto context = gl::Context::create(gl::ContextKind::automatic);
  if (!context) return tl::unexpected(context.error());
  auto pass = raster::GBufferPass::create();
  if (!pass) return tl::unexpected(pass.error());
  return TradeRaster(std::make_unique<State>(State{.context = std::move(*context),
                                                   .pass = std::move(*pass),
                                                   .buffers = {},
                                                   .view = {},
                                                   .face = {},
                                                   .casters = {}}));
}

Expected<void> TradeRaster::draw(const FrameGeometry& geometry, const ViewRays& view, int width, int height,
                                 std::vector<std::uint32_t>& ids, std::vector<float>& depth) {
  State& s = *state_;
  if (auto uploaded = s.buffers.upload(geometry); !uploaded) return uploaded;
  if (auto drawn = s.pass.draw(view, s.buffers, width, height, s.view); !drawn) return drawn;
  raster::read_triangle_ids(s.view, ids);
  raster::read_depth(s.view, depth);
  return {};
}

const visibility::ClipTransform& TradeRaster::transform() const {
  return state_->view.transform;
}

Expected<void> TradeRaster::draw_cube(const FrameGeometry& geometry, glm::vec3 light, float near_m, int size,
                                      CubeMap& out) {
  State& s = *state_;
  s.casters = geometry;
  for (std::size_t i = 0; i < s.casters.triangles.size(); ++i) {
    if (!s.casters.casts_shadow.empty() && s.casters.casts_shadow[i] == 0) s.casters.triangles[i] = {};
  }
  if (auto uploaded = s.buffers.upload(s.casters); !uploaded) return uploaded;
  out.size = size;
  out.light = light;
  for (int face = 0; face < 6; ++face) {
    const CubeFace c = cube_face(face);
    const float step = 2.0f / static_cast<float>(size);
    const ViewRays view{.eye = light,
                        .d0 = c.axis - c.u - c.v,
                        .dx = step * c.u,
                        .dy = step * c.v,
                        .orthographic = false,
                        .near_m = near_m};
    if (auto drawn = s.pass.draw(view, s.buffers, size, size, s.face); !drawn) return drawn;
    raster::read_depth(s.face, out.depth[static_cast<std::size_t>(face)]);
    out.near_t = s.face.transform.near_t;
  }
  return {};
}

}  // namespace tenebra::bench
