// What a renderer keeps from frame to frame, and the stages of a frame that work on it. Internal to render.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "raster/composite.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "raster/light_buffer.h"
#include "render/frame_lights.h"
#include "render/light_points.h"
#include "render/renderer.h"

namespace tenebra::render {

struct Renderer::State {
  gl::Context context;
  Scene scene;  // as of without_keyed_vertices
  raster::GeometryBuffers geometry;
  raster::GBufferPass gbuffer_pass;
  raster::LightPass light_pass;
  raster::Compositor compositor;
  raster::GBuffer gbuffer{};
  raster::LightBuffer light_buffer{};

  std::vector<std::uint32_t> ids{};
  std::vector<float> depth{};
  VisiblePoints points{};
  std::vector<glm::vec3> normals{};
  ShadowTracer hard{};
  ShadowMask hard_mask{};
  SoftShadowTracer soft{};
  LightPointShadows light_points{};
  SoftMask soft_mask{};
  std::vector<std::uint8_t> casters{};
  AmbientOcclusion ambient{};
  std::vector<float> openness{};
  std::unordered_set<std::string> said{};  // notes of earlier frames

  /// Visible points and, for what shades on the CPU, their normals.
  void read_samples(const FrameInput& input, const RenderSettings& settings, FrameTimings& timings);
  void points_from_depth(const ViewRays& view);
  Expected<void> occlude_ambient(const FrameInput& input, const RenderSettings& settings, FrameResult& result,
                                 const AoProgress& progress, const StopFlag* stop);
  /// One light as a point, with hard shadows or with none.
  Expected<void> light_hard(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result);
  /// One light as a polygon: the visible part from each point and its irradiance.
  Expected<void> light_soft(const FrameInput& input, const DrawnLight& light, const RenderSettings& settings,
                            FrameResult& result, const StopFlag* stop);
  /// Drops the notes that earlier frames gave.
  void keep_new(std::vector<std::string>& notes);
};

}  // namespace tenebra::render
