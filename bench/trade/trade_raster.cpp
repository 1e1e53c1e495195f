#include "bench/trade/trade_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gl/context.h"
#include "scene/view_basis.h"

namespace tenebra::bench {

struct TradeRaster::State {
  gl::Context context;
  raster::GBufferPass pass;
  raster::GeometryBuffers buffers;
  raster::GBuffer view, face;
  FrameGeometry casters;  // the last frame's, without what casts nothing
};

float DepthMap::distance(int face, int x, int y) const {
  const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
  const float z = depth[static_cast<std::size_t>(face)][at];
  if (!(z > 0)) return std::numeric_limits<float>::infinity();
  return sun ? far_t + z * (near_t - far_t) : near_t / z;
}

DepthMap::Place DepthMap::place_of(const glm::dvec3& point) const {
  if (sun) {
    const glm::vec3 q(point - glm::dvec3(sun->eye));
    const float square = glm::dot(sun->dx, sun->dx);
    return {0, glm::dot(q, sun->d0), glm::dot(q, sun->dx) / square, glm::dot(q, sun->dy) / square,
            std::sqrt(square)};
  }
  const glm::vec3 q(point - glm::dvec3(light)), away = glm::abs(q);
  const int axis = away.x >= away.y && away.x >= away.z ? 0 : away.y >= away.z ? 1 : 2;
  const float t = away[axis], half = 0.5f * static_cast<float>(size);
  return {axis * 2 + (q[axis] < 0 ? 1 : 0), t, (q[(axis + 1) % 3] / t + 1) * half,
          (q[(axis + 2) % 3] / t + 1) * half, t / half};
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

Expected<void> TradeRaster::upload_casters(const FrameGeometry& geometry) {
  State& s = *state_;
  s.casters = geometry;
  for (std::size_t i = 0; i < s.casters.triangles.size(); ++i) {
    if (!s.casters.casts_shadow.empty() && s.casters.casts_shadow[i] == 0) s.casters.triangles[i] = {};
  }
  return s.buffers.upload(s.casters);
}

Expected<void> TradeRaster::draw_face(const ViewRays& view, int face, DepthMap& out) {
  State& s = *state_;
  if (auto drawn = s.pass.draw(view, s.buffers, out.size, out.size, s.face); !drawn) return drawn;
  raster::read_depth(s.face, out.depth[static_cast<std::size_t>(face)]);
  out.near_t = s.face.transform.near_t, out.far_t = s.face.transform.far_t;
  return {};
}

Expected<void> TradeRaster::draw_cube(const FrameGeometry& geometry, glm::vec3 light, float near_m, int size,
                                      DepthMap& out) {
  if (auto uploaded = upload_casters(geometry); !uploaded) return uploaded;
  out.size = size, out.light = light;
  for (int face = 0; face < 6; ++face) {
    const CubeFace c = cube_face(face);
    const float step = 2.0f / static_cast<float>(size);
    const ViewRays view{.eye = light,
                        .d0 = c.axis - c.u - c.v,
                        .dx = step * c.u,
                        .dy = step * c.v,
                        .orthographic = false,
                        .near_m = near_m};
    if (auto drawn = draw_face(view, face, out); !drawn) return drawn;
  }
  return {};
}

Expected<void> TradeRaster::draw_sun(const FrameGeometry& geometry, glm::vec3 to_light, int size,
                                     DepthMap& out) {
  if (auto uploaded = upload_casters(geometry); !uploaded) return uploaded;
  const glm::dmat3 basis = scene::view_basis(-glm::dvec3(to_light), glm::dvec3(0, 1, 0));
  glm::dvec3 least(std::numeric_limits<double>::infinity()), most = -least;
  for (const glm::vec3& p : geometry.positions) {
    const glm::dvec3 q = glm::dvec3(p) * basis;  // along its axes
    least = glm::min(least, q), most = glm::max(most, q);
  }
  // A square around all that is there, with room for rounding; the near plane is before it.
  const double side_m = 1.001 * std::max(most.x - least.x, most.y - least.y), step_m = side_m / size;
  const glm::dvec3 middle = 0.5 * (least + most), ahead = -basis[2];
  const glm::dvec3 across = middle.x * basis[0] + middle.y * basis[1];
  out.size = size;
  out.sun = ViewRays{.eye = across + (-most.z - 0.02 * side_m) * ahead - 0.5 * side_m * (basis[0] + basis[1]),
                     .d0 = ahead,
                     .dx = step_m * basis[0],
                     .dy = step_m * basis[1],
                     .orthographic = true,
                     .near_m = static_cast<float>(0.01 * side_m)};
  return draw_face(*out.sun, 0, out);
}

}  // namespace tenebra::bench
