// --memory: a window within a bound. What needs more is refused, and the window goes on; or the program ends
// in a sentence.
#include "window_steps.h"

namespace tenebra::testing {
namespace {

class ViewMemory : public WindowTest {
protected:
  void SetUp() override {
    // A sanitizer reserves terabytes of addresses before main().
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers need more memory than these tests leave";
#endif
    WindowTest::SetUp();
  }
};

TEST_F(ViewMemory, RefusesAPictureThatNeedsMoreAndGoesOn) {
  const ViewSession session(display(), folder_,
                            {write_moving_scene(folder_), "--size", "8000x8000", "--memory", "400",
                             "--preview-budget", "0", "--raster", "cpu"});
  const Json refused = session.wait_for_event(0, "failure");
  EXPECT_EQ(refused.value("text", ""), "not enough memory, 400 MB are allowed; expected a larger --memory");
  display().run(
      {"xdotool", "search", "--sync", "--onlyvisible", "--name", "Tenebra"});  // it comes without a picture
  session.expect_state("playing", true, [&] { session.key("space"); });
  session.key("ctrl+q");
  EXPECT_EQ(session.wait().exit_code, 0);
}

// Mesa, LLVM and Dear ImGui do not ask whether they got memory: 60 MB ended in an assertion of the latter, 90
// in a null pointer, 160 in LLVM's abort (Debian 12).
TEST_F(ViewMemory, EndsInASentenceWhereTheWindowItselfHasNoRoom) {
  const std::string scene = write_moving_scene(folder_);
  for (const char* memory_mb : {"60", "90"}) {
    const auto result = run_program({"/usr/bin/timeout", "5", TENEBRA_PROGRAM, "view", scene, "--settings",
                                     "none", "--exit-after", "1", "--memory", memory_mb},
                                    [&] { display().enter(); });
    if (result.exit_code == 124) continue;  // there is room for all but pictures
    if (result.exit_code == 0) continue;    // there is room after all
    EXPECT_EQ(result.exit_code, 1) << memory_mb << ": " << result.errors;
    EXPECT_NE(result.errors.find("tenebra: "), std::string::npos) << memory_mb << ": " << result.errors;
  }
}

}  // namespace
}  // namespace tenebra::testing
