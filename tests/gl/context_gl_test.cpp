// Contexts of both kinds, and what is said where one cannot be had.
#include "gl/context.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>

#include "gl/objects.h"
#include "support/contexts.h"

namespace tenebra::gl {
namespace {

class ContextOfKind : public ::testing::TestWithParam<ContextKind> {
protected:
  void SetUp() override { TENEBRA_NEEDS_CONTEXT(GetParam()); }
};

TEST_P(ContextOfKind, IsCreated) {
  auto context = Context::create(GetParam());
  ASSERT_TRUE(context) << context.error().message;
  EXPECT_EQ(context_choice_from_name(context->kind_name())->kind, GetParam());
  EXPECT_NE(context->description().find("OpenGL 4."), std::string::npos) << context->description();
}

TEST(Context, AutomaticPrefersEgl) {
  auto context = Context::create(ContextKind::automatic);
  ASSERT_TRUE(context) << context.error().message;
  EXPECT_EQ(context->kind_name(), "egl");
}

TEST(Context, KindNamesAreThoseOfTheCommandLine) {
  const auto kind_of = [](const char* name) { return context_choice_from_name(name)->kind; };
  EXPECT_EQ(kind_of("auto"), ContextKind::automatic);
  EXPECT_EQ(kind_of("egl"), ContextKind::egl);
  EXPECT_EQ(kind_of("osmesa"), ContextKind::osmesa);
  EXPECT_EQ(context_choice_from_name("egl")->device, std::nullopt);
  EXPECT_EQ(context_choice_from_name("egl:0")->device, 0);
  EXPECT_EQ(context_choice_from_name("egl:12")->device, 12);
  EXPECT_EQ(kind_of("egl:12"), ContextKind::egl);
  for (const char* bad :
       {"", "EGL", "glx", "egl ", "automatic", "egl:", "egl:-1", "egl:1x", "egl:99999999999", "osmesa:0"})
    EXPECT_FALSE(context_choice_from_name(bad)) << bad;
}

TEST(Context, TakesTurnsWithAnotherKind) {
  TENEBRA_NEEDS_CONTEXT(ContextKind::osmesa);
  auto egl = Context::create(ContextKind::egl);
  auto osmesa = Context::create(ContextKind::osmesa);
  ASSERT_TRUE(egl && osmesa);
  const std::byte sent[4] = {std::byte{1}, std::byte{20}, std::byte{200}, std::byte{255}};
  for (Context* context : {&*egl, &*osmesa, &*egl}) {
    ASSERT_TRUE(context->make_current());
    auto texture = Texture::create(PixelFormat::rgba8, 1, 1);
    ASSERT_TRUE(texture) << texture.error().message;
    texture->upload(sent);
    std::byte received[4] = {};
    texture->read(received);
    EXPECT_TRUE(std::equal(sent, sent + 4, received)) << context->kind_name();
  }
}

/// The functions of the context that is current, but for a version of long ago.
Function load_from_old_driver(const char* name) {
  static FunctionLoader real = nullptr;
  if (!real) real = Context::create(test::any_kind())->function_loader();
  using GetString = const unsigned char* (*)(unsigned);
  const GetString old_version = [](unsigned) { return reinterpret_cast<const unsigned char*>("3.3 (old)"); };
  if (std::string_view(name) == "glGetString") return reinterpret_cast<Function>(old_version);
  return real(name);
}

TEST(Context, BelowFourFiveIsRefusedWithASentence) {
  ASSERT_NE(load_from_old_driver("glGetError"), nullptr);
  auto window = Context::create(test::any_kind());
  ASSERT_TRUE(window);
  const auto refused = Context::adopt(load_from_old_driver);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("found version 3.3, expected 4.5"), std::string::npos)
      << refused.error().message;
}

TEST(Context, FindsFunctionsOnceForAllContextsOfALoader) {
  auto window = Context::create(test::any_kind());
  ASSERT_TRUE(window);
  static FunctionLoader real = nullptr;
  static int asked = 0;
  real = window->function_loader();
  const FunctionLoader counts = [](const char* name) {
    ++asked;
    return real(name);
  };
  ASSERT_TRUE(Context::adopt(counts));
  const int once = asked;
  EXPECT_GT(once, 0);
  auto again = Context::adopt(counts);
  ASSERT_TRUE(again && again->make_current());
  EXPECT_EQ(asked, once) << "a thread that draws would see its functions written";
}

TEST(Context, AdoptsACurrentOneAndLeavesItAlone) {
  auto window = Context::create(test::any_kind());
  ASSERT_TRUE(window);
  const FunctionLoader no_functions = [](const char*) -> Function { return nullptr; };
  const auto refused = Context::adopt(no_functions);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("window"), std::string::npos) << refused.error().message;
  {
    auto adopted = Context::adopt(window->function_loader());
    ASSERT_TRUE(adopted) << adopted.error().message;
    EXPECT_EQ(adopted->kind_name(), "window");
    EXPECT_EQ(adopted->description(), window->description());
  }
  EXPECT_TRUE(Texture::create(PixelFormat::rgba8, 3, 3));
}

TEST_P(ContextOfKind, ReportsErrorsWhenDebuggingAndOnlyThen) {
  for (bool debug : {true, false}) {
    auto context = Context::create(GetParam(), {.debug = debug});
    ASSERT_TRUE(context);
    EXPECT_TRUE(context->take_debug_messages().empty());
    EXPECT_FALSE(Texture::create(PixelFormat::rgba8, 1 << 30, 1));
    EXPECT_EQ(!context->take_debug_messages().empty(), debug);
    EXPECT_TRUE(context->take_debug_messages().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(, ContextOfKind, ::testing::Values(ContextKind::egl, ContextKind::osmesa),
                         [](const auto& kind) { return kind.param == ContextKind::egl ? "egl" : "osmesa"; });

}  // namespace
}  // namespace tenebra::gl
