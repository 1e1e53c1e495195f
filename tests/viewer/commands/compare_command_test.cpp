// tenebra compare: 0 same, 1 different, 2 failed.
#include <gtest/gtest.h>

#include "io/image.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

io::Image8 flat(int width, int height, int channels, std::uint8_t value) {
  return {width, height, channels,
          std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height * channels, value)};
}

TEST(CompareCommand, FindsAPictureEqualToItself) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "a.png", flat(9, 5, 3, 77)));
  const auto result = tenebra({"compare", folder / "a.png", folder / "a.png"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.output,
            "same: 0 of 45 pixels differ by more than 0, largest difference 0 of 255\n"
            "RMS 0 of 255, PSNR inf dB, FLIP 0\n");
}

TEST(CompareCommand, MarksDifferencesBeyondTheThreshold) {
  const TemporaryFolder folder;
  const io::Image8 a = flat(4, 2, 3, 120);
  io::Image8 b = a;
  b.pixels[0] = 123;          // pixel 0: 3
  b.pixels[7 * 3 + 2] = 110;  // pixel 7: 10
  ASSERT_TRUE(io::write_png(folder / "a.png", a) && io::write_png(folder / "b.png", b));
  const auto run = [&](const char* threshold) {
    return tenebra(
        {"compare", folder / "a.png", folder / "b.png", "--threshold", threshold, "-o", folder / "d.png"});
  };
  EXPECT_TRUE(run("2").output.starts_with(
      "different: 2 of 8 pixels differ by more than 2, largest difference 10 of 255\n"
      "RMS 2.13112 of 255, PSNR 41.5587 dB, FLIP 0."));
  EXPECT_EQ(run("9").exit_code, 1);
  EXPECT_EQ(run("10").exit_code, 0);
  EXPECT_EQ(run("3").exit_code, 1);
  const auto difference = io::read_png(folder / "d.png");
  ASSERT_TRUE(difference) << difference.error().message;
  for (std::size_t i = 0; i < 8; ++i) {
    const std::vector<std::uint8_t> pixel(difference->pixels.begin() + i * 3,
                                          difference->pixels.begin() + i * 3 + 3);
    EXPECT_EQ(pixel,
              i == 7 ? (std::vector<std::uint8_t>{255, 0, 0}) : (std::vector<std::uint8_t>{30, 30, 30}))
        << i;
  }
}

TEST(CompareCommand, TakesGreyForEqualColoursAndNoAlphaForOpaque) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "grey.png", flat(3, 3, 1, 255)) &&
              io::write_png(folder / "rgb.png", flat(3, 3, 3, 255)) &&
              io::write_png(folder / "rgba.png", flat(3, 3, 4, 255)) &&
              io::write_png(folder / "clear.png", flat(3, 3, 4, 254)));
  EXPECT_EQ(tenebra({"compare", folder / "grey.png", folder / "rgb.png"}).exit_code, 0);
  EXPECT_EQ(tenebra({"compare", folder / "rgb.png", folder / "rgba.png"}).exit_code, 0);
  EXPECT_EQ(tenebra({"compare", folder / "rgb.png", folder / "clear.png"}).exit_code, 1);
}

TEST(CompareCommand, TakesOtherSizesForDifferent) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "a.png", flat(3, 2, 1, 0)) &&
              io::write_png(folder / "b.png", flat(2, 3, 1, 0)));
  const auto result = tenebra({"compare", folder / "a.png", folder / "b.png", "-o", folder / "d.png"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.output.find("3x2 and 2x3"), std::string::npos) << result.output;
  EXPECT_FALSE(std::filesystem::exists(folder / "d.png"));
}

TEST(CompareCommand, FailsOnBrokenPicturesAndUnwritableResults) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "a.png", flat(3, 2, 1, 0)));
  const std::string whole = read_text(folder / "a.png");
  write_text(folder / "broken.png", whole.substr(0, whole.size() / 2));
  const std::vector<std::vector<std::string>> uses{
      {"compare", folder / "a.png", folder / "broken.png"},
      {"compare", folder / "broken.png", folder / "a.png"},
      {"compare", folder / "a.png", folder.path()},
      {"compare", folder / "a.png", folder / "a.png", "-o", folder / "no/d.png"},
      {"compare", folder / "a.png", folder / "a.png", "-o", "/dev/full"}};
  for (const auto& use : uses) {
    const auto result = tenebra(use);
    EXPECT_EQ(result.exit_code, 2) << use.back();
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
  }
}

}  // namespace
}  // namespace tenebra::testing
