// Scenes in map coordinates: pictures and masks are those of the same scene at the origin, positions that go
// in and out are the file's, and verify sees it where digits are lost.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using Json = nlohmann::json;

/// The moving scene under a root at (far, 0, -2 far).
std::string write_far_scene(const TemporaryFolder& folder, double far) {
  Json file = Json::parse(read_text(write_moving_scene(folder)));
  const Json roots = file["scenes"][0]["nodes"];
  file["scenes"][0]["nodes"] = {file["nodes"].size()};
  file["nodes"].push_back({{"children", roots}, {"translation", {far, 0, -2 * far}}});
  const std::string path = folder / (std::to_string(static_cast<int>(far)) + ".gltf");
  write_text(path, file.dump());
  return path;
}

/// The bytes of a picture.
std::string rendered(const TemporaryFolder& folder, const std::string& scene,
                     const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"render", scene,    "-o",    folder / "p.png", "--frames",
                                     "0",      "--size", "80x60", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto result = tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  return read_text(folder / "p.png");
}

TEST(FarScene, LooksAsItDoesAtTheOrigin) {
  const TemporaryFolder folder;
  const std::string near = write_far_scene(folder, 0), far = write_far_scene(folder, 10'000'000);
  EXPECT_EQ(rendered(folder, near), rendered(folder, far));
  EXPECT_EQ(rendered(folder, near,
                     {"--eye", "1,2,5", "--look-at", "0,0,0", "--add-light", "point position=0.5,2,0"}),
            rendered(folder, far,
                     {"--eye", "10000001,2,-19999995", "--look-at", "10000000,0,-20000000", "--add-light",
                      "point position=10000000.5,2,-20000000"}));
  EXPECT_NE(rendered(folder, near), rendered(folder, far, {"--offset", "none"}));
}

TEST(FarScene, VerifySeesThatDigitsAreLost) {
  const TemporaryFolder folder;
  const std::string far = write_far_scene(folder, 10'000'000);
  const auto right = tenebra({"verify", far, "--size", "80x60", "--quiet"});
  EXPECT_EQ(right.exit_code, 0) << right.output;
  const auto wrong = tenebra({"verify", far, "--size", "80x60", "--quiet", "--offset", "none"});
  EXPECT_EQ(wrong.exit_code, 2) << wrong.output;
  EXPECT_NE(wrong.output.find("compared with the file's own numbers"), std::string::npos) << wrong.output;
}

TEST(FarScene, InfoSpeaksOfTheFilesCoordinates) {
  const TemporaryFolder folder;
  const std::string far = write_far_scene(folder, 1'000'000);
  const auto info = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"info", far, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Json::parse(tenebra(arguments).output);
  };
  const Json found = info({});
  EXPECT_EQ(found["coordinates"]["offset"], Json({1e6, 0.0, -2e6}));
  EXPECT_EQ(found["coordinates"]["up"], "y");
  EXPECT_EQ(found["coordinates"]["assumed"], Json({"offset"}));
  EXPECT_EQ(found["bounds_m"]["low"], Json({999996.0, 0.0, -2000004.0}));
  EXPECT_EQ(found["lights"][0]["position_m"], Json({1e6, 3.0, -2e6}));
  EXPECT_EQ(found["warnings"].size(), 0u);
  const Json rounded = info({"--offset", "none"});
  EXPECT_EQ(rounded["warnings"].size(), 1u) << "the tolerance of shadows";
  const Json turned = info({"--up-axis", "z", "--unit", "cm"});
  EXPECT_EQ(turned["coordinates"]["up"], "z");
  EXPECT_NEAR(turned["bounds_m"]["low"][0], 9999.96, 1e-6);
  EXPECT_NEAR(turned["bounds_m"]["high"][2], -19999.96, 1e-6);
  EXPECT_NE(tenebra({"info", far}).output.find("offset (1000000, 0, -2000000)"), std::string::npos);
}

}  // namespace
}  // namespace tenebra::testing
