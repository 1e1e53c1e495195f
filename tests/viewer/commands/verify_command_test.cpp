// tenebra verify: 0 all masks are right, 1 failed, 2 masks are wrong.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "commands/verify_report.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

TEST(VerifyCommand, FindsTheMasksOfASceneRight) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder, 2);
  for (const std::vector<std::string>& more : {std::vector<std::string>{},
                                               {"--paper", "variant=PreciseSEATP", "--threads", "1"},
                                               {"--paper", "cull=front"}}) {
    std::vector<std::string> arguments{"verify", scene,   "--frames", "0:20:10",
                                       "--size", "80x60", "--report", folder / "report.json",
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = tenebra(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_TRUE(result.output.ends_with("\nwrong: 0\n")) << result.output;
    const auto json = nlohmann::json::parse(read_text(folder / "report.json"));
    EXPECT_EQ(json["frames"], 3);
    EXPECT_EQ(json["masks"].size(), 6u) << "two lights";
    EXPECT_EQ(json["all"]["wrong"], 0);
    EXPECT_GT(json["all"]["samples"], 5000);
    EXPECT_EQ(json["all"]["blocked"] > 0, more.empty() || more[1] != "cull=front")
        << "the blocker's front casts";
  }
}

TEST(VerifyCommand, ChecksDirectionalLightsAndSomeSamplesAlone) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const auto result =
      tenebra({"verify", scene, "--size", "80x60", "--samples", "100", "--add-light",
               "directional direction=-0.2,-1,0.1 intensity=2", "--report", folder / "report.txt"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("masks: 2\nsamples: 200,"), std::string::npos) << result.output;
  EXPECT_EQ(read_text(folder / "report.txt"), result.output);
}

TEST(VerifyCommand, FindsTheFractionsOfLightsWithAnAreaRight) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder, 2);
  const auto result =
      tenebra({"verify", scene, "--shadows", "soft", "--set-light", "0 size=0.5", "--add-light",
               "directional direction=-0.2,-1,0.1 intensity=2", "--sun-size", "5", "--light-size", "0",
               "--size", "80x60", "--samples", "400", "--report", folder / "report.json", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.output.ends_with("\nwrong: 0\n")) << result.output;
  const auto json = nlohmann::json::parse(read_text(folder / "report.json"));
  EXPECT_EQ(json["masks"].size(), 1u) << "the light that is a point";
  ASSERT_EQ(json["fractions"].size(), 2u);
  for (const auto& light : json["fractions"]) {
    EXPECT_EQ(int(light["samples"]) + int(light["skipped"]), 400);
    EXPECT_GT(light["penumbra"], 0);
    EXPECT_LE(light["largest_error"], light["promise"]);
  }
}

TEST(VerifyCommand, SaysWhatItCheckedUntilASignal) {
  const TemporaryFolder folder;
  testing::ProgramResult result;
  for (const int ms : {700, 3000, 10000}) {  // a slow machine still reads the scene after the first
    ChildProgram verify({TENEBRA_PROGRAM, "verify", TENEBRA_SCENES_DIR "/court.glb", "--frames", "all",
                         "--size", "640x480", "--report", folder / "report.txt", "--quiet"});
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    verify.send(SIGINT);
    result = verify.wait(10);
    if (result.errors.find("stopped after") != std::string::npos) break;
  }
  EXPECT_EQ(result.exit_code, 128 + SIGINT) << result.errors;
  EXPECT_NE(result.errors.find("stopped after"), std::string::npos) << result.errors;
  EXPECT_EQ(read_text(folder / "report.txt"), result.output);
}

TEST(VerifyCommand, FailsInOneSentence) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder);
  const std::vector<std::vector<std::string>> uses{{"verify"},
                                                   {"verify", folder / "missing.glb"},
                                                   {"verify", scene, "--samples", "0"},
                                                   {"verify", scene, "--samples", "some"},
                                                   {"verify", scene, "--frames", "5000"},
                                                   {"verify", scene, "--light", "7"},
                                                   {"verify", scene, "--shadows", "none"}};
  for (const auto& use : uses) {
    const auto result = tenebra(use);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  }
}

TEST(VerifyReport, NamesWhatIsWrongAndEndsInItsExitCode) {
  viewer::Verification verification;
  verification.planned_frames = verification.frames = 1;
  verification.masks.push_back({.frame = 7, .light = 1, .width = 100, .check = {}});
  EXPECT_EQ(viewer::exit_code_of(verification), 0);
  verification.masks[0].check.stats.samples = 10;
  verification.masks[0].check.wrong_count = 1;
  verification.masks[0].check.wrong.push_back(
      {.pixel = 321, .triangle = 5, .said = 255, .exact = {.value = 0, .active = true, .blocker = 9}});
  EXPECT_EQ(viewer::exit_code_of(verification), 2);
  const std::string text = viewer::verification_text(verification);
  EXPECT_NE(text.find("wrong: frame 7, light 1, pixel (21, 3), triangle 5: the mask says 255, exact is 0\n"),
            std::string::npos)
      << text;
  EXPECT_TRUE(text.ends_with("wrong: 1\n"));
  const auto json = nlohmann::json::parse(viewer::verification_json(verification));
  EXPECT_EQ(json["masks"][0]["wrong_samples"][0]["blocked_by"], 9);
}

TEST(VerifyReport, NamesFractionsThatAreWrong) {
  viewer::Verification verification;
  verification.planned_frames = verification.frames = 1;
  viewer::CheckedFractions light{.frame = 7, .light = 1, .width = 100, .promise = 1e-6, .check = {}};
  light.check.stats.samples = 10;
  light.check.wrong_count = 1;
  light.check.wrong.push_back({.pixel = 321, .triangle = 5, .said = 0.25, .exact = 0.5});
  verification.fractions.push_back(light);
  EXPECT_EQ(viewer::exit_code_of(verification), 2);
  const std::string text = viewer::verification_text(verification);
  EXPECT_NE(text.find("pixel (21, 3), triangle 5: the fraction is 0.25, exact is 0.5\n"), std::string::npos)
      << text;
  EXPECT_EQ(nlohmann::json::parse(viewer::verification_json(verification))["fractions"][0]["wrong"], 1);
}

TEST(VerifyCommand, KeepsItsSceneAndFailsWhereItChecksNothing) {
  const TemporaryFolder folder;
  const std::string scene = write_moving_scene(folder), before = read_text(scene);
  const auto over = tenebra({"verify", scene, "--time", "0", "--report", scene});
  EXPECT_EQ(over.exit_code, 1);
  EXPECT_TRUE(is_one_sentence(over.errors)) << over.errors;
  EXPECT_EQ(read_text(scene), before);
  const auto nothing = tenebra({"verify", scene, "--time", "0", "--size", "16x12", "--eye", "0,1000,0",
                                "--look-at", "0,2000,0", "--quiet"});
  EXPECT_EQ(nothing.exit_code, 1) << nothing.output;
  EXPECT_NE(nothing.errors.find("no sample"), std::string::npos) << nothing.errors;
}

}  // namespace
}  // namespace tenebra::testing
