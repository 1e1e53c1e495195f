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
  const auto lit_towards = [&](const std::string& scene, const std::string& place) {
    return rendered(folder, scene,
                    {"--shadows", "soft", "--light-size", "2", "--light-size", "facing=" + place,
                     "--light-size", "emission=lambert", "--antialias", "1"});
  };
  EXPECT_EQ(lit_towards(near, "3.25,1.5,2"), lit_towards(far, "10000003.25,1.5,-19999998"));
  EXPECT_NE(lit_towards(near, "3.25,1.5,2"), lit_towards(near, "0,0,0"));
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

/// A box of 10.3 x 3.1 x 8.2 m on a floor, at a place of a map.
std::string write_house(const TemporaryFolder& folder, double east, double north) {
  std::string text;
  const auto corner = [&](double x, double y, double z) {
    text +=
        "v " + std::to_string(east + x) + " " + std::to_string(y) + " " + std::to_string(north + z) + "\n";
  };
  for (const double x : {-20.0, 25.0}) corner(x, 0, -20), corner(x, 0, 25);
  for (const double y : {0.0, 3.1})
    for (const double x : {0.0, 10.3}) corner(x, y, 0), corner(x, y, 8.2);
  text += "f 1 2 4 3\nf 9 10 12 11\nf 5 9 11 7\nf 6 8 12 10\nf 5 6 10 9\nf 7 11 12 8\n";
  write_text(folder / "house.obj", text);
  return folder / "house.obj";
}

TEST(FarScene, AHouseOnAMapKeepsItsMillimetres) {
  const TemporaryFolder folder;
  const std::string house = write_house(folder, 691234.127, -5334567.381);
  const Json bounds = Json::parse(tenebra({"info", house, "--json"}).output)["bounds_m"];
  EXPECT_NEAR(bounds["low"][0], 691214.127, 1e-5);
  EXPECT_NEAR(bounds["low"][2], -5334587.381, 1e-5);
  EXPECT_EQ(tenebra({"verify", house, "--size", "80x60", "--quiet"}).exit_code, 0);
  const auto wrong = tenebra({"verify", house, "--size", "80x60", "--quiet", "--offset", "none"});
  EXPECT_EQ(wrong.exit_code, 2) << wrong.output;
}

}  // namespace
}  // namespace tenebra::testing
