// A host's textures, read in its context: their contents, refusals, and that nothing of the host's changes.
#include <glad/gl.h>
#include <tenebra/host_frame.h>

#include <gtest/gtest.h>

#include <array>

#include "gl/context.h"

namespace tenebra {
namespace {

GLuint texture_of(GLenum format, int width, int height) {
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, format, width, height);
  return texture;
}

class HostContextTest : public ::testing::Test {
protected:
  void SetUp() override {
    auto made = gl::Context::create(gl::ContextKind::automatic);
    ASSERT_TRUE(made) << made.error().message;
    context_.emplace(std::move(*made));
    auto adopted = HostContext::adopt(context_->function_loader());
    ASSERT_TRUE(adopted) << adopted.error().message;
    host_.emplace(std::move(*adopted));
  }
  std::string refusal(const HostTextures& textures) const {
    HostFrame frame;
    const auto read = host_->read(textures, {}, frame);
    return read ? "" : read.error().message;
  }

  std::optional<gl::Context> context_;
  std::optional<HostContext> host_;
};

constexpr std::array packing{GL_PACK_SWAP_BYTES,  GL_PACK_ROW_LENGTH,  GL_PACK_SKIP_ROWS,
                             GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_IMAGES, GL_PACK_ALIGNMENT};

TEST_F(HostContextTest, ReadsTexturesAndLeavesTheHostsStateAsFound) {
  const GLuint ids = texture_of(GL_R32UI, 3, 2), depth = texture_of(GL_DEPTH_COMPONENT32F, 3, 2);
  const std::array<GLuint, 6> id_values{0, 1, 2, 3, 4, 0xffffffffu};
  const std::array<float, 6> depth_values{0, 0.125f, 0.25f, 0.5f, 0.75f, 1};
  glTextureSubImage2D(ids, 0, 0, 0, 3, 2, GL_RED_INTEGER, GL_UNSIGNED_INT, id_values.data());
  glTextureSubImage2D(depth, 0, 0, 0, 3, 2, GL_DEPTH_COMPONENT, GL_FLOAT, depth_values.data());
  GLuint buffer = 0;
  glCreateBuffers(1, &buffer);
  glNamedBufferData(buffer, 4096, nullptr, GL_STREAM_READ);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer);
  const std::array<GLint, packing.size()> found{1, 7, 2, 1, 3, 8};
  for (std::size_t i = 0; i < packing.size(); ++i) glPixelStorei(packing[i], found[i]);
  glEnable(0);  // an error of the host's

  HostFrame frame;
  const auto read = host_->read({ids, depth}, {}, frame);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(frame.width, 3);
  EXPECT_EQ(frame.height, 2);
  EXPECT_EQ(frame.ids, (std::vector<std::uint32_t>{3, 4, no_triangle, 0, 1, 2}));
  EXPECT_EQ(frame.depth, (std::vector<float>{0.5f, 0.75f, 1, 0, 0.125f, 0.25f}));
  EXPECT_EQ(glGetError(), GLenum{GL_INVALID_ENUM});
  GLint bound = 0;
  glGetIntegerv(GL_PIXEL_PACK_BUFFER_BINDING, &bound);
  EXPECT_EQ(static_cast<GLuint>(bound), buffer);
  for (std::size_t i = 0; i < packing.size(); ++i) {
    GLint value = 0;
    glGetIntegerv(packing[i], &value);
    EXPECT_EQ(value, found[i]) << i;
  }
}

TEST_F(HostContextTest, RefusesOtherTexturesWithASentenceAndWithoutAnError) {
  const GLuint ids = texture_of(GL_R32UI, 3, 2), larger = texture_of(GL_DEPTH_COMPONENT24, 4, 2);
  GLuint cube = 0;
  glCreateTextures(GL_TEXTURE_CUBE_MAP, 1, &cube);
  EXPECT_EQ(refusal({999}), "host's texture of ids: found the name 999, which is no texture");
  EXPECT_EQ(refusal({cube}), "host's texture of ids: found the target 0x8513, expected GL_TEXTURE_2D");
  EXPECT_EQ(refusal({texture_of(GL_R16UI, 3, 2)}),
            "host's texture of ids: found the format 0x8234, expected GL_R32UI");
  EXPECT_EQ(refusal({ids, larger}), "host's texture of depth: found size 4x2, expected that of the ids, 3x2");
  EXPECT_EQ(refusal({ids, texture_of(GL_RGBA8, 3, 2)}),
            "host's texture of depth: found the format 0x8058, expected a depth format or GL_R32F");
  EXPECT_EQ(refusal({ids, texture_of(GL_R32F, 3, 2)}), "");
  EXPECT_EQ(refusal({ids, texture_of(GL_DEPTH24_STENCIL8, 3, 2)}), "");
  EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_F(HostContextTest, RefusesALoaderWithoutFunctions) {
  const auto refused = HostContext::adopt([](const char*) -> GlFunction { return nullptr; });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "host's context: found no OpenGL functions");
}

}  // namespace
}  // namespace tenebra
