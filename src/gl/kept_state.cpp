#include "gl/kept_state.h"

#include <glad/gl.h>

namespace tenebra::gl {
namespace {

/// Off while passes draw. Blending and scissors are kept for each buffer and viewport.
constexpr std::array<GLenum, 26> switches{GL_CULL_FACE,
                                          GL_DEPTH_TEST,
                                          GL_STENCIL_TEST,
                                          GL_MULTISAMPLE,
                                          GL_DITHER,
                                          GL_FRAMEBUFFER_SRGB,
                                          GL_COLOR_LOGIC_OP,
                                          GL_RASTERIZER_DISCARD,
                                          GL_POLYGON_OFFSET_FILL,
                                          GL_POLYGON_OFFSET_LINE,
                                          GL_POLYGON_OFFSET_POINT,
                                          GL_DEPTH_CLAMP,
                                          GL_PRIMITIVE_RESTART,
                                          GL_PRIMITIVE_RESTART_FIXED_INDEX,
                                          GL_SAMPLE_MASK,
                                          GL_SAMPLE_COVERAGE,
                                          GL_SAMPLE_SHADING,
                                          GL_SAMPLE_ALPHA_TO_COVERAGE,
                                          GL_CLIP_DISTANCE0,
                                          GL_CLIP_DISTANCE1,
                                          GL_CLIP_DISTANCE2,
                                          GL_CLIP_DISTANCE3,
                                          GL_CLIP_DISTANCE4,
                                          GL_CLIP_DISTANCE5,
                                          GL_CLIP_DISTANCE6,
                                          GL_CLIP_DISTANCE7};
constexpr std::array<GLenum, 8> packing{GL_PACK_SWAP_BYTES,   GL_PACK_LSB_FIRST, GL_PACK_ROW_LENGTH,
                                        GL_PACK_IMAGE_HEIGHT, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS,
                                        GL_PACK_SKIP_IMAGES,  GL_PACK_ALIGNMENT};
constexpr std::array<GLenum, 4> bindings{GL_DRAW_FRAMEBUFFER_BINDING, GL_CURRENT_PROGRAM,
                                         GL_VERTEX_ARRAY_BINDING, GL_PIXEL_PACK_BUFFER_BINDING};

std::size_t count_of(GLenum limit) {
  GLint count = 0;
  glGetIntegerv(limit, &count);
  return static_cast<std::size_t>(count);
}

void set_switch(GLenum name, unsigned char on) {
  on ? glEnable(name) : glDisable(name);
}
void set_switch(GLenum name, GLuint index, unsigned char on) {
  on ? glEnablei(name, index) : glDisablei(name, index);
}

}  // namespace

KeptState::KeptState()
    : blends_(count_of(GL_MAX_DRAW_BUFFERS)),
      color_masks_(4 * blends_.size()),
      scissors_(count_of(GL_MAX_VIEWPORTS)),
      viewports_(4 * scissors_.size()),
      depth_ranges_(2 * scissors_.size()) {
  static_assert(switches.size() == switch_count && packing.size() == packing_count &&
                bindings.size() == binding_count);
  for (std::size_t i = 0; i < switches.size(); ++i) {
    switches_[i] = glIsEnabled(switches[i]);
    glDisable(switches[i]);
  }
  for (GLuint i = 0; i < blends_.size(); ++i) {
    blends_[i] = glIsEnabledi(GL_BLEND, i);
    glGetBooleani_v(GL_COLOR_WRITEMASK, i, &color_masks_[4 * std::size_t{i}]);
  }
  for (GLuint i = 0; i < scissors_.size(); ++i) {
    scissors_[i] = glIsEnabledi(GL_SCISSOR_TEST, i);
    glGetFloati_v(GL_VIEWPORT, i, &viewports_[4 * std::size_t{i}]);
    glGetDoublei_v(GL_DEPTH_RANGE, i, &depth_ranges_[2 * std::size_t{i}]);
  }
  std::array<GLint, 2> polygon_mode{};  // drivers of compatibility contexts give two
  glGetIntegerv(GL_POLYGON_MODE, polygon_mode.data());
  values_[0] = polygon_mode[0];
  glGetIntegerv(GL_DEPTH_FUNC, &values_[1]);
  glGetIntegerv(GL_CLIP_ORIGIN, &values_[2]);
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &values_[3]);
  glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
  for (std::size_t i = 0; i < bindings.size(); ++i) glGetIntegerv(bindings[i], &bindings_[i]);
  for (std::size_t i = 0; i < packing.size(); ++i) {
    glGetIntegerv(packing[i], &packing_[i]);
    glPixelStorei(packing[i], packing[i] == GL_PACK_ALIGNMENT ? 4 : 0);
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glDepthRange(0.0, 1.0);
}

KeptState::~KeptState() {
  for (std::size_t i = 0; i < switches.size(); ++i) set_switch(switches[i], switches_[i]);
  for (GLuint i = 0; i < blends_.size(); ++i) {
    const unsigned char* const mask = &color_masks_[4 * std::size_t{i}];
    set_switch(GL_BLEND, i, blends_[i]);
    glColorMaski(i, mask[0], mask[1], mask[2], mask[3]);
  }
  for (GLuint i = 0; i < scissors_.size(); ++i) {
    set_switch(GL_SCISSOR_TEST, i, scissors_[i]);
    glViewportIndexedfv(i, &viewports_[4 * std::size_t{i}]);
    glDepthRangeIndexed(i, depth_ranges_[2 * std::size_t{i}], depth_ranges_[2 * std::size_t{i} + 1]);
  }
  const auto name = [](int value) { return static_cast<GLenum>(value); };
  glPolygonMode(GL_FRONT_AND_BACK, name(values_[0]));
  glDepthFunc(name(values_[1]));
  glClipControl(name(values_[2]), name(values_[3]));
  glDepthMask(depth_mask_);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name(bindings_[0]));
  glUseProgram(name(bindings_[1]));
  glBindVertexArray(name(bindings_[2]));
  glBindBuffer(GL_PIXEL_PACK_BUFFER, name(bindings_[3]));
  for (std::size_t i = 0; i < packing.size(); ++i) glPixelStorei(packing[i], packing_[i]);
}

}  // namespace tenebra::gl
