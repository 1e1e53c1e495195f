// tenebra render on a file without light and camera: the floor is seen by its shadow alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "io/image.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

std::string write_box(const TemporaryFolder& folder) {
  const std::string path = folder / "box.obj";
  write_text(path,
             "v -1 0 -1\nv 1 0 -1\nv -1 2 -1\nv 1 2 -1\nv -1 0 1\nv 1 0 1\nv -1 2 1\nv 1 2 1\n"
             "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
  return path;
}

io::Image8 drawn(const TemporaryFolder& folder, std::vector<std::string> more) {
  std::vector<std::string> arguments{"render",           write_box(folder), "--size", "200x150",         "-o",
                                     folder / "box.png", "--quiet",         "--log",  folder / "box.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto result = tenebra(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  auto image = io::read_png(folder / "box.png");
  EXPECT_TRUE(image) << image.error().message;
  return image.value_or(io::Image8{});
}

struct Difference {
  int most = 0;
  double share = 0;  ///< of the values that are off by more than 8
};
Difference between(const io::Image8& a, const io::Image8& b) {
  Difference found;
  EXPECT_EQ(a.pixels.size(), b.pixels.size());
  for (std::size_t i = 0; i < std::min(a.pixels.size(), b.pixels.size()); ++i) {
    const int difference = std::abs(a.pixels[i] - b.pixels[i]);
    found.most = std::max(found.most, difference);
    found.share += difference > 8;
  }
  found.share /= static_cast<double>(a.pixels.size());
  return found;
}

TEST(AddedParts, TheFloorIsSeenByItsShadowAlone) {
  const TemporaryFolder folder;
  // The same camera: that of the scene with a floor stands elsewhere, for it looks at the shadow.
  const std::vector<std::string> camera{"--eye", "2,3,6", "--look-at", "0.3,0.8,0"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), camera.begin(), camera.end());
    return drawn(folder, more);
  };
  for (const char* tone : {"none", "neutral"}) {
    const io::Image8 bare = with({"--floor", "none", "--shadows", "none", "--tone", tone});
    EXPECT_LE(between(with({"--shadows", "none", "--tone", tone}), bare).most, 1);
    EXPECT_GT(between(with({"--tone", tone}), bare).share, 0.02);
  }
}

TEST(AddedParts, TheLogAndInfoNameWhatIsAdded) {
  const TemporaryFolder folder;
  drawn(folder, {});
  const std::string log = read_text(folder / "box.csv");
  EXPECT_NE(log.find("# added: camera, sun, floor\n"), std::string::npos);
  EXPECT_NE(log.find("# environment: a soft sky\n"), std::string::npos);
  EXPECT_NE(log.find("# tone: neutral\n"), std::string::npos);
  const auto info = tenebra({"info", write_box(folder), "--meter"});
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  for (const char* part : {"The scene has no camera", "The scene has no light", "--floor none",
                           "shown: exposure 1, tone neutral, auto_none "})
    EXPECT_NE(info.output.find(part), std::string::npos) << part << "\n" << info.output;
  drawn(folder, {"--floor", "none"});
  EXPECT_NE(read_text(folder / "box.csv").find("# added: camera, sun\n"), std::string::npos);
}

TEST(AddedParts, InAClosedRoomTheLightIsALamp) {
  const TemporaryFolder folder;
  const std::string room = folder / "room.obj";  // the box above, seen from inside
  write_text(room,
             "v -1 0 -1\nv 1 0 -1\nv -1 2 -1\nv 1 2 -1\nv -1 0 1\nv 1 0 1\nv -1 2 1\nv 1 2 1\n"
             "f 2 4 3 1\nf 7 8 6 5\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n");
  const auto result = tenebra({"render", room, "--size", "80x60", "-o", folder / "room.png", "--quiet",
                               "--log", folder / "room.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const std::string log = read_text(folder / "room.csv");
  EXPECT_NE(log.find("# added: camera, lamp\n"), std::string::npos) << log;
  EXPECT_NE(log.find("# environment: none\n"), std::string::npos) << "no sky is seen in it";
}

}  // namespace
}  // namespace tenebra::testing
