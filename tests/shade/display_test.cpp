// What is shown of colours: both tone curves against oracles in double, and the vector form against the
// scalar.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "shade/display.h"
#include "shade/kernels.h"

namespace tenebra {
namespace {

using glm::dmat3;
using glm::dvec3;
using glm::vec3;
using shade::Display;
using shade::Tone;

using shade::tones;

vec3 toned(Tone tone, const vec3& color) {
  return shade::shown({.tone = tone}, color);
}

/// Random colours over twelve decades, and among them all that is special.
std::vector<vec3> colors() {
  std::mt19937 random(7);
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> special{0.0f, -0.0f,  1.0f,  -1.0f, 0.04f,    0.08f,     0.76f,
                                   0.8f, 1e-40f, 1e15f, 1e30f, infinity, -infinity, std::nanf("")};
  const auto value = [&] {
    const unsigned kind = random() % 16;
    if (kind == 0) return special[random() % special.size()];
    const float unit = static_cast<float>(random()) / 4294967296.0f;
    return kind < 8 ? unit : std::pow(10.0f, 12 * unit - 6);
  };
  std::vector<vec3> found;
  for (int i = 0; i < 20000; ++i) found.emplace_back(value(), value(), value());
  for (const float a : special)
    for (const float b : special)
      for (const float c : special) found.emplace_back(a, b, c);
  return found;
}

TEST(Display, VectorFormHasTheBitsOfTheScalarOne) {
  const std::vector<vec3> all = colors();
  const auto block = std::make_unique<shade::SampleBlock>();
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    const shade::Kernels code = shade::kernels(level);
    for (const Tone tone : tones) {
      for (const float exposure : {1.0f, 0.3f, 40.0f}) {
        const Display display{exposure, tone, Transfer::srgb};
        const auto& table = shade::level_table(display.transfer);
        std::uint64_t different = 0;
        for (std::size_t first = 0; first < all.size(); first += block->count) {
          block->count = std::min(shade::SampleBlock::capacity, all.size() - first);
          for (std::size_t k = 0; k < block->count; ++k)
            for (int c = 0; c < 3; ++c) block->color[c][k] = all[first + k][c];
          std::vector<std::uint8_t> levels(3 * block->count);
          code.encode(table, display, *block, levels.data());
          code.show(display, *block);
          for (std::size_t k = 0; k < block->count; ++k) {
            const vec3 expected = shade::shown(display, all[first + k]);
            const vec3 found(block->color[0][k], block->color[1][k], block->color[2][k]);
            std::uint8_t expected_levels[3];
            shade::encode_shown(display, expected, expected_levels);
            different += std::memcmp(&expected, &found, sizeof(vec3)) != 0;
            different += std::memcmp(expected_levels, &levels[3 * k], 3) != 0;
          }
        }
        EXPECT_EQ(different, 0u) << simd_level_name(level) << " " << shade::tone_name(tone) << " "
                                 << exposure;
      }
    }
  }
}

TEST(Display, ShowsZeroToOneWhateverComes) {
  for (const Tone tone : tones)
    for (const vec3& color : colors())
      for (int c = 0; c < 3; ++c) {
        const float x = toned(tone, color)[c];
        EXPECT_TRUE(x >= 0 && x <= 1)
            << shade::tone_name(tone) << " " << color.x << " " << color.y << " " << color.z;
      }
}

TEST(Display, GreysNeverGetDarkerAsTheyGetBrighter) {
  for (const Tone tone : tones) {
    float before = 0;
    for (float x = 0; x < 100; x = x * 1.01f + 1e-4f) {
      const vec3 color = toned(tone, vec3(x));
      for (int c = 0; c < 3; ++c) EXPECT_GE(color[c], before - 3e-7f) << shade::tone_name(tone) << " " << x;
      before = std::max(before, color.y);
    }
    EXPECT_GT(before, 0.99f) << shade::tone_name(tone);
  }
}

TEST(Display, NoneIsTheColourTimesTheExposureCutOff) {
  EXPECT_EQ(shade::shown({.exposure = 2}, {0.25f, 0.75f, -1.0f}), vec3(0.5f, 1.0f, 0.0f));
}

/// Khronos PBR Neutral as its document derives it: F90 ramp, compressed peak, blend towards white; in double.
dvec3 neutral_oracle(dvec3 c) {
  const double x = std::min({c.r, c.g, c.b});
  c -= x <= 0.08 ? x - x * x / (4 * 0.04) : 0.04;
  const double p = std::max({c.r, c.g, c.b}), ks = 0.8 - 0.04;
  if (p <= ks) return c;
  const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
  const double g = 1 / (0.15 * (p - pn) + 1);
  return glm::mix(dvec3(pn), c * (pn / p), g);
}

TEST(Display, NeutralIsTheKhronosCurve) {
  for (const vec3& color : colors()) {
    if (!(glm::all(glm::greaterThanEqual(color, vec3(0.0f))) && glm::all(glm::lessThan(color, vec3(1e6f)))))
      continue;
    const dvec3 expected = neutral_oracle(color);
    const vec3 found = toned(Tone::neutral, color);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c], expected[c], 2e-6) << color.x << " " << color.y << " " << color.z;
  }
  // Its promise: what is neither dark nor bright is the base colour that the material states, lit by white
  // light whose mirrored 4 % come on top.
  const vec3 base(0.2f, 0.5f, 0.7f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(toned(Tone::neutral, base + 0.04f)[c], base[c], 1e-6);
}

/// Columns to XYZ of primaries and white by their chromaticities.
dmat3 to_xyz(const glm::dvec2 (&primaries)[3], glm::dvec2 white) {
  const auto xyz = [](glm::dvec2 c) { return dvec3(c.x / c.y, 1, (1 - c.x - c.y) / c.y); };
  const dmat3 columns(xyz(primaries[0]), xyz(primaries[1]), xyz(primaries[2]));
  const dvec3 scale = glm::inverse(columns) * xyz(white);
  return {columns[0] * scale.x, columns[1] * scale.y, columns[2] * scale.z};
}
/// From the primaries of ITU-R BT.709 to those of ACES (AP1), whites adapted after Bradford.
dmat3 srgb_to_ap1() {
  const dmat3 srgb = to_xyz({{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}, {0.3127, 0.3290});
  const dmat3 ap1 = to_xyz({{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}, {0.32168, 0.33767});
  const dmat3 bradford =
      glm::transpose(dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const dvec3 from = bradford * (srgb * dvec3(1)), to = bradford * (ap1 * dvec3(1));
  const dmat3 scale(to.x / from.x, 0, 0, 0, to.y / from.y, 0, 0, 0, to.z / from.z);
  return glm::inverse(ap1) * glm::inverse(bradford) * scale * bradford * srgb;
}
/// Towards AP1's luminance.
dmat3 less_saturated(double kept) {
  const dvec3 luminance(0.2722287168, 0.6740817658, 0.0536895174);
  dmat3 out(kept);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) out[column][row] += (1 - kept) * luminance[column];
  return out;
}

TEST(Display, AcesConstantsAreThoseOfItsPrimaries) {
  const dmat3 input = less_saturated(0.96) * srgb_to_ap1();
  const dmat3 output = glm::inverse(srgb_to_ap1()) * less_saturated(0.93);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(shade::aces::input[row][column], input[column][row], 5e-4) << row << " " << column;
      EXPECT_NEAR(shade::aces::output[row][column], output[column][row], 5e-4) << row << " " << column;
    }
}

TEST(Display, AcesIsItsCurveBetweenItsMatrices) {
  for (const vec3& color : colors()) {
    if (!(glm::all(glm::greaterThanEqual(color, vec3(0.0f))) && glm::all(glm::lessThan(color, vec3(1e6f)))))
      continue;
    const auto times = [](const float(&m)[3][3], const dvec3& v) {
      dvec3 out(0.0);
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) out[row] += double(m[row][column]) * v[column];
      return out;
    };
    dvec3 film = times(shade::aces::input, color);
    for (int c = 0; c < 3; ++c)
      film[c] = (film[c] * (film[c] + 0.0245786) - 0.000090537) /
                (film[c] * (0.983729 * film[c] + 0.4329510) + 0.238081);
    const dvec3 expected = glm::clamp(times(shade::aces::output, film), 0.0, 1.0);
    const vec3 found = toned(Tone::aces, color);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[c], expected[c], 2e-6) << color.x << " " << color.y << " " << color.z;
  }
}

}  // namespace
}  // namespace tenebra
