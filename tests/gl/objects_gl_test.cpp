// OpenGL objects: owned once, and shaders that do not build say why.
#include "gl/objects.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "gl/context.h"
#include "support/contexts.h"

namespace tenebra::gl {
namespace {

class Objects : public ::testing::TestWithParam<ContextKind> {
protected:
  void SetUp() override {
    TENEBRA_NEEDS_CONTEXT(GetParam());
    auto created = Context::create(GetParam(), {.debug = true});
    ASSERT_TRUE(created) << created.error().message;
    context_.emplace(std::move(*created));
  }
  std::vector<std::string> complaints() { return context_->take_debug_messages(); }

private:
  std::optional<Context> context_;
};

constexpr std::string_view good_vertex = "void main() { gl_Position = vec4(0.0); }\n";

TEST_P(Objects, MoveLeavesOneOwner) {
  Buffer first = Buffer::create();
  const unsigned name = first.name();
  Buffer second = std::move(first);
  EXPECT_EQ(first.name(), 0u);
  EXPECT_EQ(second.name(), name);
  first = std::move(second);
  EXPECT_EQ(first.name(), name);
}

TEST_P(Objects, TexturesGiveBackTheBitsOfEveryFormat) {
  for (PixelFormat format : {PixelFormat::depth32f, PixelFormat::r32ui, PixelFormat::r8, PixelFormat::r32f,
                             PixelFormat::rgba8, PixelFormat::rgba32f}) {
    auto texture = Texture::create(format, 3, 5);  // 3 bytes per row: rows are not padded
    ASSERT_TRUE(texture) << texture.error().message;
    std::vector<std::byte> sent(15 * bytes_per_pixel(format)), received(sent.size());
    for (std::size_t i = 0; i + 3 < sent.size(); i += 4) {
      const float value = static_cast<float>(i) / 256.0f;
      std::memcpy(&sent[i], &value, sizeof value);
    }
    texture->upload(sent);
    texture->read(received);
    EXPECT_EQ(sent, received);
  }
  EXPECT_TRUE(complaints().empty());
}

TEST_P(Objects, ReadbacksGiveWhatTheTextureHeldWhenTheyBegan) {
  Readback readback;
  for (const auto& [width, height] : {std::pair{3, 5}, std::pair{64, 33}, std::pair{64, 33}}) {
    auto texture = Texture::create(PixelFormat::r32ui, width, height);
    ASSERT_TRUE(texture) << texture.error().message;
    std::vector<std::uint32_t> sent(static_cast<std::size_t>(width * height)), later(sent.size(), 7),
        received(sent.size());
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint32_t>(i * 2654435761u);
    texture->upload(std::as_bytes(std::span(sent)));
    ASSERT_TRUE(readback.start(*texture));
    texture->upload(std::as_bytes(std::span(later)));
    ASSERT_TRUE(readback.finish(std::as_writable_bytes(std::span(received))));
    EXPECT_EQ(sent, received);
  }
  EXPECT_TRUE(complaints().empty());
}

TEST_P(Objects, ShadersThatDoNotCompileNameThemselvesTheStageAndTheLog) {
  const auto broken = Program::build("sunset", {good_vertex}, {"void main() { unheard_of = 1.0; }\n"});
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find("sunset.frag"), std::string::npos) << broken.error().message;
  EXPECT_NE(broken.error().message.find("unheard_of"), std::string::npos) << broken.error().message;
  EXPECT_EQ(broken.error().message.find('\n'), std::string::npos);
}

TEST_P(Objects, ShadersThatDoNotLinkNameThemselves) {
  const auto broken =
      Program::build("sunset", {good_vertex},
                     {"in vec3 v_missing; out vec4 o_color; void main() { o_color = v_missing.xyzz; }\n"});
  ASSERT_FALSE(broken);
  EXPECT_NE(broken.error().message.find("sunset"), std::string::npos) << broken.error().message;
}

TEST_P(Objects, PiecesOfAShaderAreJoined) {
  const auto program = Program::build("joined", {good_vertex},
                                      {"vec4 white() { return vec4(1.0); }\n", "out vec4 o_color;\n",
                                       "void main() { o_color = white(); }\n"});
  EXPECT_TRUE(program) << program.error().message;
  EXPECT_TRUE(complaints().empty());
}

TEST_P(Objects, FramebuffersThatCannotBeDrawnToAreRefused) {
  auto color = Texture::create(PixelFormat::rgba8, 4, 4);
  ASSERT_TRUE(color);
  EXPECT_TRUE(Framebuffer::create({&*color}));
  EXPECT_FALSE(Framebuffer::create({&*color}, &*color));  // colour in the place of depth
}

INSTANTIATE_TEST_SUITE_P(, Objects, ::testing::Values(ContextKind::egl, ContextKind::osmesa),
                         [](const auto& kind) { return kind.param == ContextKind::egl ? "egl" : "osmesa"; });

}  // namespace
}  // namespace tenebra::gl
