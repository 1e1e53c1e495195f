// The figures of tenebra-bench picture, and the picture that they are compared with.
#include <gtest/gtest.h>

#include <cmath>

#include "bench/common/bench_scenes.h"
#include "bench/picture/picture_errors.h"
#include "bench/picture/picture_maker.h"
#include "math/srgb.h"
#include "render/antialias/pattern.h"
#include "stage/looks.h"

namespace tenebra::bench {
namespace {

TEST(PictureErrors, AreThoseOfTheirValues) {
  const io::Image8 a{2, 1, 3, {10, 20, 30, 200, 200, 200}}, b{2, 1, 3, {10, 36, 30, 183, 200, 201}};
  const PictureError error = picture_error(a, b);
  EXPECT_DOUBLE_EQ(error.rms, std::sqrt((16.0 * 16 + 17 * 17 + 1) / 6));
  EXPECT_DOUBLE_EQ(error.missed, 0.5) << "16 is not missed, 17 is";
  EXPECT_EQ(picture_error(a, a).rms, 0);
  EXPECT_EQ(picture_error(a, a).missed, 0);
}

TEST(PictureErrors, FlickerIsWhatTheReferenceDoesNotDo) {
  const io::Image8 dark{1, 1, 3, {10, 10, 10}}, bright{1, 1, 3, {20, 10, 10}}, other{1, 1, 3, {10, 20, 10}};
  ChangeSums same, apart, swapped;
  add_change(dark, bright, dark, bright, same);
  EXPECT_EQ(same.flicker(), 0);
  EXPECT_DOUBLE_EQ(same.rms(), std::sqrt(100.0 / 3));
  add_change(dark, bright, dark, dark, apart);
  EXPECT_DOUBLE_EQ(apart.flicker(), std::sqrt(100.0 / 3));
  EXPECT_EQ(apart.reference_rms(), 0);
  add_change(dark, bright, dark, other, swapped);  // as much changes, but elsewhere
  EXPECT_EQ(swapped.rms(), swapped.reference_rms());
  EXPECT_DOUBLE_EQ(swapped.flicker(), std::sqrt(200.0 / 3));
}

/// The mean in linear light over pictures of one sample per pixel whose cameras are moved to the 256 places
/// of the reference: what that is to be, without any anti-aliasing of the renderer but for the places.
io::Image8 mean_of_moved(PictureMaker& maker) {
  std::vector<double> sums;
  io::Image8 mean;
  const auto places = render::sample_pattern(256).offsets;
  for (const glm::vec2 place : places) {
    const auto picture = maker.draw({1}, glm::dvec2(place));
    if (!picture) {
      ADD_FAILURE() << picture.error().message;
      return mean;
    }
    mean = **picture;
    sums.resize(mean.pixels.size());
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += math::linear_of_srgb(mean.pixels[k] / 255.0);
  }
  const double count = static_cast<double>(places.size());
  for (std::size_t k = 0; k < sums.size(); ++k)
    mean.pixels[k] = static_cast<std::uint8_t>(std::lround(255 * math::srgb_of_linear(sums[k] / count)));
  return mean;
}

struct View {
  const char* scene;
  int frame;
};
void PrintTo(const View& view, std::ostream* out) {  // CTest's name of the test
  *out << view.scene << ' ' << view.frame;
}
class PictureReference : public ::testing::TestWithParam<View> {};

// Plain surfaces: textures are smoothed over a pixel where it has one sample, and over less of it where it
// has more, so that pictures of one sample are no measure of them. What is left are the levels that those are
// rounded to, and rays that are rounded otherwise.
TEST_P(PictureReference, IsTheMeanOfPicturesOfOneSample) {
  std::unique_ptr<testing::TemporaryFolder> made;
  auto scene = load_picture_scene(find_scene(bench_scene(GetParam().scene), {}, made), {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->transfer, Transfer::srgb);
  stage::make_plain(*scene);
  auto maker = PictureMaker::create({*scene, 96, 64, 2});
  ASSERT_TRUE(maker) << maker.error().message;
  maker->evaluate(GetParam().frame);
  const io::Image8 expected = mean_of_moved(*maker);
  const auto drawn = maker->draw(reference_sampling);
  ASSERT_TRUE(drawn) << drawn.error().message;
  const io::Image8 reference = **drawn;
  const PictureError error = picture_error(reference, expected);
  const auto one = maker->draw({1});
  ASSERT_TRUE(one) << one.error().message;
  const PictureError jagged = picture_error(**one, expected);
  const auto sixteen = maker->draw({16, true});
  ASSERT_TRUE(sixteen) << sixteen.error().message;
  const PictureError sixteen_off = picture_error(**sixteen, expected);
  std::printf("%s %d: 256 samples %.3f/255, missed %.4f; 16 everywhere %.3f; one %.3f, missed %.4f\n",
              GetParam().scene, GetParam().frame, error.rms, error.missed, sixteen_off.rms, jagged.rms,
              jagged.missed);
  EXPECT_LT(error.rms, 0.3);
  EXPECT_EQ(error.missed, 0);
  EXPECT_GT(jagged.rms, 8 * error.rms);
  EXPECT_LT(sixteen_off.rms, jagged.rms / 3);
  EXPECT_GT(sixteen_off.rms, error.rms);
}

INSTANTIATE_TEST_SUITE_P(Views, PictureReference,
                         ::testing::Values(View{"gallery", 60}, View{"court", 60}, View{"city", 150}),
                         [](const auto& info) { return std::string(info.param.scene); });

}  // namespace
}  // namespace tenebra::bench
