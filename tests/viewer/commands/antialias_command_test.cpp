// tenebra render with several samples per pixel: what --antialias refuses, and the files of masks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "io/image.h"
#include "viewer/viewer_test_scene.h"

namespace tenebra::testing {
namespace {

constexpr int width = 80, height = 60;

class AntialiasCommand : public ::testing::Test {
protected:
  ProgramResult render(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"render", scene_, "--time", "5", "--size", "80x60"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tenebra(arguments);
  }
  void render_well(const std::vector<std::string>& more) const {
    const auto result = render(more);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
  }
  void expect_refusal(const std::vector<std::string>& more, const std::string& word) const {
    const auto result = render(more);
    EXPECT_EQ(result.exit_code, 1) << word;
    EXPECT_TRUE(is_one_sentence(result.errors)) << result.errors;
    EXPECT_NE(result.errors.find(word), std::string::npos) << result.errors;
  }
  io::Image8 picture(const std::string& name) const {
    auto image = io::read_png(folder_ / name);
    EXPECT_TRUE(image) << image.error().message;
    return image.value_or(io::Image8{width, height, 1, std::vector<std::uint8_t>(width * height)});
  }

  const TemporaryFolder folder_;
  const std::string scene_ = write_moving_scene(folder_);
};

TEST_F(AntialiasCommand, RefusesNumbersOfSamplesThatThereAreNot) {
  for (const char* samples : {"3", "0", "32", "256", "four"})
    expect_refusal({"-o", "none", "--antialias", samples}, "expected 1, 2, 4, 8 or 16");
}

TEST_F(AntialiasCommand, MasksOfSamplesNeedSeveral) {
  expect_refusal({"-o", "none", "--antialias", "1", "--mask", "mean:" + (folder_ / "m.png").string()},
                 "--mask mean is for several samples per pixel; expected --antialias 2, 4, 8 or 16");
  expect_refusal({"-o", "none", "--antialias", "1", "--mask", "samples:" + (folder_ / "m.png").string()},
                 "--mask samples");
  expect_refusal({"-o", "none", "--mask", "samples:" + (folder_ / "m.pfm").string()}, "expected .png");
  expect_refusal(
      {"-o", "none", "--mask", folder_ / "m.png", "--mask", "mean:" + (folder_ / "m.png").string()},
      "name the same file");
  expect_refusal({"-o", "none", "--shadows", "none", "--mask", "mean:" + (folder_ / "m.png").string()},
                 "--shadows none");
}

TEST_F(AntialiasCommand, MasksOfCentresAreTheSameFileForAnyNumber) {
  render_well({"-o", folder_ / "1.png", "--antialias", "1", "--mask", folder_ / "mask.png"});
  const std::string expected = read_text(folder_ / "mask.png");
  const io::Image8 one = picture("1.png");
  for (const char* samples : {"2", "4", "8", "16"}) {
    render_well({"-o", folder_ / "n.png", "--antialias", samples, "--mask", folder_ / "n_mask.png"});
    EXPECT_EQ(read_text(folder_ / "n_mask.png"), expected) << samples;
    EXPECT_FALSE(picture("n.png") == one) << samples;
  }
}

TEST_F(AntialiasCommand, WritesTheMasksOfSamplesAndTheirMeans) {
  render_well({"-o", "none", "--antialias", "8", "--mask", folder_ / "mask.png", "--mask",
               "samples:" + (folder_ / "samples.png").string(), "--mask",
               "mean:" + (folder_ / "mean.png").string(), "--mask",
               "mean:" + (folder_ / "mean.pfm").string()});
  EXPECT_EQ(picture("samples_S0.png"), picture("mask.png")) << "the centre's";
  std::vector<int> lit(width * height, 0);
  for (int k = 0; k < 8; ++k) {
    const io::Image8 sample = picture("samples_S" + std::to_string(k) + ".png");
    for (std::size_t i = 0; i < lit.size(); ++i) lit[i] += sample.pixels[i] != 0 ? 1 : 0;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "samples_S8.png"));
  const io::Image8 mean = picture("mean.png");
  const std::string pfm = read_text(folder_ / "mean.pfm");
  ASSERT_GT(pfm.size(), 4 * lit.size());
  std::vector<float> values(lit.size());
  std::memcpy(values.data(), pfm.data() + pfm.size() - 4 * lit.size(), 4 * lit.size());
  int between = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x),
                 from_below = static_cast<std::size_t>((height - 1 - y) * width + x);
      ASSERT_EQ(values[from_below], static_cast<float>(lit[i]) / 8) << x << ' ' << y;
      ASSERT_EQ(mean.pixels[i], std::lround(255.0f * values[from_below])) << x << ' ' << y;
      between += lit[i] > 0 && lit[i] < 8 ? 1 : 0;
    }
  }
  EXPECT_GT(between, 10) << "the shadow's edge";
}

}  // namespace
}  // namespace tenebra::testing
