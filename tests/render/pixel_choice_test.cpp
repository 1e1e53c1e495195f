// Which pixels get further samples, of small pictures that are made by hand.
#include "render/antialias/pixel_choice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/antialias/pattern.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

constexpr int width = 8, height = 4;
constexpr std::size_t pixels = std::size_t{width} * height;

/// A wall, and what is drawn of it.
class PixelChoice : public ::testing::Test {
protected:
  PixelChoice() { add_triangle(geometry_, {-99, -99, -9}, {99, -99, -9}, {0, 99, -9}); }
  static std::uint32_t pixel(int x, int y) { return static_cast<std::uint32_t>(y * width + x); }

  /// Each row shows `levels`.
  void draw_rows(const std::vector<int>& levels) {
    for (std::size_t i = 0; i < pixels; ++i)
      std::fill_n(&picture_.pixels[3 * i], 3, static_cast<std::uint8_t>(levels[i % width]));
  }
  render::ChosenPixels choose(int samples = 16) const {
    const auto offsets = render::sample_pattern(samples).offsets;
    visibility::PlaceIds seen;
    seen.begin(width, height, offsets.size(), !layer_.empty());
    seen.open_all();
    for (std::size_t k = 0; k < offsets.size(); ++k) seen.set_place(k, ids_, layer_);
    const render::CentrePicture centre{width, height, ids_, layer_, picture_, {mask_}, {{tint_, coloured_}}};
    const ViewRays view = forward_view({0, 0, 0}, 8.0f, width, height);
    return render::choose_pixels(centre, offsets, seen, render::SurfaceMatch(geometry_, view), false);
  }

  FrameGeometry geometry_;
  std::vector<std::uint32_t> ids_ = std::vector<std::uint32_t>(pixels, 0), layer_;
  std::vector<glm::vec3> tint_ = std::vector<glm::vec3>(pixels, glm::vec3(1.0f));
  std::vector<std::uint8_t> coloured_{1}, mask_ = std::vector<std::uint8_t>(pixels, 255);
  io::Image8 picture_{width, height, 3, std::vector<std::uint8_t>(3 * pixels, 100)};
};

TEST_F(PixelChoice, NothingIsChosenOfOneColour) {
  EXPECT_EQ(choose().count(), 0u);
}

TEST_F(PixelChoice, StraightRampsNeedNoMore) {
  draw_rows({0, 0, 20, 40, 60, 80, 80, 80});
  const auto chosen = choose().contrasts;
  const auto has = [&](int x) { return std::count(chosen.begin(), chosen.end(), pixel(x, 1)) == 1; };
  EXPECT_FALSE(has(0));
  EXPECT_TRUE(has(1)) << "the ramp begins";
  EXPECT_FALSE(has(2));
  EXPECT_FALSE(has(3));
  EXPECT_FALSE(has(4));
  EXPECT_TRUE(has(5)) << "it ends";
  EXPECT_FALSE(has(6));
}

TEST_F(PixelChoice, RampsThatEndAtTheirSurfaceAreNone) {
  draw_rows({0, 20, 40, 60, 80, 100, 120, 140});
  EXPECT_EQ(choose().contrasts.size(), std::size_t{2 * height}) << "the first and the last column";
  add_triangle(geometry_, {-99, -99, -1}, {99, -99, -1}, {0, 99, -1}, 1);
  for (int y = 0; y < height; ++y) ids_[pixel(4, y)] = 1;
  EXPECT_EQ(choose().contrasts.size(), std::size_t{4 * height}) << "and those beside the other surface";
}

TEST_F(PixelChoice, WeakContrastsCountWithManySamplesOnly) {
  draw_rows({100, 100, 100, 100, 130, 130, 130, 130});
  EXPECT_EQ(choose(4).count(), 0u);
  EXPECT_EQ(choose(16).contrasts.size(), std::size_t{2 * height});
}

TEST_F(PixelChoice, ContrastsAreEdgesOnlyWhereGlassIs) {
  draw_rows({10, 10, 10, 10, 200, 200, 200, 200});
  layer_.assign(pixels, no_triangle);
  EXPECT_TRUE(choose().edges.empty()) << "the frame has glass, but nobody sees it";
  EXPECT_EQ(choose().contrasts.size(), std::size_t{2 * height});
  layer_[pixel(3, 1)] = 0;
  EXPECT_EQ(choose().edges, std::vector{pixel(3, 1)});
  EXPECT_EQ(choose().contrasts.size(), std::size_t{2 * height - 1});
}

TEST_F(PixelChoice, ShadowEdgesAreEdges) {
  mask_[pixel(3, 1)] = 0;
  EXPECT_EQ(choose().edges.size(), 5u) << "the dark one, beside it, above it and below it";
}

TEST_F(PixelChoice, ContrastsAreEdgesWhereLightChangesItsColour) {
  draw_rows({10, 10, 10, 10, 200, 200, 200, 200});
  tint_.assign(pixels, glm::vec3(1.0f, 0.5f, 0.5f));
  EXPECT_TRUE(choose().edges.empty()) << "as the centre is lit";
  tint_[pixel(4, 2)].g = 0.45f;
  const auto edges = choose().edges;
  EXPECT_EQ(edges.size(), 4u) << "it, the one before it, above it and below it; not the one behind";
  EXPECT_EQ(std::count(edges.begin(), edges.end(), pixel(5, 2)), 0);
  tint_[pixel(4, 2)].g = 0.3f;
  EXPECT_EQ(choose().edges.size(), 5u) << "by more than an eighth: with or without a contrast";
}

}  // namespace
}  // namespace tenebra
