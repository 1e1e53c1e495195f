// Pictures made of others: normals of heights, colours with the alpha of another picture.
#include "formats/images/derived.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/images/scene_images.h"
#include "pictures.h"

namespace tenebra::formats {
namespace {

TextureImage of_greys(int width, const std::vector<std::uint8_t>& values) {
  TextureImage image{"grey", width, static_cast<int>(values.size()) / width, {}};
  for (const std::uint8_t v : values) image.rgba.insert(image.rgba.end(), {v, v, v, 255});
  return image;
}

TEST(DerivedPictures, NormalsLeanAwayFromWhatIsHigher) {
  // Higher to the right and to the bottom; the picture repeats.
  const TextureImage ramp = of_greys(4, {0, 51, 102, 51, 51, 102, 153, 102, 102, 153, 204, 153});
  const TextureImage normals = normals_of_heights(ramp, 10);
  const std::uint8_t* const middle = &normals.rgba[4 * 5];  // rises by 0.2 a pixel both ways: 2 pixels high
  EXPECT_NEAR(middle[0], 127.5 * (1 - 2.0 / 3), 0.51);
  EXPECT_NEAR(middle[1], 127.5 * (1 + 2.0 / 3), 0.51);  // y is up in the picture
  EXPECT_NEAR(middle[2], 127.5 * (1 + 1.0 / 3), 0.51);
  EXPECT_GT(normals.rgba[4 * 7], 128);  // the last column's right neighbour is the first
  EXPECT_TRUE(holds_heights(ramp));
  EXPECT_FALSE(holds_heights(normals));
}

TEST(DerivedPictures, AlphaIsBrightnessOrAlpha) {
  const TextureImage colors{"c", 1, 2, {1, 2, 3, 255, 4, 5, 6, 255}};
  const TextureImage both = with_alpha(colors, of_greys(2, {0, 255}));
  EXPECT_EQ(both.rgba, (std::vector<std::uint8_t>{1, 2, 3, 0, 1, 2, 3, 255, 4, 5, 6, 0, 4, 5, 6, 255}));
  EXPECT_TRUE(cuts_out(both));
  const TextureImage shares{"a", 1, 1, {9, 9, 9, 77}};
  EXPECT_EQ(with_alpha(colors, shares).rgba[7], 77);
  EXPECT_FALSE(cuts_out(with_alpha(colors, shares)));
}

// A file of many materials would have its pictures looked at as many times.
TEST(DerivedPictures, EachPictureIsJudgedOnce) {
  Scene scene;
  SceneImages images(scene, ".", {});
  const int normals = images.add(testing::png_of({1, 1, 3, {128, 128, 255}}), "normals");
  EXPECT_EQ(images.normals_of_bumps(normals, 1), normals);
  const int shares = images.add(testing::png_of({1, 1, 4, {9, 9, 9, 77}}), "shares");
  EXPECT_FALSE(images.cuts_out(shares));
  for (TextureImage& image : scene.images) image.rgba = {9, 9, 9, 255};
  EXPECT_EQ(images.normals_of_bumps(normals, 2), normals);
  EXPECT_FALSE(images.cuts_out(shares));
}

TEST(DerivedPictures, AreMadeOnceAndHaveALimit) {
  Scene scene;
  SceneImages images(scene, ".", {});
  EXPECT_EQ(images.normals_of_bumps(-1, 1), -1);
  const int bumps = images.add(testing::png_of({1, 1, 3, {9, 9, 9}}), "bumps");
  const int normals = images.normals_of_bumps(bumps, 1);
  EXPECT_NE(normals, bumps);
  EXPECT_EQ(images.normals_of_bumps(bumps, 1), normals);
  EXPECT_NE(images.normals_of_bumps(bumps, 2), normals);
  EXPECT_EQ(images.normals_of_bumps(normals, 1), normals);
  EXPECT_EQ(images.with_alpha(-1, bumps), images.with_alpha(-1, bumps));
  // A row and a column: together too many pixels.
  scene.images.push_back({"row", 1 << 16, 1, std::vector<std::uint8_t>(4 << 16, 255)});
  scene.images.push_back({"column", 1, 1 << 16, std::vector<std::uint8_t>(4 << 16, 255)});
  const int last = static_cast<int>(scene.images.size()) - 1;
  EXPECT_EQ(images.with_alpha(last - 1, last), -1);
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_NE(scene.warnings[0].find("65536 x 65536 pixels"), std::string::npos) << scene.warnings[0];
}

}  // namespace
}  // namespace tenebra::formats
