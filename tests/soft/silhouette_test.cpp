// Silhouettes of meshes: which edges cancel, how often the rest winds around a place of the light, and that
// they give what clipping gives.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "soft/light/light_frame.h"
#include "soft/silhouette/group_silhouette.h"
#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec2;
using glm::dvec3;

/// A floor below, a mesh between, a light above that looks down at them.
SoftCase below(const std::string& name, const Soup& mesh, int pixels = 40) {
  SoftCase c;
  c.name = name;
  c.soup.quad({-8, 0, -8}, {0, 0, 16}, {16, 0, 0});
  c.soup.append(mesh);
  c.light = square_light({0.4, 5, -0.3}, {0, 0, 0}, 2.5);
  c.view = pinhole({0, 3.6, 3.4}, {0, 0.2, 0}, 1.2, pixels, pixels);
  c.points = view_samples(c.soup.view(), c.view, pixels, pixels);
  return c;
}

/// The upper half of a sphere, open below.
Soup bowl(int rings) {
  const Soup whole = sphere(rings, 0.9, {0, 1.2, 0});
  Soup half = whole;
  half.triangles.clear();
  for (const glm::uvec3& t : whole.triangles)
    if (whole.positions[t.x].y > 1.2f) half.triangles.push_back(t);
  return half;
}

/// Every triangle twice, with both windings.
Soup two_sided(const Soup& mesh) {
  Soup both = mesh;
  for (const glm::uvec3& t : mesh.triangles) both.triangles.emplace_back(t.x, t.z, t.y);
  return both;
}

/// Corners of its own for every triangle: edges are shared by place alone.
Soup unwelded(const Soup& mesh) {
  Soup apart;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    apart.add(dvec3(mesh.corner(i, 0)), dvec3(mesh.corner(i, 1)), dvec3(mesh.corner(i, 2)));
  return apart;
}

Soup joined(Soup a, const Soup& b) {
  a.append(b);
  return a;
}

std::vector<SoftCase> mesh_cases() {
  const Soup ball = sphere(10, 0.8, {0.1, 1.4, 0}), ring = torus(48, 18, 0.9, 0.3).moved(1, {0, 1.1, 0.2});
  Random random(71);
  std::vector<SoftCase> cases;
  cases.push_back(below("sphere", ball));
  cases.push_back(below("torus", ring));
  cases.push_back(below("bowl", bowl(9)));
  cases.push_back(below("two-sided bowl", two_sided(bowl(8))));
  cases.push_back(below("unwelded sphere", unwelded(ball)));
  cases.push_back(below("sphere through torus", joined(ball, ring)));
  cases.push_back(below("half sunk sphere", sphere(10, 0.9, {0, 0.1, 0})));
  cases.push_back(below("sphere through the light", joined(ball, sphere(8, 0.6, {0.3, 5, -0.2}))));
  cases.push_back(below("sphere in a cloud", joined(ball, random_soup(random, 20, 0.3).moved(1, {0, 2, 0}))));
  Soup boxes, shells;
  for (int k = 0; k < 12; ++k) {  // they touch: edges of several boxes lie on each other
    const dvec3 low(0.3 * (k % 3) - 0.4, 0.9 + 0.3 * (k / 6), 0.3 * (k / 3 % 2) - 0.3);
    boxes.append(box(low, low + dvec3(0.3)));
  }
  for (int k = 0; k < 4; ++k) shells.append(sphere(6, 0.4 + 0.15 * k, {0.1 * k, 1.4, 0}));
  for (int heap = 0; heap < 4; ++heap) {  // silhouettes behind silhouettes
    Soup balls;
    for (int k = 0; k < 16; ++k) {
      const dvec3 centre(1.6 * random.unit() - 0.8, 0.9 + 1.2 * random.unit(), 1.6 * random.unit() - 0.8);
      balls.append(k % 4 == 3 ? torus(14, 6, 0.3, 0.08).moved(1, centre)
                              : sphere(3, 0.1 + 0.3 * random.unit(), centre));
    }
    cases.push_back(below(fmt::format("heap {}", heap), balls));
  }
  cases.push_back(below("boxes that touch", boxes));
  cases.push_back(below("spheres in spheres", shells));
  cases.push_back(below("tilted wall", tilted_wall(random).moved(0.8, {0, 1.5, 0})));
  return cases;
}

/// Points on the floor, below the mesh.
soft::GroupFrame floor_group() {
  soft::GroupFrame group;
  group.centre = {0.2, 0, 0.1};
  group.half = {0.15, 0, 0.15};
  return group;
}

std::vector<std::uint32_t> mesh_of(const SoftCase& c) {
  std::vector<std::uint32_t> all(c.soup.triangles.size() - 2);
  std::iota(all.begin(), all.end(), 2u);
  return all;
}

soft::GroupCandidates candidates_of(const SoftCase& c, const soft::GroupFrame& group) {
  soft::GroupCandidates candidates;
  soft::find_candidates_kernel(SimdLevel::automatic)(soft::light_frame(c.light), c.soup.view(), group,
                                                     mesh_of(c), candidates, nullptr);
  return candidates;
}

TEST(SoftSilhouette, OfAClosedMeshIsItsSilhouette) {
  const SoftCase c = below("sphere", sphere(12, 0.8, {0.1, 1.4, 0}));
  soft::GroupFrame group = floor_group();
  group.half *= 0.25;
  soft::GroupSilhouette silhouette;
  std::vector<std::uint32_t> rest;
  soft::SilhouetteFinder().find(soft::light_frame(c.light), c.soup.view(), candidates_of(c, group),
                                silhouette, rest);
  EXPECT_TRUE(rest.empty());
  std::size_t always = 0;
  for (const soft::SilhouetteEdge& edge : silhouette.edges) always += edge.winding != 0;
  EXPECT_GT(always, 24u);
  EXPECT_LT(silhouette.edges.size(), 300u) << "of " << c.soup.triangles.size() << " triangles";
  for (const soft::SilhouetteUse& use : silhouette.uses) EXPECT_LT(use.edge, silhouette.edges.size());
}

TEST(SoftSilhouette, LeavesLooseTrianglesAlone) {
  Random random(5);
  const SoftCase c = below("cloud", random_soup(random, 200, 0.2).moved(1, {0, 2, 0}));
  soft::GroupSilhouette silhouette;
  std::vector<std::uint32_t> rest;
  const soft::GroupCandidates candidates = candidates_of(c, floor_group());
  soft::SilhouetteFinder().find(soft::light_frame(c.light), c.soup.view(), candidates, silhouette, rest);
  EXPECT_TRUE(silhouette.empty());
  EXPECT_EQ(rest.size(), candidates.all.size());
}

/// Twice the signed area of a, b, c; 0 where rounding might decide.
double turn(dvec2 a, dvec2 b, dvec2 c) {
  const double x = (b.x - a.x) * (c.y - a.y), y = (b.y - a.y) * (c.x - a.x);
  return std::abs(x - y) > 1e-9 * (std::abs(x) + std::abs(y)) ? x - y : 0;
}

// The definition again, from projected corners: +1 an edge that the ray from q towards +u crosses upwards.
double winding_around(dvec2 q, const soft::GroupSilhouette& silhouette, const std::vector<int>& signs,
                      double point_height, double light_height, dvec2 point, bool& sure) {
  std::vector<double> winding;
  for (const soft::SilhouetteEdge& edge : silhouette.edges) winding.push_back(edge.winding);
  for (const soft::SilhouetteUse& use : silhouette.uses)
    winding[use.edge] += use.winding * signs[use.blocker];
  double sum = 0;
  for (std::size_t i = 0; i < silhouette.edges.size(); ++i) {
    const auto projected = [&](dvec3 v) {
      return point + (dvec2(v) - point) * ((light_height - point_height) / (v.z - point_height));
    };
    const dvec2 a = projected(silhouette.edges[i].from), b = projected(silhouette.edges[i].to);
    if ((a.y > q.y) == (b.y > q.y)) continue;
    const double left = turn(a, b, q);
    sure &= left != 0;
    if (b.y > q.y && left > 0) sum += winding[i];
    if (a.y > q.y && left < 0) sum -= winding[i];
  }
  return sum;
}

/// Triangles of the mesh, but those left out, that the segment from p to q passes through, by signed volumes.
int covering(const SoftCase& c, const std::vector<std::uint32_t>& left_out, dvec3 p, dvec3 q, bool& sure) {
  const auto volume = [&](dvec3 a, dvec3 b, dvec3 d) {
    const double v = glm::dot(glm::cross(a - p, b - p), d - p);
    sure &= std::abs(v) > 1e-9 * glm::length(a - p) * glm::length(b - p) * glm::length(d - p);
    return v;
  };
  int count = 0;
  for (std::uint32_t id = 2; id < c.soup.triangles.size(); ++id) {
    if (std::find(left_out.begin(), left_out.end(), id) != left_out.end()) continue;
    const dvec3 a(c.soup.corner(id, 0)), b(c.soup.corner(id, 1)), d(c.soup.corner(id, 2));
    const double x = volume(a, b, q), y = volume(b, d, q), z = volume(d, a, q);
    if (!((x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0))) continue;
    const dvec3 n = glm::cross(b - a, d - a);
    count += glm::dot(n, p - a) * glm::dot(n, q - a) < 0;
  }
  return count;
}

TEST(SoftSilhouette, WindsAroundAPlaceOnceForEachTriangleInFrontOfIt) {
  const Soup ball = sphere(10, 0.8, {0.1, 1.4, 0}), ring = torus(48, 18, 0.9, 0.3).moved(1, {0, 1.1, 0.2});
  Random random(72);
  std::size_t compared = 0, covered = 0, dropped = 0;
  for (const Soup& mesh : {ball, ring, bowl(9), two_sided(bowl(8)), joined(ball, ring)}) {
    const SoftCase c = below("mesh", mesh);
    const soft::LightFrame light = soft::light_frame(c.light);
    const soft::GroupFrame group = floor_group();
    soft::GroupSilhouette silhouette;
    std::vector<std::uint32_t> rest;
    const soft::GroupCandidates candidates = candidates_of(c, group);
    soft::SilhouetteFinder().find(light, c.soup.view(), candidates, silhouette, rest);
    for (std::uint32_t& place : rest) place = candidates.all[place].triangle;
    ASSERT_FALSE(silhouette.empty());
    ASSERT_LT(rest.size(), c.soup.triangles.size() / 4);
    soft::GroupSilhouette near = silhouette;
    soft::drop_beside_light(group, candidates.axes, near);
    dropped += silhouette.edges.size() - near.edges.size();
    for (int k = 0; k < 400; ++k) {
      const dvec3 p = group.centre + dvec3(2 * random.unit() - 1, 0, 2 * random.unit() - 1) * group.half;
      std::vector<int> signs;
      for (const soft::SometimesBlocker& blocker : silhouette.sometimes)
        signs.push_back(soft::blocking_sign(blocker.plane, p - group.centre, 0));
      const dvec2 q(2 * random.unit() - 1, 2 * random.unit() - 1);
      const dvec3 at = candidates.axes.of(p - group.centre);
      bool sure = true;
      const auto winding_of = [&](const soft::GroupSilhouette& edges) {
        return winding_around(q - dvec2(candidates.axes.centre_uv), edges, signs, at.z,
                              candidates.axes.centre_uv.z, dvec2(at), sure);
      };
      const double winding = winding_of(silhouette), winding_near = winding_of(near);
      const int count = covering(c, rest, p, light.point(q), sure);
      if (!sure) continue;
      EXPECT_EQ(winding_near, winding) << "without the edges beside the light";
      EXPECT_EQ(winding, count) << c.soup.triangles.size() << " triangles, P " << p.x << " " << p.z << ", q "
                                << q.x << " " << q.y;
      ++compared;
      covered += count > 0;
    }
  }
  EXPECT_GT(compared, 1000u);
  EXPECT_GT(covered, 200u);
  EXPECT_GT(dropped, 100u);
}

TEST(SoftSilhouette, GivesWhatClippingGives) {
  std::size_t between = 0, by_silhouette = 0;
  for (SoftCase& c : mesh_cases()) {
    SoftStats stats;
    SoftShadowConfig config;
    config.solver = SoftSolver::clip;
    const SoftMask expected = traced(c, SoftPrecision::reference, config);
    config.solver = SoftSolver::automatic;
    const SoftMask precise = traced(c, SoftPrecision::reference, config, &stats);
    by_silhouette += stats.points_silhouette;
    const SoftMask fast = traced(c, SoftPrecision::fast);
    const double white = white_of(c, expected);
    for (std::size_t i = 0; i < c.size(); ++i) {
      between += expected.visible_fraction[i] > 0 && expected.visible_fraction[i] < 1;
      // Fractions are floats: 6e-8 of rounding on either side.
      EXPECT_NEAR(precise.visible_fraction[i], expected.visible_fraction[i], 2e-7) << describe(c, i);
      EXPECT_NEAR(fast.visible_fraction[i], expected.visible_fraction[i], fast_bound) << describe(c, i);
      EXPECT_NEAR(fast.irradiance[i], expected.irradiance[i], fast_bound * white) << describe(c, i);
    }
  }
  EXPECT_GT(between, 1500u);
  EXPECT_GT(by_silhouette, 1500u);
}

TEST(SoftSilhouette, IsExact) {
  Judgement sum;
  judge_all(below("small sphere", sphere(3, 0.8, {0.1, 1.4, 0}), 24), sum);
  judge_all(below("small torus", torus(14, 6, 0.9, 0.3).moved(1, {0, 1.1, 0.2}), 24), sum);
  judge_all(below("small bowl", two_sided(bowl(3)), 24), sum);
  Soup shells;
  for (int k = 0; k < 3; ++k) shells.append(sphere(2, 0.4 + 0.2 * k, {0.1 * k, 1.4, 0}));
  judge_all(below("spheres in spheres", shells, 24), sum);
  sum.print("silhouettes");
  EXPECT_GT(sum.penumbra, 300u);
}

// Found in BART's kitchen: a part of the light thinner than rounding was halved without end.
TEST(SoftSilhouette, ThinPartsUnderManyOccludersEnd) {
  Soup stack;
  for (int k = 0; k < 80; ++k) {
    const double y = 1 + 0.01 * k;
    stack.quad({-1, y, 1e-7 * k}, {2, 0, 0}, {0, 0, 1});
    stack.quad({-1, y, -1 - 1e-7 * (80 - k)}, {2, 0, 0}, {0, 0, 1});
  }
  SoftCase c = below("slots", stack, 24);
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::clip}) {
    c.config.solver = solver;
    const SoftMask mask = traced(c, SoftPrecision::fast), precise = traced(c, SoftPrecision::reference);
    for (std::size_t i = 0; i < c.size(); ++i)
      EXPECT_NEAR(mask.visible_fraction[i], precise.visible_fraction[i], fast_bound) << describe(c, i);
  }
}

// The silhouette of a sheet beside the light runs along the ray on which windings are counted, level with the
// middle of the light: rounding of a turned scene decides which of its edges the ray seems to meet.
TEST(SoftSilhouette, SeesPastEdgesLevelWithTheMiddleOfTheLight) {
  Random random(94);
  std::size_t by_silhouette = 0;
  for (int round = 0; round < 60; ++round) {
    const dvec3 axis(2 * random.unit() - 1, 2 * random.unit() - 1, 2 * random.unit() - 1);
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), 6.28 * random.unit(), glm::normalize(axis)));
    SoftCase c;
    c.name = fmt::format("seed 94, round {}", round);
    c.soup.quad(turn * dvec3(-3, 0, -3), turn * dvec3(0, 0, 6), turn * dvec3(6, 0, 0));
    constexpr int cells = 24;
    for (int i = 0; i < cells * cells; ++i) {
      const dvec3 corner(0.6 + 0.6 / cells * (i % cells), 2, 0.5 / cells * (i / cells));
      c.soup.quad(turn * corner, turn * dvec3(0.6 / cells, 0, 0), turn * dvec3(0, 0, 0.5 / cells));
    }
    c.light = must(make_rectangle_light(turn * dvec3(0, 4, 0), turn * dvec3(1, 0, 0), turn * dvec3(0, 0, 1)));
    c.view = pinhole(turn * dvec3(0, 3, 2), dvec3(0), 1, 8, 8);
    c.points.width = c.points.height = 8;
    for (int i = 0; i < 64; ++i) {  // from some of them the sheet does reach into the light
      c.points.positions.push_back(turn * dvec3(0.06 * (i % 8), 0, 4e-8 * (random.unit() - 0.5)));
      c.points.triangles.push_back(0);
    }
    SoftStats stats;
    const SoftMask mask = traced(c, c.config, &stats);
    by_silhouette += stats.points_silhouette;
    for (std::size_t i = 0; i < c.size(); ++i) {
      const double width = std::max(0.0, 0.06 * static_cast<double>(i % 8) - 0.2);
      EXPECT_NEAR(mask.visible_fraction[i], 1 - width / 4, 1e-6) << describe(c, i);
    }
  }
  EXPECT_GT(by_silhouette, 1000u);
}

}  // namespace
}  // namespace tenebra::testing
