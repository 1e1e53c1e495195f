// One comparison of the tests of the soft shadows: what is asked of the tracer, and what the oracle says.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include <tenebra/soft_shadows.h>
#include "formats/import_scene.h"
#include "oracle/exact_soft.h"
#include "parallel/parallel.h"
#include "support/samples.h"
#include "support/scaled.h"
#include "support/soft_precision.h"
#include "support/soup.h"

namespace tenebra::testing {

/// Everything a soft mask depends on.
struct SoftCase {
  std::string name;  ///< printed with a failure: generator, light, seed
  Soup soup;
  AreaLight light;
  ViewRays view;
  VisiblePoints points;
  std::vector<glm::vec3> normals;  ///< one for each pixel, or empty
  SoftShadowConfig config;
  SoftPrecision precision = SoftPrecision::fast;

  std::size_t size() const { return points.positions.size(); }
};

inline SoftMask traced(const SoftCase& c, SoftPrecision precision, const SoftShadowConfig& config,
                       SoftStats* stats = nullptr) {
  SoftShadowTracer tracer = soft_tracer(precision);
  SoftMask mask;
  EXPECT_TRUE(tracer.trace(seen_from(c.points, c.view), c.normals, c.soup.view(), c.light, config, mask))
      << c.name;
  EXPECT_EQ(mask.visible_fraction.size(), c.size()) << c.name;
  EXPECT_EQ(mask.irradiance.size(), c.size()) << c.name;
  mask.visible_fraction.resize(c.size()), mask.irradiance.resize(c.size());
  if (stats != nullptr) *stats += tracer.stats();
  return mask;
}
inline SoftMask traced(const SoftCase& c, const SoftShadowConfig& config, SoftStats* stats = nullptr) {
  return traced(c, c.precision, config, stats);
}
inline SoftMask traced(const SoftCase& c, SoftPrecision precision) {
  return traced(c, precision, c.config);
}

/// The answers of the oracle at some pixels, on all cores. Pixels with more than 200 occluders (2,000 where
/// the tests are scaled up) are skipped.
inline std::vector<oracle::SoftAnswer> oracle(const SoftCase& c, const std::vector<std::size_t>& pixels) {
  const oracle::ExactSoft exact(c.view, c.soup.view(), c.light);
  const std::size_t most = scaled(200) > 200 ? 2000 : 200;
  std::vector<oracle::SoftAnswer> answers(pixels.size());
  parallel::parallel_ranges(pixels.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      answers[k] = exact.answer(c.points.positions[pixels[k]], c.points.triangles[pixels[k]],
                                c.normals.empty() ? glm::vec3(0) : c.normals[pixels[k]],
                                oracle::SweepNumbers::long_double, most);
  });
  return answers;
}

/// The 99.9th percentile of a picture's irradiance among its pixels with a triangle.
inline double white_of(const SoftCase& c, const SoftMask& mask) {
  std::vector<float> values;
  for (std::size_t i = 0; i < c.size(); ++i)
    if (c.points.triangles[i] != no_triangle) values.push_back(mask.irradiance[i]);
  if (values.empty()) return 0;
  const std::size_t place = std::min(values.size() - 1, values.size() * 999 / 1000);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(place), values.end());
  return values[place];
}

/// RMS over what lies in penumbra, in 1/255 of white; the same measure as SoftShadowConfig::error_255.
inline double error_of(const SoftCase& c, const SoftMask& mask, const SoftMask& exact) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double off = static_cast<double>(mask.irradiance[i]) - static_cast<double>(exact.irradiance[i]);
    sum += off * off;
    count += exact.visible_fraction[i] > 0 && exact.visible_fraction[i] < 0.999f ? 1 : 0;
  }
  return 255 / white_of(c, exact) * std::sqrt(sum / static_cast<double>(count));
}

/// What is promised: reference 1e-6 of the fraction, and for lights that are small for their distance the
/// rounding of double there; fast 0.1/255 of white.
inline constexpr double reference_bound = 1e-6;
inline double reference_promise(const SoftCase& c) {
  double distance = c.light.at_infinity ? 1 : 0, size = 0;
  for (const glm::dvec2& v : c.light.polygon) size = std::max({size, std::abs(v.x), std::abs(v.y)});
  for (std::size_t i = 0; i < c.size(); ++i)
    if (c.points.triangles[i] != no_triangle && !c.light.at_infinity)
      distance = std::max(distance, glm::length(c.points.positions[i] - c.light.centre));
  return std::max(reference_bound, 0x1p-48 * distance / (size * glm::length(c.light.ex)));
}
inline constexpr double fast_bound = 0.1 / 255;
/// Irradiance that does not matter: where the light or the surface is seen edge-on but for roundings.
inline constexpr double least_irradiance = 1e-9;

/// Sums over the comparisons of a test; printed at its end.
struct Judgement {
  int scenes = 0;
  std::size_t points = 0, penumbra = 0, skipped = 0, most_occluders = 0;
  double reference_error = 0;       ///< of the fraction
  double fast_fraction = 0;         ///< error of the fraction by the fast default
  double fast_irradiance = 0;       ///< of white
  double fast_unoccluded = 0;       ///< of the unoccluded irradiance at the point
  double reference_irradiance = 0;  ///< of the unoccluded irradiance at the point
  void print(const std::string& what) const {
    std::printf(
        "%s: %d scenes, %zu points (%zu penumbra, %zu skipped), up to %zu occluders; reference: fraction "
        "%.2g, irradiance %.2g; fast, in 1/255: fraction %.4f, irradiance %.4f of white, %.4f of the "
        "unoccluded\n",
        what.c_str(), scenes, points, penumbra, skipped, most_occluders, reference_error,
        reference_irradiance, 255 * fast_fraction, 255 * fast_irradiance, 255 * fast_unoccluded);
  }
};

inline std::string describe(const SoftCase& c, std::size_t i) {
  const glm::dvec3 p = c.points.positions[i];
  std::string text = fmt::format("{}: pixel {}, P {:a} {:a} {:a}, id {}, {} triangles, light", c.name, i, p.x,
                                 p.y, p.z, c.points.triangles[i], c.soup.triangles.size());
  for (const glm::vec3& v : c.light.vertices) text += fmt::format(" ({:a} {:a} {:a})", v.x, v.y, v.z);
  return text;
}

/// The masks of both precisions against the oracle's `answers` at `pixels`; `white` scales the fast error.
inline void judge(const SoftCase& c, const SoftMask& precise, const SoftMask& fast, double white,
                  const std::vector<std::size_t>& pixels, const std::vector<oracle::SoftAnswer>& answers,
                  Judgement& sum) {
  int told = 0;
  const double promised = reference_promise(c);
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const std::size_t i = pixels[k];
    const oracle::SoftAnswer& a = answers[k];
    sum.most_occluders = std::max(sum.most_occluders, a.occluders);
    if (a.skipped) {
      ++sum.skipped;
      continue;
    }
    ++sum.points;
    sum.penumbra += a.visible_fraction > 0 && a.irradiance < a.unoccluded * (1 - 1e-9);
    // Where the light's two descriptions disagree about its plane, only the irradiance, almost 0, is told.
    const double told_by = a.at_plane ? 0 : 1;
    const double by_reference = told_by * std::abs(precise.visible_fraction[i] - a.visible_fraction);
    const double by_fast = told_by * std::abs(fast.visible_fraction[i] - a.visible_fraction);
    const double light_precise = std::abs(precise.irradiance[i] - a.irradiance);
    const double light = std::abs(fast.irradiance[i] - a.irradiance);
    const double open = a.unoccluded + least_irradiance;
    sum.reference_error = std::max(sum.reference_error, by_reference);
    sum.fast_fraction = std::max(sum.fast_fraction, by_fast);
    if (white > 0) sum.fast_irradiance = std::max(sum.fast_irradiance, light / white);
    sum.fast_unoccluded = std::max(sum.fast_unoccluded, light / open);
    sum.reference_irradiance = std::max(sum.reference_irradiance, light_precise / open);
    const bool good = by_reference <= promised && light <= fast_bound * (white + least_irradiance) &&
                      by_fast <= fast_bound && light_precise <= 1e-5 * open;
    if (good || ++told > 3) continue;
    ADD_FAILURE() << describe(c, i)
                  << fmt::format(
                         "\n  fraction {:.9f} (bound {:.1g}), reference {:.9f}, fast {:.9f}; irradiance "
                         "{:.9g} of {:.9g}, "
                         "reference {:.9g}, fast {:.9g}, white {:.9g}",
                         a.visible_fraction, a.error_bound, precise.visible_fraction[i],
                         fast.visible_fraction[i], a.irradiance, a.unoccluded, precise.irradiance[i],
                         fast.irradiance[i], white);
  }
  if (told > 3) ADD_FAILURE() << c.name << ": " << told << " of " << pixels.size() << " points wrong";
}

/// All pixels with a triangle.
inline std::vector<std::size_t> pixels_of(const SoftCase& c) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < c.size(); ++i)
    if (c.points.triangles[i] != no_triangle) pixels.push_back(i);
  return pixels;
}

/// Traces by all solvers in both precisions and judges every pixel of the case. White is what an open sky
/// would give at the brightest of the points.
inline void judge_all(SoftCase c, Judgement& sum) {
  const std::vector<std::size_t> pixels = pixels_of(c);
  const std::vector<oracle::SoftAnswer> answers = oracle(c, pixels);
  double white = 0;
  for (const oracle::SoftAnswer& a : answers) white = std::max(white, a.unoccluded);
  const std::string name = c.name;
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip}) {
    c.config.solver = solver;
    c.name = fmt::format("{}, {}", name, soft_solver_name(solver));
    judge(c, traced(c, SoftPrecision::reference), traced(c, SoftPrecision::fast), white, pixels, answers,
          sum);
  }
  ++sum.scenes;
}

/// A light that must be one.
inline AreaLight must(Expected<AreaLight> light) {
  if (!light) throw std::runtime_error(light.error().message);
  return *std::move(light);
}

/// A square of side `side` that faces `target`.
inline AreaLight square_light(glm::dvec3 position, glm::dvec3 target, double side) {
  const glm::dvec3 facing = glm::normalize(target - position);
  const glm::dvec3 any = std::abs(facing.y) > 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(any, facing)), y = glm::cross(facing, x);
  return must(
      make_rectangle_light(glm::vec3(position), glm::vec3(0.5 * side * x), glm::vec3(0.5 * side * y)));
}

/// `count` points (laid out as a square) on triangles behind edges, as seen from random points of the light,
/// with random normals: almost all of them lie in a penumbra. The eye is at the light.
inline void place_in_penumbra(SoftCase& c, Random& random, int count) {
  std::vector<std::pair<glm::dvec3, std::uint32_t>> found;
  for (int part = 0; part < 3; ++part) {
    const glm::dvec2 at = 0.9 * random.unit() *
                          c.light.polygon[random.index(static_cast<std::uint32_t>(c.light.polygon.size()))];
    ShadowLight from;
    from.position = glm::vec3(c.light.centre + at.x * c.light.ex + at.y * c.light.ey);
    const VisiblePoints points = points_behind_edges(c.soup, from, random, (count + 2) / 3);
    for (std::size_t i = 0; i < points.positions.size(); ++i)
      if (points.triangles[i] != no_triangle) found.emplace_back(points.positions[i], points.triangles[i]);
  }
  c.view = {};
  c.view.eye = glm::vec3(c.light.centre);
  c.points = {};
  c.points.width = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(found.size()))));
  c.points.height = c.points.width;
  const auto pixels = static_cast<std::size_t>(c.points.width) * static_cast<std::size_t>(c.points.height);
  c.points.positions.resize(pixels, glm::dvec3(0));
  c.points.triangles.resize(pixels, no_triangle);
  for (std::size_t i = 0; i < found.size(); ++i)
    std::tie(c.points.positions[i], c.points.triangles[i]) = found[i];
  c.normals.clear();
}

}  // namespace tenebra::testing
