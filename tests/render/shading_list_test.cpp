// Which samples are shaded for pixels that have several.
#include "render/antialias/shading_list.h"

#include <gtest/gtest.h>

#include <numeric>

#include "render/antialias/pattern.h"

namespace tenebra {
namespace {

using render::ShadingList;

TEST(StandIns, CountAsAllSamplesAndSeeWhatTheNearestSees) {
  for (const int samples : {2, 4, 8, 16}) {
    const render::SamplePattern pattern = render::sample_pattern(samples);
    const std::vector<glm::vec2> places = render::square_places(2);
    ASSERT_EQ(places.size(), 4u);
    constexpr int width = 4, height = 4;
    const std::vector<std::uint32_t> centres(width * height, 99);
    visibility::PlaceIds seen;  // sample k sees triangle k
    seen.begin(width, height, pattern.offsets.size(), false);
    seen.open_all();
    for (std::uint32_t k = 0; k < pattern.offsets.size(); ++k)
      seen.set_place(k, std::vector<std::uint32_t>(width * height, k), {});
    const float centre_counts = pattern.centre_counts ? 1.0f : 0.0f;
    ShadingList list;
    list.add(7, {}, 7, 7, 7);  // of the frame before
    const std::uint32_t chosen[] = {6, 9};
    render::list_as_centres(chosen, width, {pattern.offsets, places, centre_counts}, centres, seen, list);
    ASSERT_EQ(list.ids.size(), 8u);
    ASSERT_EQ(list.centres, std::vector<float>(2, -centre_counts));
    EXPECT_EQ(std::accumulate(list.shares.begin(), list.shares.begin() + 4, 0.0f),
              static_cast<float>(samples));
    for (std::size_t i = 0; i < list.ids.size(); ++i) {
      EXPECT_EQ(list.pixels[i], i / 4);
      EXPECT_EQ(list.from[i], chosen[i / 4]);
      const glm::vec2 centre(static_cast<float>(chosen[i / 4] % width) + 0.5f,
                             static_cast<float>(chosen[i / 4] / width) + 0.5f);
      const glm::vec2 place = list.places[i] - centre;
      EXPECT_EQ(place, places[i % 4]);
      const glm::vec2 sees = list.ids[i] == 99 ? glm::vec2(0.0f) : pattern.offsets[list.ids[i]];
      for (const glm::vec2 offset : pattern.offsets)
        EXPECT_LE(glm::length(place - sees), glm::length(place - offset) + 1e-6f) << samples;
    }
  }
}

TEST(StandIns, FillThePixelEvenly) {
  const std::vector<glm::vec2> places = render::square_places(2);
  const std::vector<glm::vec2> expected{{-0.25f, -0.25f}, {0.25f, -0.25f}, {-0.25f, 0.25f}, {0.25f, 0.25f}};
  EXPECT_EQ(places, expected);
}

}  // namespace
}  // namespace tenebra
