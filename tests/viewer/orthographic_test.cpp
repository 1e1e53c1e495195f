// An orthographic camera whose near plane is where it stands: what it sees lies in front of it all the same.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

using Json = nlohmann::json;

TEST(Orthographic, NearPlaneAtTheCameraGivesThePictureOfANearOne) {
  const TemporaryFolder folder;
  Json file = Json::parse(read_text(write_moving_scene(folder)));
  const auto drawn = [&](double znear, const std::string& raster) {
    file["cameras"] = {{{"type", "orthographic"},
                        {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", znear}, {"zfar", 100}}}}};
    write_text(folder / "o.gltf", file.dump());
    const auto result =
        tenebra({"render", folder / "o.gltf", "-o", folder / "p.png", "--mask", folder / "m.png", "--frames",
                 "0", "--size", "80x60", "--quiet", "--raster", raster});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return std::pair(read_text(folder / "p.png"), read_text(folder / "m.png"));
  };
  const auto near = drawn(0.1, "cpu");
  EXPECT_EQ(drawn(0, "cpu"), near);
  EXPECT_EQ(drawn(0, "gl"), drawn(0.1, "gl"));
  file["nodes"][2]["translation"] = {0, 20, 6};  // above and looking past everything: another picture
  EXPECT_NE(drawn(0, "cpu"), near);
}

}  // namespace
}  // namespace tenebra::testing
