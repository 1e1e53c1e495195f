#include "raster/passes.h"

#include <glad/gl.h>

namespace tenebra::raster {

void begin_pass(const gl::Framebuffer& target, const gl::Program& program, int width, int height) {
  for (GLenum state :
       {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_MULTISAMPLE, GL_DITHER,
        GL_FRAMEBUFFER_SRGB, GL_COLOR_LOGIC_OP, GL_RASTERIZER_DISCARD}) {
    glDisable(state);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);  // clearing obeys it too
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.name());
  glViewport(0, 0, width, height);
  glUseProgram(program.name());
}

void end_pass() {
  glUseProgram(0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  gl::finish();
}

}  // namespace tenebra::raster
