// --terminator: what it is where it is not given, and what does not go with it.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "options/method_options.h"
#include "options/render_options.h"

namespace tenebra::viewer {
namespace {

struct Parsed {
  RenderOptions options;
  Expected<void> checked;
  render::Terminator terminator() const { return render_settings(options.method, {64, 48}, {}).terminator; }
};

Parsed parsed(const std::string& text) {
  Parsed result;
  CLI::App app;
  add_render_options(app, result.options);
  app.parse("scene.glb " + text);
  settle_render_options(result.options);
  result.checked = check_render_options(result.options);
  return result;
}

TEST(TerminatorOption, IsSmoothButForMasksAndDepths) {
  using render::Terminator;
  EXPECT_EQ(parsed("").terminator(), Terminator::smooth);
  EXPECT_EQ(parsed("--terminator flat").terminator(), Terminator::flat);
  for (const char* mask : {"--mask m.png", "--mask colour:m.png", "--antialias 4 --mask mean:m.png",
                           "--antialias 4 --mask samples:m.png"}) {
    EXPECT_EQ(parsed(mask).terminator(), Terminator::flat) << mask;
    EXPECT_EQ(parsed(std::string(mask) + " --terminator smooth").terminator(), Terminator::smooth) << mask;
  }
  EXPECT_EQ(parsed("--paper samples=depth").terminator(), Terminator::flat);
  EXPECT_EQ(render::RenderSettings{}.terminator, Terminator::flat) << "the library";
}

TEST(TerminatorOption, NeedsExactPointsToBeSmooth) {
  EXPECT_TRUE(parsed("--paper samples=depth --terminator flat").checked);
  const Parsed refused = parsed("--paper samples=depth --terminator smooth");
  ASSERT_FALSE(refused.checked);
  EXPECT_EQ(
      refused.checked.error().message,
      "--paper samples=depth has no exact points, and --terminator smooth needs them; expected samples=ids");
}

}  // namespace
}  // namespace tenebra::viewer
