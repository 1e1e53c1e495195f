// Soft shadows of triangles from bytes: every solver gives the same bits at every vector level, and in its
// double the fraction of the oracle, for a part of the inputs in rational numbers.
#include <fmt/format.h>

#include <tenebra/soft_shadows.h>
#include "fuzz/soup_bytes.h"
#include "oracle/exact_soft.h"
#include "support/soft_precision.h"

namespace {

using namespace tenebra;

// What soft_precision.h promises; the points are less than 2^20 sizes of the light away.
constexpr double promised = 1e-6;

SoftMask traced(const fuzz::SoupCase& c, const AreaLight& light, const SoftShadowConfig& config,
                testing::SoftPrecision precision = testing::SoftPrecision::fast) {
  SoftMask mask;
  testing::soft_tracer(precision).trace(c.points, {}, c.soup.view(), light, config, mask);
  return mask;
}

/// Whether rounding may put the point before or behind the light's plane, where the fraction jumps.
bool in_plane(const AreaLight& light, const glm::dvec3& point) {
  const glm::dvec3 way = point - light.centre;
  return std::abs(glm::dot(glm::normalize(light.normal), way)) <=
         1e-12 * (glm::length(way) + glm::length(light.centre));
}

std::string light_text(const AreaLight& light) {
  std::string text = "\n  light";
  for (const glm::vec3& v : light.vertices) text += fmt::format(" ({} {} {})", v.x, v.y, v.z);
  return text;
}

void check_levels(const fuzz::SoupCase& c, const AreaLight& light, SoftShadowConfig config) {
  config.simd = SimdLevel::scalar;
  const SoftMask first = traced(c, light, config);
  for (const SimdLevel level : {SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    config.simd = level;
    const SoftMask mask = traced(c, light, config);
    if (mask.visible_fraction != first.visible_fraction || mask.irradiance != first.irradiance)
      fuzz::found(
          fmt::format("{} at {} has other bits", soft_solver_name(config.solver), simd_level_name(level)));
  }
}

void check_fractions(const fuzz::SoupCase& c, const AreaLight& light, const SoftShadowConfig& config,
                     const std::vector<oracle::SoftAnswer>& answers) {
  const SoftMask mask = traced(c, light, config, testing::SoftPrecision::reference);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const double off = std::abs(mask.visible_fraction[i] - answers[i].visible_fraction);
    if (!answers[i].at_plane && !in_plane(light, c.points.positions[i]) &&
        !(off <= promised + answers[i].error_bound))
      fuzz::found(fmt::format("{}: point {} sees {}, expected {}", soft_solver_name(config.solver), i,
                              mask.visible_fraction[i], answers[i].visible_fraction) +
                  light_text(light) + fuzz::describe(c));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::InputBytes bytes(data, size);
  const int how = bytes.byte();
  const bool rational = how % 16 == 0;
  const fuzz::SoupCase c = fuzz::soup_case(bytes, rational ? 5 : 12);
  const glm::vec3 at = bytes.vector(c.unit), x = bytes.vector(c.unit / 8), any = bytes.vector(1);
  const glm::vec3 y = glm::cross(x, any);
  auto light = make_rectangle_light(at, x, glm::length(y) > 0 ? y * (glm::length(x) / glm::length(y)) : y);
  if (!light) light = make_rectangle_light(at, {c.unit, 0, 0}, {0, 0, c.unit});  // shines down
  if (!light) return 0;
  const oracle::ExactSoft exact(c.view, c.soup.view(), *light);
  std::vector<oracle::SoftAnswer> answers;
  for (std::size_t i = 0; i < c.points.positions.size(); ++i)
    answers.push_back(
        exact.answer(c.points.positions[i], c.points.triangles[i], glm::vec3(0),
                     rational ? oracle::SweepNumbers::rational : oracle::SweepNumbers::long_double));
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip}) {
    SoftShadowConfig config;
    config.solver = solver;
    config.grouping = (how & 32) != 0 ? SoftGrouping::triangle : SoftGrouping::neighbourhood;
    check_levels(c, *light, config);
    check_fractions(c, *light, config, answers);
  }
  return 0;
}
