// Which samples of edges take the hard shadows of others, and which need their own.
#include "render/antialias/edge_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "render/antialias/pattern.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

using render::EdgeSamples;

constexpr int edges_width = 8, edges_height = 4;
constexpr std::size_t edges_pixels = std::size_t{edges_width} * edges_height;
constexpr std::uint32_t wall = 0, screen = 1;

std::uint32_t edge_pixel(int x, int y) {
  return static_cast<std::uint32_t>(y * edges_width + x);
}

/// The left half of a small picture sees a wall, the right half a screen far before it; one light shines.
class Edges : public ::testing::Test {
protected:
  Edges() {
    add_triangle(geometry_, {-99, -99, -9}, {99, -99, -9}, {0, 99, -9});
    add_triangle(geometry_, {-99, -99, -1}, {99, -99, -1}, {0, 99, -1});
    for (std::size_t i = 0; i < edges_pixels; ++i)
      ids_.push_back(i % edges_width < edges_width / 2 ? wall : screen);
  }

  template <class Act>
  auto with_task(Act act) const {
    const std::vector<shade::LightFactors> lights{{mask_, {}, {tint_, coloured_}}};
    const render::CentreShadows centres{edges_width, edges_height, ids_, {}, lights, {mask_.data()}};
    const render::SurfaceMatch match(geometry_, view_);
    return act(render::EdgeTask{chosen_, centres, pattern_.offsets, seen_, match});
  }
  /// Of `chosen`: samples to the left of their centre see `left`, the others `right`.
  void find(int samples, std::vector<std::uint32_t> chosen, std::uint32_t left = wall,
            std::uint32_t right = screen) {
    chosen_ = std::move(chosen);
    pattern_ = render::sample_pattern(samples);
    seen_.begin(edges_width, edges_height, pattern_.offsets.size(), false);
    seen_.open_all();
    for (std::size_t k = 0; k < pattern_.offsets.size(); ++k)
      seen_.set_place(k, std::vector<std::uint32_t>(edges_pixels, is_left(k) ? left : right), {});
    with_task([&](const render::EdgeTask& task) { find_edge_samples(task, found_); });
  }
  bool is_left(std::size_t k) const { return pattern_.offsets[k].x < 0; }
  /// Whether sample k of chosen pixel i is to be traced.
  bool is_own(std::size_t i, std::size_t k) const {
    return std::any_of(found_.own.begin(), found_.own.end(), [&](const EdgeSamples::Own& own) {
      return own.number == i * pattern_.offsets.size() + k;
    });
  }
  /// How many of those on the left, or on the right, of chosen pixel i are.
  int count_own(std::size_t i, bool left) const {
    int count = 0;
    for (std::size_t k = 0; k < pattern_.offsets.size(); ++k) count += is_left(k) == left && is_own(i, k);
    return count;
  }
  /// The light of those that are not, if it is one.
  std::optional<render::LitBits> lit(std::size_t i, bool left) const {
    std::optional<render::LitBits> one;
    for (std::size_t k = 0; k < pattern_.offsets.size(); ++k) {
      if (is_left(k) != left || is_own(i, k)) continue;
      const render::LitBits bits = found_.lit[i * pattern_.offsets.size() + k];
      if (one && *one != bits) return std::nullopt;
      one = bits;
    }
    return one;
  }

  const ViewRays view_ = forward_view({0, 0, 0}, 8.0f, edges_width, edges_height);
  FrameGeometry geometry_;
  std::vector<std::uint32_t> ids_, chosen_;
  std::vector<std::uint8_t> mask_ = std::vector<std::uint8_t>(edges_pixels, 255);
  std::vector<glm::vec3> tint_;
  std::vector<std::uint8_t> coloured_;
  render::SamplePattern pattern_;
  visibility::PlaceIds seen_;
  EdgeSamples found_;
};

TEST_F(Edges, FewSamplesTakeTheLightOfCentresThatSeeTheirSurface) {
  for (int y = 0; y < edges_height; ++y)
    for (int x = edges_width / 2; x < edges_width; ++x) mask_[edge_pixel(x, y)] = 0;
  find(4, {edge_pixel(3, 1), edge_pixel(4, 2)});
  EXPECT_TRUE(found_.own.empty());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(lit(i, true), 1u) << "the wall";
    EXPECT_EQ(lit(i, false), 0u) << "the screen";
  }
}

TEST_F(Edges, ShadowEdgesNearbyAreTraced) {
  mask_[edge_pixel(2, 0)] = 0;  // on the wall
  find(4, {edge_pixel(3, 1), edge_pixel(3, 2)});
  EXPECT_EQ(count_own(0, false), 0) << "the screen has no edge";
  EXPECT_EQ(count_own(1, true), 0) << "two pixels away";
  EXPECT_EQ(count_own(0, true), 0) << "between the centre, and those to the left and below";
  mask_[edge_pixel(2, 1)] = 0;
  find(4, {edge_pixel(3, 1)});
  EXPECT_EQ(count_own(0, true), 1) << "no longer";
}

TEST_F(Edges, SamplesBetweenThreeCentresHaveTheirLight) {
  std::fill(ids_.begin(), ids_.end(), wall);
  for (int y = 0; y < edges_height; ++y)
    for (int x = 3; x < edges_width; ++x)
      mask_[edge_pixel(x, y)] = 0;  // the edge is between the columns 2 and 3
  find(16, {edge_pixel(2, 1), edge_pixel(3, 1)}, wall, wall);
  EXPECT_EQ(count_own(0, true), 0) << "away from the edge";
  EXPECT_EQ(lit(0, true), 1u);
  EXPECT_EQ(count_own(1, false), 0);
  EXPECT_EQ(lit(1, false), 0u);
  for (std::size_t k = 0; k < pattern_.offsets.size(); ++k)
    EXPECT_NE(is_left(k), is_own(0, k)) << "to the edge's side all are traced";
}

TEST_F(Edges, SurfacesThatFewCentresSeeAreTraced) {
  find(4, {edge_pixel(1, 1)});
  EXPECT_EQ(count_own(0, true), 0);
  EXPECT_GT(count_own(0, false), 0) << "no centre around sees the screen";
  ids_[edge_pixel(2, 2)] = screen;
  find(4, {edge_pixel(1, 1)});
  EXPECT_GT(count_own(0, false), 0) << "one does";
}

TEST_F(Edges, BackgroundIsNotTraced) {
  find(16, {edge_pixel(3, 1)}, wall, no_triangle);
  EXPECT_EQ(count_own(0, false), 0);
  EXPECT_EQ(lit(0, false), 0u);
}

TEST_F(Edges, PixelsBesideGlassComeFirst) {
  tint_.assign(edges_pixels, glm::vec3(1.0f));
  coloured_.assign(1, 1);
  tint_[edge_pixel(2, 0)] = {1, 0.5f, 1};
  find(4, {});
  std::vector<std::uint32_t> some{edge_pixel(6, 3), edge_pixel(3, 1), edge_pixel(1, 2), edge_pixel(1, 1)};
  const auto with_glass = with_task([&](render::EdgeTask task) {
    task.pixels = some;
    return part_by_glass(task, some);
  });
  EXPECT_EQ(with_glass, 2u);
  EXPECT_EQ(some, (std::vector<std::uint32_t>{edge_pixel(3, 1), edge_pixel(1, 1), edge_pixel(6, 3),
                                              edge_pixel(1, 2)}));
}

TEST_F(Edges, AreShadedOnceForEachSurfaceAndLight) {
  find(16, {edge_pixel(3, 1)});
  const auto list = [&] {
    render::ShadingList out;
    with_task([&](const render::EdgeTask& task) { list_edges(task, found_, out); });
    return out;
  };
  int left = 0;
  for (std::size_t k = 0; k < pattern_.offsets.size(); ++k) left += is_left(k);
  const int right = static_cast<int>(pattern_.offsets.size()) - left;
  render::ShadingList listed = list();
  EXPECT_EQ(listed.centres, std::vector<float>{static_cast<float>(left)}) << "the wall is the centre's";
  EXPECT_EQ(listed.shares, std::vector<float>{static_cast<float>(right)});
  EXPECT_EQ(listed.ids, std::vector<std::uint32_t>{screen});
  EXPECT_EQ(listed.from, std::vector<std::uint32_t>{1u});
  std::size_t one = 0;
  while (!is_left(one)) ++one;
  found_.lit[one] = 0;
  listed = list();
  EXPECT_EQ(listed.centres, std::vector<float>{static_cast<float>(left - 1)});
  EXPECT_EQ(listed.shares.size(), 2u) << "one of the wall in the dark";
}

}  // namespace
}  // namespace tenebra
