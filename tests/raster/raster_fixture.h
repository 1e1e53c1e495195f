// Every raster pass on both kinds of context, and a debug context that must stay silent.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "gl/context.h"
#include "raster/gbuffer.h"
#include "raster/geometry_buffers.h"
#include "support/contexts.h"
#include "support/hand_made.h"

namespace tenebra {

class RasterTest : public ::testing::TestWithParam<gl::ContextKind> {
protected:
  void SetUp() override {
    TENEBRA_NEEDS_CONTEXT(GetParam());
    auto created = gl::Context::create(GetParam(), {.debug = true});
    ASSERT_TRUE(created) << created.error().message;
    context_.emplace(std::move(*created));
    auto gbuffer_pass = raster::GBufferPass::create();
    ASSERT_TRUE(gbuffer_pass) << gbuffer_pass.error().message;
    passes_.emplace(Passes{std::move(*gbuffer_pass), {}, {}});
  }
  void TearDown() override {
    passes_.reset();
    if (!context_) return;
    for (const std::string& complaint : context_->take_debug_messages()) ADD_FAILURE() << complaint;
  }

  struct Passes {
    raster::GBufferPass gbuffer_pass;
    raster::GeometryBuffers geometry;
    raster::GBuffer gbuffer;
  };
  Passes& passes() { return *passes_; }
  gl::Context& context() { return *context_; }

  /// Draws the G-buffer of `frame` and reads its ids and depths.
  void draw(const FrameGeometry& frame, const ViewRays& view, int width, int height) {
    ASSERT_TRUE(passes().geometry.upload(frame));
    const auto drawn = passes().gbuffer_pass.draw(view, passes().geometry, width, height, passes().gbuffer);
    ASSERT_TRUE(drawn) << drawn.error().message;
    raster::read_triangle_ids(passes().gbuffer, ids);
    raster::read_depth(passes().gbuffer, depth);
  }

  std::vector<std::uint32_t> ids;
  std::vector<float> depth;

private:
  std::optional<gl::Context> context_;
  std::optional<Passes> passes_;
};

#define TENEBRA_BOTH_CONTEXTS(suite)                                             \
  INSTANTIATE_TEST_SUITE_P(                                                      \
      , suite, ::testing::Values(gl::ContextKind::egl, gl::ContextKind::osmesa), \
      [](const auto& kind) { return kind.param == gl::ContextKind::egl ? "egl" : "osmesa"; })

}  // namespace tenebra
