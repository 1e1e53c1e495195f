// The sampler against its definition in double, and against itself on all vector levels.
#include "texture/sampler.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "reference_sampler.h"

namespace tenebra::texture {
namespace {

constexpr std::size_t count = TexturePlaces::capacity;

class SamplerCases {
public:
  explicit SamplerCases(unsigned seed) : random_(seed) {}

  float uniform(float from, float to) {
    return from + (to - from) * static_cast<float>(random_() >> 8) / 16777216.0f;
  }
  template <class T>
  T one_of(std::initializer_list<T> values) {
    return *(values.begin() + random_() % values.size());
  }

  TextureImage image() {
    const int width = one_of({1, 2, 5, 16, 37, 128}), height = one_of({1, 3, 8, 64, 100});
    TextureImage made{"noise", width, height, {}};
    for (int i = 0; i < 4 * width * height; ++i)
      made.rgba.push_back(static_cast<std::uint8_t>(random_() >> 24));
    return made;
  }
  Wrap wrap() { return one_of({Wrap::repeat, Wrap::clamp_to_edge, Wrap::mirrored_repeat}); }
  TextureMap map() {
    TextureMap made{.image = 0};
    made.magnify = one_of({Filter::nearest, Filter::linear});
    made.minify = one_of({Filter::nearest, Filter::linear, Filter::linear, Filter::linear});
    made.mip = one_of({MipFilter::none, MipFilter::nearest, MipFilter::linear, MipFilter::linear});
    return made;
  }
  /// Ellipses from a tenth of a pixel to the whole picture, round to thin, in all directions.
  void places(const MipTexture& texture, TexturePlaces& out) {
    for (std::size_t i = 0; i < count; ++i) {
      const float longer = std::exp2(uniform(-3.0f, 7.0f)), thin = std::exp2(uniform(-5.0f, 0.0f));
      const float turn = uniform(0, 6.3f), mix = uniform(0, 6.3f);
      const glm::vec2 along(std::cos(turn), std::sin(turn)), across(-along.y, along.x);
      const glm::vec2 size(texture.width(), texture.height());
      const glm::vec2 by_x = longer * (std::cos(mix) * along + thin * std::sin(mix) * across) / size,
                      by_y = longer * (-std::sin(mix) * along + thin * std::cos(mix) * across) / size;
      for (int c = 0; c < 2; ++c) {
        out.at[c][i] = uniform(-3.0f, 4.0f);
        out.by_x[c][i] = by_x[c];
        out.by_y[c][i] = by_y[c];
      }
    }
  }

private:
  std::mt19937 random_;
};

SeenPlace place_of(const TexturePlaces& places, std::size_t i) {
  const auto two = [&](const TexturePlaces::Channel(&of)[2]) { return glm::dvec2(of[0][i], of[1][i]); };
  return {two(places.at), two(places.by_x), two(places.by_y)};
}

// Bounds of the sampler's roundings, of which each is at most 2^-24 of its value:
// - a coordinate of at most 4, with half an axis of at most 128 pixels added, is folded after two roundings
//   and becomes pixels after two more: off by at most 4 * 8 * 2^-24 of the picture where the axis is no
//   longer than the picture (2^-19); on pictures of one or two pixels the axis may be 128 times as long, and
//   so is the error;
// - the ellipse's size comes through about twenty roundings, of which its square has the most: 2e-6.
// The answer must lie between those of the definition for inputs moved by that much, give or take 1e-5 for
// the values' own roundings (3 * 16 sums of values up to 1: 48 * 2^-24). Where rounding decides the number of
// places nothing is said: within 1e-4 of a whole ratio of axes.
TEST(Sampler, AgreesWithTheDefinitionInDouble) {
  SamplerCases cases(5);
  int compared = 0, undecided = 0, many_taps = 0;
  for (int round = 0; round < 150; ++round) {
    const MipTexture texture(cases.image(), Content::data, cases.wrap(), cases.wrap());
    const TextureMap map = cases.map();
    TexturePlaces places{};
    cases.places(texture, places);
    TextureValues found;
    sampler(SimdLevel::automatic)(texture, map, places, 0, count, found);
    const ReferenceSampler reference(texture, map);
    for (std::size_t i = 0; i < count; ++i) {
      const SeenPlace seen = place_of(places, i);
      const double ratio = reference.ratio(seen);
      if (std::abs(ratio - std::round(ratio)) < 1e-4 && ratio < 16.5) {
        ++undecided;
        continue;
      }
      const double axis = reference.longest_step(seen);
      const double moved = 0x1p-19 * std::max(1.0, axis), grown = 2e-6;
      glm::dvec4 least(1e9), most(-1e9);
      for (const double scale : {1 - grown, 1.0, 1 + grown}) {
        for (const glm::dvec2& step : {glm::dvec2(0, 0), {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}) {
          const glm::dvec4 value =
              reference.sample({seen.at + moved * step, scale * seen.by_x, scale * seen.by_y});
          least = glm::min(least, value);
          most = glm::max(most, value);
        }
      }
      for (int c = 0; c < 4; ++c) {
        EXPECT_GE(found.channel[c][i], least[c] - 1e-5) << round << " " << i;
        EXPECT_LE(found.channel[c][i], most[c] + 1e-5) << round << " " << i;
      }
      ++compared;
      many_taps += ratio > 3;
    }
  }
  EXPECT_GT(compared, 9000);
  EXPECT_GT(many_taps, 1000);
  EXPECT_LT(undecided, 100);
}

TEST(Sampler, AllVectorLevelsGiveTheSameBits) {
  SamplerCases cases(6);
  for (int round = 0; round < 100; ++round) {
    const MipTexture texture(cases.image(), Content::srgb_color, cases.wrap(), cases.wrap());
    const TextureMap map = cases.map();
    TexturePlaces places{};
    cases.places(texture, places);
    TextureValues expected{};
    sampler(SimdLevel::scalar)(texture, map, places, 0, count, expected);
    for (const SimdLevel level : {SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      TextureValues found{};
      sampler(level)(texture, map, places, 0, count, found);
      for (int c = 0; c < 4; ++c)
        EXPECT_EQ(std::memcmp(found.channel[c], expected.channel[c], count * sizeof(float)), 0)
            << simd_level_name(level) << " " << round;
    }
  }
}

// A sample's value is its own, whoever stands beside it: any part of a block at a time.
TEST(Sampler, PartsOfABlockAreTheWhole) {
  SamplerCases cases(7);
  const Sampler sample = sampler(SimdLevel::automatic);
  for (int round = 0; round < 50; ++round) {
    const MipTexture texture(cases.image(), Content::display_color, cases.wrap(), cases.wrap());
    const TextureMap map = cases.map();
    TexturePlaces places{};
    cases.places(texture, places);
    TextureValues whole{}, parts{};
    sample(texture, map, places, 0, count, whole);
    for (std::size_t first = 0, size = 1; first < count; first += size, size = size % 21 + 4)
      sample(texture, map, places, first, std::min(size, count - first), parts);
    for (int c = 0; c < 4; ++c)
      EXPECT_EQ(std::memcmp(whole.channel[c], parts.channel[c], count * sizeof(float)), 0) << round;
  }
}

}  // namespace
}  // namespace tenebra::texture
