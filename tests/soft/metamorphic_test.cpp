// What must hold between masks without knowing any of them: row F of the catalogue of reliability.md, and the
// choices that decide the work but not the answer.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "soft/soft_frames.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;
using glm::vec3;

/// Vertices on a grid of 2^-12: midpoints of edges, and of those once more, are exact floats.
void snap(Soup& soup) {
  for (vec3& p : soup.positions) p = vec3(glm::round(p * 4096.0f)) / 4096.0f;
}

/// A room whose light has exact quarters.
SoftCase room_case(std::uint64_t seed, int count = 900) {
  Random random(seed);
  SoftCase c;
  c.name = fmt::format("room, seed {}", seed);
  c.soup = room(random, 60);
  snap(c.soup);
  c.light = must(make_rectangle_light({0.25f, 1.5f, -0.25f}, {0.25f, 0, 0}, {0, 0, 0.5f}));
  place_in_penumbra(c, random, count);
  return c;
}

std::size_t penumbra_of(const SoftMask& mask) {
  return static_cast<std::size_t>(std::count_if(mask.visible_fraction.begin(), mask.visible_fraction.end(),
                                                [](float f) { return f > 0.01f && f < 0.99f; }));
}

/// Largest difference of the fractions.
double distance(const SoftMask& a, const SoftMask& b) {
  double worst = a.visible_fraction.size() == b.visible_fraction.size() ? 0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.visible_fraction.size(), b.visible_fraction.size()); ++i)
    worst = std::max(worst, std::abs(double(a.visible_fraction[i]) - double(b.visible_fraction[i])));
  return worst;
}
bool same_bits(const SoftMask& a, const SoftMask& b) {
  return a.visible_fraction == b.visible_fraction && a.irradiance == b.irradiance;
}

/// Twice what each of two masks may be off.
double apart(SoftPrecision precision) {
  return 2 * (precision == SoftPrecision::reference ? reference_bound : fast_bound);
}
constexpr SoftPrecision both[] = {SoftPrecision::reference, SoftPrecision::fast};

TEST(SoftMetamorphic, TheOrderOfTheTrianglesDoesNotMatter) {
  const SoftCase c = room_case(1);
  SoftCase shuffled = c;
  Random random(2);
  std::vector<std::uint32_t> place(c.soup.triangles.size());
  std::iota(place.begin(), place.end(), 0u);
  for (std::uint32_t i = static_cast<std::uint32_t>(place.size()); i > 1; --i)
    std::swap(place[i - 1], place[random.index(i)]);
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    const glm::uvec3 t = c.soup.triangles[i];
    const glm::uvec3 turned[3] = {t, {t.y, t.z, t.x}, {t.z, t.x, t.y}};
    shuffled.soup.triangles[place[i]] = turned[random.index(3)];
  }
  for (std::uint32_t& id : shuffled.points.triangles)
    if (id != no_triangle) id = place[id];
  for (const SoftPrecision precision : both) {
    const SoftMask mask = traced(c, precision);
    EXPECT_GT(penumbra_of(mask), 200u);
    EXPECT_LE(distance(mask, traced(shuffled, precision)), apart(precision));
  }
}

TEST(SoftMetamorphic, SplitTrianglesCastTheSameShadow) {
  const SoftCase c = room_case(3);
  SoftCase split = c;
  const std::size_t count = c.soup.triangles.size();
  // The whole triangles stay as receivers, and cast no more.
  split.soup.casts.assign(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const dvec3 a(c.soup.corner(i, 0)), b(c.soup.corner(i, 1)), d(c.soup.corner(i, 2));
    const dvec3 ab = (a + b) * 0.5, bd = (b + d) * 0.5, da = (d + a) * 0.5;
    split.soup.add(a, ab, da), split.soup.add(ab, b, bd), split.soup.add(da, bd, d),
        split.soup.add(ab, bd, da);
  }
  split.soup.casts.resize(split.soup.triangles.size(), 1);
  // theta is the same for a triangle and its parts but for the largest coordinate; points on the parts of
  // their own triangle lie within it.
  for (const SoftPrecision precision : both)
    EXPECT_LE(distance(traced(c, precision), traced(split, precision)), apart(precision));
}

TEST(SoftMetamorphic, CopiesAndTrianglesWithoutAreaChangeNothing) {
  const SoftCase c = room_case(4);
  SoftCase more = c;
  const std::size_t count = c.soup.triangles.size();
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::uvec3 t = c.soup.triangles[i];
    more.soup.triangles.push_back(i % 2 == 0 ? t : glm::uvec3(t.z, t.y, t.x));
    more.soup.triangles.emplace_back(t.x, t.x, t.y);
    more.soup.triangles.emplace_back(t.z, t.z, t.z);
  }
  for (const SoftPrecision precision : both)
    EXPECT_LE(distance(traced(c, precision), traced(more, precision)), apart(precision));
}

TEST(SoftMetamorphic, TrianglesBeyondTheHullChangeNothing) {
  const SoftCase c = room_case(5);
  SoftCase more = c;
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const dvec3 at = random.direction() * random.in(20, 40);
    more.soup.add(at + random.in_cube(4), at + random.in_cube(4), at + random.in_cube(4));
  }
  for (const SoftPrecision precision : both)
    EXPECT_LE(distance(traced(c, precision), traced(more, precision)), apart(precision));
}

TEST(SoftMetamorphic, UnionsOfOccluders) {
  SoftCase c = room_case(7);
  const std::size_t count = c.soup.triangles.size();
  SoftCase one = c, other = c;
  Random random(8);
  one.soup.casts.resize(count), other.soup.casts.resize(count), c.soup.casts.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    one.soup.casts[i] = random.chance(0.6), other.soup.casts[i] = random.chance(0.6);
    c.soup.casts[i] = one.soup.casts[i] | other.soup.casts[i];
  }
  SoftCase none = c;
  none.soup.casts.assign(count, 0);
  for (const SoftPrecision precision : both) {
    const SoftMask both_cast = traced(c, precision), a = traced(one, precision), b = traced(other, precision);
    const SoftMask open = traced(none, precision);
    EXPECT_GT(penumbra_of(both_cast), 150u);
    const double e = 2 * apart(precision);
    for (std::size_t i = 0; i < c.size(); ++i) {
      const double all = open.visible_fraction[i], fa = a.visible_fraction[i], fb = b.visible_fraction[i];
      const double f = both_cast.visible_fraction[i];
      EXPECT_LE(f, std::min(fa, fb) + e) << describe(c, i);
      EXPECT_GE(f, fa + fb - all - e) << describe(c, i);
      EXPECT_LE(std::max(fa, fb), all + e) << describe(c, i);
    }
  }
}

TEST(SoftMetamorphic, PartsOfALightAddUpAndItsUmbraIsThatOfEveryPart) {
  const SoftCase c = room_case(9);
  std::vector<SoftCase> parts;
  for (int k = 0; k < 4; ++k) {
    parts.push_back(c);
    const vec3 centre{0.25f + (k % 2 == 0 ? -0.125f : 0.125f), 1.5f, -0.25f + (k < 2 ? -0.25f : 0.25f)};
    parts.back().light = must(make_rectangle_light(centre, {0.125f, 0, 0}, {0, 0, 0.25f}));
  }
  for (const SoftPrecision precision : both) {
    const SoftMask whole = traced(c, precision);
    std::vector<SoftMask> masks;
    for (const SoftCase& part : parts) masks.push_back(traced(part, precision));
    std::size_t umbra = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
      double fraction = 0, irradiance = 0, most = 0;
      for (const SoftMask& mask : masks) {
        fraction += 0.25 * mask.visible_fraction[i], irradiance += mask.irradiance[i];
        most = std::max(most, double(mask.visible_fraction[i]));
      }
      EXPECT_NEAR(whole.visible_fraction[i], fraction, apart(precision)) << describe(c, i);
      EXPECT_NEAR(whole.irradiance[i], irradiance, 3.15 * apart(precision)) << describe(c, i);
      if (whole.visible_fraction[i] > 0) continue;
      ++umbra;
      EXPECT_LE(most, 4 * apart(precision)) << describe(c, i);
    }
    EXPECT_GT(umbra, 50u);
  }
}

TEST(SoftMetamorphic, GrowingOccludersNeverLight) {
  Random random(10);
  SoftCase c;
  c.soup.quad({-3, -1.5, -3}, {0, 0, 6}, {6, 0, 0});
  const std::size_t receivers = c.soup.triangles.size();
  c.soup.append(random_soup(random, 150, 0.15));
  c.light = square_light({0.3, 3, -0.2}, {0, 0, 0}, 0.8);
  place_in_penumbra(c, random, 900);
  SoftCase grown = c;
  for (std::size_t i = receivers; i < c.soup.triangles.size(); ++i) {
    const auto id = static_cast<std::uint32_t>(i);
    const dvec3 a(c.soup.corner(id, 0)), b(c.soup.corner(id, 1)), d(c.soup.corner(id, 2));
    grown.soup.add(a, b + 0.3 * (b - a), d + 0.5 * (d - a));  // the same triangle and more, up to rounding
  }
  for (const SoftPrecision precision : both) {
    const SoftMask small = traced(c, precision), large = traced(grown, precision);
    double dimmed = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
      EXPECT_LE(large.visible_fraction[i], small.visible_fraction[i] + apart(precision)) << describe(c, i);
      dimmed = std::max(dimmed, double(small.visible_fraction[i]) - double(large.visible_fraction[i]));
    }
    EXPECT_GT(dimmed, 0.1);
  }
}

TEST(SoftMetamorphic, ACropOfThePictureIsThePictureOfTheCrop) {
  const SoftCase c = frame_case(bundled_frames[0], 96, 54);
  SoftCase crop = c;
  crop.points.width = 40, crop.points.height = 21;
  crop.points.positions.clear(), crop.points.triangles.clear(), crop.normals.clear();
  std::vector<std::size_t> from;
  for (std::size_t y = 13; y < 34; ++y)
    for (std::size_t x = 29; x < 69; ++x) from.push_back(y * 96 + x);
  for (const std::size_t i : from) {
    crop.points.positions.push_back(c.points.positions[i]);
    crop.points.triangles.push_back(c.points.triangles[i]);
    crop.normals.push_back(c.normals[i]);
  }
  for (const SoftPrecision precision : both) {
    const SoftMask whole = traced(c, precision), part = traced(crop, precision);
    for (std::size_t k = 0; k < from.size(); ++k)
      EXPECT_NEAR(part.visible_fraction[k], whole.visible_fraction[from[k]], apart(precision))
          << describe(c, from[k]);
  }
}

/// Every choice that decides the work and not the answer, one at a time.
std::vector<std::pair<std::string, SoftShadowConfig>> choices() {
  const SoftShadowConfig base;
  std::vector<std::pair<std::string, SoftShadowConfig>> out{{"auto", base}};
  const auto add = [&](const char* name, auto change) {
    out.emplace_back(name, base);
    change(out.back().second);
  };
  const auto bsp = [](SoftShadowConfig& c) { c.solver = SoftSolver::bsp; };
  add("bsp", bsp);
  add("clip", [](SoftShadowConfig& c) { c.solver = SoftSolver::clip; });
  add("bsp, triangle", [&](SoftShadowConfig& c) { bsp(c), c.grouping = SoftGrouping::triangle; });
  add("clip, triangle",
      [](SoftShadowConfig& c) { c.solver = SoftSolver::clip, c.grouping = SoftGrouping::triangle; });
  add("bsp, random", [&](SoftShadowConfig& c) { bsp(c), c.choice = OccluderChoice::random; });
  add("bsp, new trees", [&](SoftShadowConfig& c) { bsp(c), c.keep_trees = false; });
  return out;
}

void expect_same_for_all_choices(const SoftCase& c) {
  for (const SoftPrecision precision : both) {
    const SoftMask expected = traced(c, SoftPrecision::reference);
    const double white = white_of(c, expected);
    const double bound =
        precision == SoftPrecision::reference ? 2 * reference_bound : fast_bound + reference_bound;
    for (const auto& [name, config] : choices()) {
      const SoftMask mask = traced(c, precision, config);
      EXPECT_LE(distance(mask, expected), bound)
          << c.name << ", " << name << ", precision " << int(precision);
      for (std::size_t i = 0; i < c.size(); ++i)
        ASSERT_LE(std::abs(double(mask.irradiance[i]) - double(expected.irradiance[i])), bound * white + 1e-6)
            << describe(c, i) << ", " << name << ", precision " << int(precision);
    }
  }
}

TEST(SoftMetamorphic, SolversGroupingsAndChoicesGiveTheSameAnswer) {
  expect_same_for_all_choices(room_case(11));
  expect_same_for_all_choices(
      frame_case(bundled_frames[2], 16, 9));  // a new tree a point takes long in foliage
  expect_same_for_all_choices(frame_case(bart_frames[0], 40, 22));
  expect_same_for_all_choices(frame_case(bart_frames[1], 40, 22));
}

TEST(SoftMetamorphic, InstructionSetsAndThreadsGiveTheSameBits) {
  std::vector<SoftCase> cases{room_case(12, 400), frame_case(bundled_frames[2], 48, 27)};
  for (SoftCase& c : cases)
    for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip}) {
      c.config.solver = solver;
      for (const SoftPrecision precision : both) {
        c.config.simd = SimdLevel::automatic;
        const SoftMask expected = traced(c, precision);
        EXPECT_GT(penumbra_of(expected), 50u);
        for (const int threads : {1, 2, 3, 7})
          with_threads(threads, [&] {
            EXPECT_TRUE(same_bits(traced(c, precision), expected))
                << c.name << ", " << soft_solver_name(solver) << ", " << threads << " threads";
          });
        for (const SimdLevel level :
             {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
          if (!simd_level_supported(level)) continue;
          c.config.simd = level;
          EXPECT_TRUE(same_bits(traced(c, precision), expected))
              << c.name << ", " << soft_solver_name(solver) << ", " << simd_level_name(level);
        }
      }
    }
}

TEST(SoftMetamorphic, BuffersOfEarlierCallsDoNotMatter) {
  const SoftCase first = room_case(13), second = frame_case(bundled_frames[0], 64, 36);
  SoftShadowTracer tracer;
  for (const SoftCase* c : {&first, &second, &first}) {
    SoftMask mask;
    ASSERT_TRUE(
        tracer.trace(seen_from(c->points, c->view), c->normals, c->soup.view(), c->light, c->config, mask));
    EXPECT_TRUE(same_bits(mask, traced(*c, c->config))) << c->name;
  }
}

TEST(SoftMetamorphic, AStopIsHeard) {
  const SoftCase c = frame_case(bundled_frames[2], 320, 180);
  SoftShadowTracer tracer;
  SoftMask mask;
  StopFlag stop;
  stop.request();
  EXPECT_FALSE(
      tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, c.config, mask, &stop));
  stop.reset();
  EXPECT_TRUE(
      tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, c.config, mask, &stop));
  EXPECT_TRUE(same_bits(mask, traced(c, c.config))) << "after a stop";
}

// The frame after a stop is as if there had been none.
TEST(SoftMetamorphic, AStopAtAnyTimeLeavesNothingBehind) {
  SoftCase c = frame_case(bundled_frames[2], 320, 180), small = frame_case(bundled_frames[2], 64, 36);
  c.config.solver = small.config.solver = SoftSolver::clip;  // point after point
  SoftStats expected;
  const SoftMask mask_of_small = traced(small, small.config, &expected);
  SoftShadowTracer tracer;
  SoftMask mask;
  int stopped = 0;
  for (int i = 0; i < 24; ++i) {
    StopFlag stop;
    std::thread asker([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5 * i));
      stop.request();
    });
    if (!tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, c.config, mask, &stop))
      ++stopped;
    asker.join();
    ASSERT_TRUE(tracer.trace(seen_from(small.points, small.view), small.normals, small.soup.view(),
                             small.light, small.config, mask));
    EXPECT_TRUE(same_bits(mask, mask_of_small)) << "after " << 5 * i << " ms";
    EXPECT_EQ(tracer.stats().points_lit, expected.points_lit);
  }
  EXPECT_GT(stopped, 0);
}

TEST(SoftMetamorphic, EmptyInputsGiveEmptyMasks) {
  SoftCase c;
  c.light = square_light({0, 1, 0}, {0, 0, 0}, 1);
  EXPECT_TRUE(traced(c, c.config).visible_fraction.empty());
  c.points.width = 3, c.points.height = 2;
  c.points.positions.resize(6), c.points.triangles.assign(6, no_triangle);
  EXPECT_EQ(traced(c, c.config).visible_fraction, std::vector<float>(6, 0.0f));
  c.soup.quad({-4, -1, -4}, {0, 0, 8}, {8, 0, 0});
  c.points.positions[4] = {0, -1, 0}, c.points.triangles[4] = 1;
  const std::vector<float> one{0, 0, 0, 0, 1, 0};
  EXPECT_EQ(traced(c, c.config).visible_fraction, one);
}

}  // namespace
}  // namespace tenebra::testing
