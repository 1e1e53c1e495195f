// A check of a mask finds all of its wrong samples, and no others.
#include "oracle/mask_check.h"

#include <gtest/gtest.h>

#include <set>

#include "shadow/mask_case.h"

namespace tenebra::testing {
namespace {

/// A room with clutter, seen by 64x64 pixels, under a point light or a directional one.
MaskCase room_case(bool directional) {
  Random random(5);
  MaskCase c;
  c.name = "room, seed 5";
  c.soup = room(random, 12);
  c.light = directional ? ShadowLight{.directional = true, .to_light = {0.3f, 1.0f, 0.2f}}
                        : ShadowLight{.position = {0.2f, 0.7f, 0.1f}};
  c.view = pinhole({0.1, 0.1, 0.8}, {0, -0.2, 0}, 0.6, 64, 64);
  c.points = view_samples(c.soup.view(), c.view, 64, 64);
  return c;
}

std::vector<std::size_t> all_of(const ShadowMask& mask) {
  std::vector<std::size_t> pixels(mask.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = i;
  return pixels;
}

TEST(MaskCheck, FindsPlantedErrorsAndNoOthers) {
  for (const bool directional : {false, true}) {
    const MaskCase c = room_case(directional);
    ShadowMask mask = traced(c);
    const oracle::ExactShadow exact(c.view, c.soup.view(), c.light, c.config);
    const auto right = oracle::check_mask(exact, c.points, mask, all_of(mask));
    EXPECT_TRUE(right.wrong.empty());
    EXPECT_EQ(right.wrong_count, 0u);
    EXPECT_GT(right.stats.samples, 3000u);
    const std::set<std::size_t> planted{0, 17, 1000, 2048, 4095};
    for (const std::size_t i : planted) mask[i] = static_cast<std::uint8_t>(255 - mask[i]);
    const auto found = oracle::check_mask(exact, c.points, mask, all_of(mask));
    EXPECT_EQ(found.wrong.size(), planted.size());
    EXPECT_EQ(found.wrong_count, planted.size());
    for (const oracle::WrongSample& wrong : found.wrong) {
      EXPECT_TRUE(planted.contains(wrong.pixel)) << wrong.pixel;
      EXPECT_EQ(wrong.said, mask[wrong.pixel]);
      EXPECT_EQ(wrong.exact.value, 255 - mask[wrong.pixel]);
      EXPECT_EQ(wrong.exact.blocker != no_triangle, wrong.exact.active && wrong.exact.value == 0);
    }
  }
}

TEST(MaskCheck, CountsAllThatAreWrongAndNamesTheFirstThousand) {
  const MaskCase c = room_case(false);
  ShadowMask mask = traced(c);
  for (std::uint8_t& value : mask) value = static_cast<std::uint8_t>(255 - value);
  std::vector<std::size_t> pixels;  // more than are looked at in one go
  for (std::size_t i = 0; i < 20 * mask.size(); ++i) pixels.push_back(i * 7 % mask.size());
  const oracle::ExactShadow exact(c.view, c.soup.view(), c.light, c.config);
  const auto found = oracle::check_mask(exact, c.points, mask, pixels);
  EXPECT_EQ(found.wrong_count, pixels.size());
  ASSERT_EQ(found.wrong.size(), std::size_t{oracle::MaskCheck::most_named});
  for (std::size_t i = 0; i < found.wrong.size(); ++i) EXPECT_EQ(found.wrong[i].pixel, pixels[i]);
}

TEST(MaskCheck, EndsEarlyWhenAsked) {
  const MaskCase c = room_case(false);
  const ShadowMask mask = traced(c);
  const oracle::ExactShadow exact(c.view, c.soup.view(), c.light, c.config);
  StopFlag stop;
  stop.request();
  EXPECT_EQ(oracle::check_mask(exact, c.points, mask, all_of(mask), &stop).stats.samples, 0u);
}

TEST(MaskCheck, SpreadsSamplesOverWhatIsSeen) {
  std::vector<std::uint32_t> ids(1000, no_triangle);
  for (std::size_t i = 0; i < ids.size(); i += 2) ids[i] = 1;
  EXPECT_EQ(oracle::spread_samples(ids, 5000, 1).size(), 500u) << "all of them";
  const auto some = oracle::spread_samples(ids, 50, 1);
  EXPECT_EQ(some.size(), 50u);
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(ids[some[k]], 1u);
    EXPECT_EQ(some[k] / 20, k) << "one of each stretch";
  }
  EXPECT_EQ(oracle::spread_samples(ids, 50, 1), some) << "the same in every run";
  EXPECT_NE(oracle::spread_samples(ids, 50, 2), some);
  EXPECT_TRUE(oracle::spread_samples(std::vector<std::uint32_t>(9, no_triangle), 3, 1).empty());
}

}  // namespace
}  // namespace tenebra::testing
