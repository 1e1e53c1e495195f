// Radiance pictures: what all their forms mean, and that no damaged one hangs or is read.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "io/image.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::TemporaryFolder;
using testing::write_text;

const std::string rgbe = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

std::string bytes_of(std::initializer_list<int> values) {
  std::string bytes;
  for (const int value : values) bytes += static_cast<char>(value);
  return bytes;
}

/// A flat pixel of this red, from 0 to 255, whose green and blue are 0.
std::string red(int value) {
  return bytes_of({value, 0, 0, 136});
}

class Hdr : public ::testing::Test {
protected:
  Expected<io::ImageF> read(const std::string& bytes) {
    write_text(folder_ / "a.hdr", bytes);
    return io::read_hdr(folder_ / "a.hdr");
  }
  std::vector<float> pixels(const std::string& bytes) {
    const auto image = read(bytes);
    EXPECT_TRUE(image) << (image ? "" : image.error().message);
    return image ? image->pixels : std::vector<float>();
  }
  /// The red of each pixel.
  std::vector<float> reds(const std::string& bytes) {
    std::vector<float> reds;
    const std::vector<float> all = pixels(bytes);
    for (std::size_t i = 0; i < all.size(); i += 3) reds.push_back(all[i]);
    return reds;
  }

private:
  TemporaryFolder folder_;
};

// One byte each for red, green, blue and a shared exponent: value = byte * 2^(exponent - 136).
TEST_F(Hdr, ReadsLinearValues) {
  const std::string stored = bytes_of({0x80, 0x40, 0, 0x81, 0xff, 1, 2, 0x88, 0, 0, 0, 0});
  const auto image = read(rgbe + "\n-Y 1 +X 3\n" + stored);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 3);
  EXPECT_EQ(image->height, 1);
  EXPECT_EQ(image->channels, 3);
  EXPECT_EQ(image->pixels, (std::vector<float>{1, 0.5f, 0, 255, 1, 2, 0, 0, 0}));
}

TEST_F(Hdr, PutsEveryOrderOfPixelsTheSameWay) {
  // 1 2 3
  // 4 5 6
  const std::vector<std::pair<std::string, std::array<int, 6>>> orders{
      {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}},
      {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}}, {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}},
      {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
  for (const auto& [order, stored] : orders) {
    std::string bytes = rgbe + "\n" + order + "\n";
    for (const int value : stored) bytes += red(value);
    EXPECT_EQ(reds(bytes), (std::vector<float>{1, 2, 3, 4, 5, 6})) << order;
  }
}

TEST_F(Hdr, UndoesExposureAndColourCorrection) {
  const std::string header =
      "#?RGBE\nrpict -vf x.vf\nEXPOSURE=2\nEXPOSURE= 4\nCOLORCORR= 1 2 0.5\nFORMAT=32-bit_rle_rgbe\n";
  EXPECT_EQ(pixels(header + "\n-Y 1 +X 1\n" + bytes_of({8, 16, 8, 136})), (std::vector<float>{1, 1, 2}));
}

TEST_F(Hdr, MultipliesExposuresInDouble) {
  const std::string end = "\n-Y 1 +X 1\n" + red(7);
  const std::string large = "EXPOSURE=1e30\n", small = "EXPOSURE=1e-30\n";
  EXPECT_EQ(reds(rgbe + large + large + small + small + end), std::vector<float>{7});
  EXPECT_EQ(reds(rgbe + small + small + large + large + end), std::vector<float>{7});
  EXPECT_EQ(reds(rgbe + "EXPOSURE=1e-60\n" + large + large + end), std::vector<float>{7});
}

TEST_F(Hdr, NeutralXyzIsNeutral) {
  const auto grey =
      pixels("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + bytes_of({128, 128, 128, 129}));
  ASSERT_EQ(grey.size(), 3u);
  for (const float value : grey) EXPECT_NEAR(value, 1, 1e-6);
  // Radiance's red primary: X, Y and Z of red 1.
  const auto primary =
      pixels("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + bytes_of({132, 68, 6, 128}));
  ASSERT_EQ(primary.size(), 3u);
  EXPECT_NEAR(primary[0], 1, 0.01);
  EXPECT_NEAR(primary[1], 0, 0.01);
  EXPECT_NEAR(primary[2], 0, 0.01);
}

TEST_F(Hdr, ReadsOldRuns) {
  // 7, then 3 of it, then a run that continues: 1 + (1 << 8) more.
  const std::string stored = red(7) + bytes_of({1, 1, 1, 3}) + red(9) + bytes_of({1, 1, 1, 1, 1, 1, 1, 1});
  const auto values = reds(rgbe + "\n-Y 1 +X 262\n" + stored);
  ASSERT_EQ(values.size(), 262u);
  EXPECT_EQ(values[3], 7);
  EXPECT_EQ(values[4], 9);
  EXPECT_EQ(values[261], 9);
}

std::string new_runs() {
  std::string line = bytes_of({2, 2, 0, 10});
  line += bytes_of({128 + 6, 5, 4, 1, 2, 3, 4});  // red: six of 5, then 1 2 3 4
  line += bytes_of({128 + 10, 0, 128 + 10, 0});   // green, blue
  return line + bytes_of({128 + 10, 136});        // the exponent
}

TEST_F(Hdr, ReadsNewRuns) {
  EXPECT_EQ(reds(rgbe + "\n-Y 2 +X 10\n" + new_runs() + new_runs()),
            (std::vector<float>{5, 5, 5, 5, 5, 5, 1, 2, 3, 4, 5, 5, 5, 5, 5, 5, 1, 2, 3, 4}));
}

// A picture that was cut off, or whose runs are too long, kept the reading library busy for ever.
TEST_F(Hdr, RefusesEveryCut) {
  const std::string whole = rgbe + "\n-Y 2 +X 10\n" + new_runs() + new_runs();
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read(whole.substr(0, size))) << size << " of " << whole.size();
  const std::string old_runs =
      rgbe + "\n-Y 2 +X 4\n" + red(7) + bytes_of({1, 1, 1, 3}) + red(7) + red(7) + red(7) + red(7);
  ASSERT_TRUE(read(old_runs));
  for (std::size_t size = 0; size < old_runs.size(); ++size)
    EXPECT_FALSE(read(old_runs.substr(0, size))) << size;
}

TEST_F(Hdr, RefusesWhatIsDamagedInASentence) {
  const std::string line = "\n-Y 1 +X 10\n", zeros(40, '\0');
  for (const auto& [bytes, text] : std::vector<std::pair<std::string, std::string>>{
           {"hello", "expected one that starts with #?RADIANCE"},
           {"", "expected one that starts with #?RADIANCE"},
           {rgbe + "\n-Y 20000 +X 20000\n", "20000 x 20000 pixels, expected 1 to 2^26"},
           {rgbe + "\n-Y 100 +X 100\nab", "found 2 bytes behind the header"},
           {rgbe + "\n-Y 0 +X 10\n", "expected 1 to 2^26"},
           {rgbe + "\n-Y 18446744073709551615 +X 18446744073709551615\n", "expected 1 to 2^26"},
           {rgbe + "\n-Y 1 -Y 10\n" + zeros, "found no size"},
           {rgbe + "EXPOSURE=0\n" + line + zeros, "EXPOSURE=0, expected a number above 0"},
           {rgbe + "EXPOSURE=nan\n" + line + zeros, "expected a number above 0"},
           {rgbe + "EXPOSURE=1e200\nEXPOSURE=1e200\n" + line + zeros, "too large or too small as a product"},
           {rgbe + "EXPOSURE=1e-200\nEXPOSURE=1e-200\n" + line + zeros,
            "too large or too small as a product"},
           {rgbe + "EXPOSURE=1e-30\nEXPOSURE=1e-30\n\n-Y 1 +X 1\n" + red(1),
            "scanline 1 of 1 holds light beyond the range of floats"},
           {"#?RADIANCE\nFORMAT=tiff\n" + line + zeros, "FORMAT=tiff"},
           {rgbe + line + bytes_of({2, 2, 0, 10, 0, 0, 0, 0}) + zeros, "scanline 1 of 1 is damaged"},
           {rgbe + line + bytes_of({2, 2, 0, 9}) + zeros, "scanline 1 of 1 is damaged"},
           {rgbe + line + bytes_of({2, 2, 0, 10, 255, 0}) + zeros, "scanline 1 of 1 is damaged"},
           {rgbe + line + bytes_of({1, 1, 1, 9}) + zeros, "scanline 1 of 1 is damaged"},
           {rgbe + line + red(1) + bytes_of({1, 1, 1, 255}) + zeros, "scanline 1 of 1 is damaged"}}) {
    const auto image = read(bytes);
    ASSERT_FALSE(image) << text;
    EXPECT_NE(image.error().message.find(text), std::string::npos) << image.error().message;
    EXPECT_NE(image.error().message.find("a.hdr"), std::string::npos) << image.error().message;
  }
}

TEST_F(Hdr, EndsOnAnyBytes) {
  std::mt19937 random(1);
  const std::string whole = rgbe + "\n-Y 2 +X 10\n" + new_runs() + new_runs();
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    for (int n = 0; n < 4; ++n) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    const auto image = read(bytes);
    if (image) {
      EXPECT_EQ(image->pixels.size(), 3u * static_cast<std::size_t>(image->width * image->height));
    }
  }
}

}  // namespace
}  // namespace tenebra
