// The state of a context that others draw in is theirs again after we have drawn.
#include "gl/kept_state.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include <vector>

#include "gl/context.h"

namespace tenebra::gl {
namespace {

constexpr std::array watched{GL_BLEND,
                             GL_CULL_FACE,
                             GL_DEPTH_TEST,
                             GL_SCISSOR_TEST,
                             GL_STENCIL_TEST,
                             GL_MULTISAMPLE,
                             GL_DITHER,
                             GL_FRAMEBUFFER_SRGB,
                             GL_RASTERIZER_DISCARD,
                             GL_POLYGON_OFFSET_FILL,
                             GL_DEPTH_CLAMP,
                             GL_PRIMITIVE_RESTART,
                             GL_CLIP_DISTANCE3,
                             GL_DEPTH_FUNC,
                             GL_DEPTH_WRITEMASK,
                             GL_CLIP_ORIGIN,
                             GL_CLIP_DEPTH_MODE,
                             GL_POLYGON_MODE,
                             GL_DRAW_FRAMEBUFFER_BINDING,
                             GL_VERTEX_ARRAY_BINDING,
                             GL_PIXEL_PACK_BUFFER_BINDING,
                             GL_PACK_ALIGNMENT,
                             GL_PACK_ROW_LENGTH,
                             GL_PACK_SKIP_ROWS};

std::vector<double> state() {
  std::vector<double> all;
  for (const GLenum name : watched) {
    std::array<GLint, 4> values{};
    glGetIntegerv(name, values.data());
    all.push_back(values[0]);
  }
  for (const GLuint i : {0u, 1u}) {
    std::array<float, 4> viewport{};
    std::array<double, 2> depths{};
    std::array<GLboolean, 4> mask{};
    glGetFloati_v(GL_VIEWPORT, i, viewport.data());
    glGetDoublei_v(GL_DEPTH_RANGE, i, depths.data());
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, mask.data());
    all.insert(all.end(), viewport.begin(), viewport.end());
    all.insert(all.end(), depths.begin(), depths.end());
    all.insert(all.end(), mask.begin(), mask.end());
    all.push_back(glIsEnabledi(GL_BLEND, i));
    all.push_back(glIsEnabledi(GL_SCISSOR_TEST, i));
  }
  return all;
}

/// Settings of a host that would spoil any drawing of ours.
void set_as_a_host() {
  for (const GLenum name : {GL_CULL_FACE, GL_STENCIL_TEST, GL_RASTERIZER_DISCARD, GL_POLYGON_OFFSET_FILL,
                            GL_DEPTH_CLAMP, GL_PRIMITIVE_RESTART, GL_CLIP_DISTANCE3, GL_FRAMEBUFFER_SRGB})
    glEnable(name);
  glEnablei(GL_BLEND, 1);
  glEnablei(GL_SCISSOR_TEST, 1);
  glColorMaski(1, GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
  glViewportIndexedf(1, 3, 4, 50, 60);
  glDepthRangeIndexed(1, 0.25, 0.5);
  glDepthFunc(GL_NOTEQUAL);
  glDepthMask(GL_FALSE);
  glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  GLuint framebuffer = 0, vertices = 0, buffer = 0;
  glCreateFramebuffers(1, &framebuffer);
  glCreateVertexArrays(1, &vertices);
  glCreateBuffers(1, &buffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  glBindVertexArray(vertices);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 8);
  glPixelStorei(GL_PACK_ROW_LENGTH, 17);
  glPixelStorei(GL_PACK_SKIP_ROWS, 2);
}

TEST(KeptState, IsAsFoundAfterwardsAndInitialBetween) {
  auto context = Context::create(ContextKind::automatic);
  ASSERT_TRUE(context) << context.error().message;
  set_as_a_host();
  const auto found = state();
  {
    const KeptState kept;
    for (const GLenum off : {GL_RASTERIZER_DISCARD, GL_PRIMITIVE_RESTART, GL_CLIP_DISTANCE3, GL_DEPTH_CLAMP})
      EXPECT_EQ(glIsEnabled(off), GL_FALSE) << off;
    GLint bound = -1;
    glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &bound);
    EXPECT_EQ(bound, 0);
    glDisable(GL_BLEND);  // as passes do
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glViewport(0, 0, 7, 9);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    EXPECT_NE(state(), found);
  }
  EXPECT_EQ(state(), found);
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

}  // namespace
}  // namespace tenebra::gl
