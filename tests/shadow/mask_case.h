// One comparison of the tests of the shadow mask: what is asked of the tracer, and what the oracle says.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <tenebra/hard_shadows.h>
#include "oracle/exact_mask.h"
#include "parallel/parallel.h"
#include "support/samples.h"
#include "support/soup.h"

namespace tenebra::testing {

/// Everything a mask depends on.
struct MaskCase {
  std::string name;  ///< printed with a failure: generator, light, seed
  Soup soup;
  ShadowLight light;
  ViewRays view;
  VisiblePoints points;
  HardShadowConfig config;
};

inline constexpr Variant all_variants[] = {
    Variant::tiles,          Variant::precise,     Variant::precise_sorted, Variant::spheres,
    Variant::spheres_sorted, Variant::precise_sea, Variant::precise_eatp,   Variant::precise_seatp};

/// Sums over the comparisons of a test; printed at its end.
struct Shares {
  std::uint64_t samples = 0, active = 0, shadowed = 0;
  std::uint64_t leaf_tests = 0, float_unknown = 0, double_unknown = 0;
  std::uint64_t oracle_pairs = 0, oracle_exact = 0;
  int scenes = 0;
  void print(const char* what) const;
};

inline void Shares::print(const char* what) const {
  const double tests = static_cast<double>(leaf_tests > 0 ? leaf_tests : 1);
  std::printf(
      "%s: %d scenes, %llu samples (%llu active, %llu shadowed), %llu leaf tests: beyond float %.3g, beyond "
      "double "
      "%.3g; oracle: %llu pairs, %llu by integers\n",
      what, scenes, static_cast<unsigned long long>(samples), static_cast<unsigned long long>(active),
      static_cast<unsigned long long>(shadowed), static_cast<unsigned long long>(leaf_tests),
      static_cast<double>(float_unknown) / tests, static_cast<double>(double_unknown) / tests,
      static_cast<unsigned long long>(oracle_pairs), static_cast<unsigned long long>(oracle_exact));
}

inline ShadowMask traced(const MaskCase& c, ShadowTracer& tracer) {
  ShadowMask mask;
  tracer.trace_shadow_mask(seen_from(c.points, c.view), c.soup.view(), c.light, c.config, mask);
  return mask;
}
inline ShadowMask traced(const MaskCase& c) {
  ShadowTracer tracer;
  return traced(c, tracer);
}

/// Indices where two masks differ (all of them if the sizes do).
inline std::vector<std::size_t> differences(const ShadowMask& a, const ShadowMask& b) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    if (i >= a.size() || i >= b.size() || a[i] != b[i]) found.push_back(i);
  return found;
}

/// The first differing sample with all it takes to repeat it.
inline std::string describe(const MaskCase& c, const ShadowMask& mask, const ShadowMask& expected,
                            std::size_t i) {
  const glm::dvec3 p = c.points.positions[i];
  const std::uint32_t id = c.points.triangles[i];
  const glm::vec3 l = c.light.directional ? c.light.to_light : c.light.position;
  oracle::ExactMaskStats stats;
  const std::uint32_t blocker =
      oracle::ExactShadow(c.view, c.soup.view(), c.light, c.config).blocker(p, id, stats);
  std::string text = fmt::format(
      "{}: sample {} of {}: found {}, expected {}\n  P {:a} {:a} {:a}, id {}, light {:a} {:a} {:a}{}, "
      "variant {}, simd {}",
      c.name, i, mask.size(), i < mask.size() ? mask[i] : -1, i < expected.size() ? expected[i] : -1, p.x,
      p.y, p.z, id, l.x, l.y, l.z, c.light.directional ? " (directional)" : "",
      variant_name(c.config.variant), simd_level_name(c.config.simd));
  for (const std::uint32_t t : {id, blocker})
    for (int k = 0; k < 3 && t != no_triangle && t < c.soup.triangles.size(); ++k) {
      const glm::vec3 q = c.soup.corner(t, k);
      text += fmt::format("\n  {} {} corner {}: {:a} {:a} {:a}", t == id ? "own" : "blocker", t, k, q.x, q.y,
                          q.z);
    }
  return text;
}

inline ::testing::AssertionResult same_mask(const MaskCase& c, const ShadowMask& mask,
                                            const ShadowMask& expected) {
  const std::vector<std::size_t> wrong = differences(mask, expected);
  if (wrong.empty()) return ::testing::AssertionSuccess();
  if (mask.size() != expected.size())
    return ::testing::AssertionFailure()
           << c.name << ": " << mask.size() << " samples, expected " << expected.size();
  return ::testing::AssertionFailure() << wrong.size() << " of " << mask.size() << " samples differ; "
                                       << describe(c, mask, expected, wrong.front());
}

inline ShadowMask oracle(const MaskCase& c, oracle::ExactMaskStats* stats = nullptr) {
  return oracle::exact_mask(c.points, c.view, c.soup.view(), c.light, c.config, stats);
}

/// The tracer's mask must be the exact answer.
inline ::testing::AssertionResult exact(const MaskCase& c, Shares* shares = nullptr) {
  ShadowTracer tracer;
  oracle::ExactMaskStats stats;
  const ShadowMask mask = traced(c, tracer), expected = oracle(c, &stats);
  if (shares != nullptr) {
    shares->scenes += 1;
    shares->samples += stats.samples, shares->active += stats.active, shares->shadowed += stats.shadowed;
    shares->leaf_tests += tracer.stats().leaf_tests;
    shares->float_unknown += tracer.stats().float_unknown;
    shares->double_unknown += tracer.stats().double_unknown;
    shares->oracle_pairs += stats.pairs, shares->oracle_exact += stats.exact;
  }
  return same_mask(c, mask, expected);
}

/// All variants must give `expected`.
inline ::testing::AssertionResult all_variants_give(MaskCase c, const ShadowMask& expected) {
  for (const Variant variant : all_variants) {
    c.config.variant = variant;
    if (const auto result = same_mask(c, traced(c), expected); !result) return result;
  }
  return ::testing::AssertionSuccess();
}

/// A point light at `position`.
inline ShadowLight point_light(glm::dvec3 position) {
  ShadowLight light;
  light.position = glm::vec3(position);
  return light;
}
inline ShadowLight sun(glm::dvec3 to_light) {
  ShadowLight light;
  light.directional = true;
  light.to_light = glm::vec3(to_light);
  return light;
}

/// The same mask at every vector level and for any number of threads, which do the same work.
inline void expect_same_at_levels_and_threads(MaskCase c, const ShadowMask& expected) {
  std::uint64_t nodes = 0, leaf_tests = 0;
  for (const SimdLevel level :
       {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512, SimdLevel::automatic}) {
    if (!simd_level_supported(level)) continue;
    c.config.simd = level;
    for (const int threads : {1, 3, 16}) {
      ShadowTracer tracer;
      with_threads(threads, [&] { EXPECT_TRUE(same_mask(c, traced(c, tracer), expected)) << threads; });
      if (threads > 1) {
        EXPECT_EQ(tracer.stats().nodes, nodes);
        EXPECT_EQ(tracer.stats().leaf_tests, leaf_tests);
      }
      nodes = tracer.stats().nodes, leaf_tests = tracer.stats().leaf_tests;
    }
  }
}

}  // namespace tenebra::testing
