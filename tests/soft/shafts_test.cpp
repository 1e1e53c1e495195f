// No triangle that blocks a line is ever left out, and no group is called lit or dark that is not: exact
// arithmetic on lines from the groups' points to the light.
#include "soft/shafts.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "parallel/parallel.h"
#include "reference/exact_segment.h"
#include "soft/soft_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

/// What a group was given.
struct Given {
  GroupClass kind = GroupClass::lit;
  std::vector<std::uint32_t> candidates;
  bool operator==(const Given&) const = default;
};

std::vector<Given> given(const SoftCase& c, const PointGroups& groups, SimdLevel simd = SimdLevel::automatic,
                         ShaftStats* stats = nullptr) {
  std::vector<Given> all(groups.groups.size());
  std::vector<int> calls(all.size(), 0);
  ShaftCuller culler;
  SoftShadowConfig config;
  config.simd = simd;
  EXPECT_TRUE(
      culler.for_each_group(groups, c.soup.view(), c.light, config, nullptr,
                            [&](const PointGroup& group, auto candidates, GroupClass kind, int thread) {
                              const auto i = static_cast<std::size_t>(&group - groups.groups.data());
                              all[i] = {kind, {candidates.begin(), candidates.end()}};
                              ++calls[i];
                              EXPECT_LT(thread, thread_count());
                            }));
  EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(calls.size()));
  if (stats != nullptr) *stats = culler.stats();
  return all;
}

PointGroups grouped(const SoftCase& c, SoftGrouping grouping = SoftGrouping::neighbourhood) {
  PointGroups groups;
  group_points(c.points, c.view, c.soup.view(), c.light, grouping, groups);
  return groups;
}

/// Sums over the comparisons of a test.
struct Tally {
  std::uint64_t lines = 0, dropped = 0, kept = 0, blocked = 0, lit = 0, dark = 0, mixed = 0;
  void print(const char* what) const {
    std::printf(
        "%s: %llu tests of lines (%llu blocked by candidates); pairs of group and triangle: %llu "
        "dropped, %llu kept; groups: %llu lit, %llu dark, %llu mixed\n",
        what, static_cast<unsigned long long>(lines), static_cast<unsigned long long>(blocked),
        static_cast<unsigned long long>(dropped), static_cast<unsigned long long>(kept),
        static_cast<unsigned long long>(lit), static_cast<unsigned long long>(dark),
        static_cast<unsigned long long>(mixed));
  }
};

/// Lines that the rule asks about: from a point in front of the light to a point of the light on the seen
/// side.
struct Line {
  dvec3 p, q;
  std::uint32_t receiver;
};
std::vector<Line> lines_of(const SoftCase& c, const PointGroups& groups, const PointGroup& group,
                           Random& random, int count) {
  std::vector<Line> lines;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t k = random.index(group.count);
    const Line line{groups.positions_of(group)[k], random_light_point(c.light, random),
                    groups.triangles_of(group)[k]};
    const int side = seen_side(c.soup.view(), line.receiver, c.view);
    if (!(glm::dot(line.p - c.light.centre, c.light.normal) > 0)) continue;
    if (reference::height_sign(corners_of(c.soup.view(), line.receiver), line.q) != side) continue;
    lines.push_back(line);
  }
  return lines;
}

std::string describe(const SoftCase& c, const Line& line, std::uint32_t id) {
  const Corners t = corners_of(c.soup.view(), id);
  std::string text =
      fmt::format("{}: triangle {}, receiver {}, P {:a} {:a} {:a}, Q {:a} {:a} {:a}, corners", c.name, id,
                  line.receiver, line.p.x, line.p.y, line.p.z, line.q.x, line.q.y, line.q.z);
  for (const glm::vec3& v : t.v) text += fmt::format(" ({:a} {:a} {:a})", v.x, v.y, v.z);
  return text;
}

/// A dark group's triangle blocks all of its lines; nothing but the candidates blocks any of the others'.
void check_group(const SoftCase& c, const Given& g, const std::vector<Line>& lines, Tally& tally) {
  const TriangleView view = c.soup.view();
  const auto blocks = [&](std::uint32_t id, const Line& line) {
    ++tally.lines;
    return id != line.receiver &&
           reference::blocks(corners_of(view, id), theta_of(view, id, line.receiver), line.p, line.q);
  };
  if (g.kind == GroupClass::dark) {
    ++tally.dark;
    ASSERT_EQ(g.candidates.size(), 1u);
    for (const Line& line : lines)
      ASSERT_TRUE(blocks(g.candidates[0], line)) << "not dark: " << describe(c, line, g.candidates[0]);
    return;
  }
  ++(g.kind == GroupClass::lit ? tally.lit : tally.mixed);
  ASSERT_EQ(g.candidates.empty(), g.kind == GroupClass::lit);
  std::vector<std::uint8_t> candidate(view.triangles.size(), 0);
  for (const std::uint32_t id : g.candidates) {
    ASSERT_EQ(candidate[id], 0) << "given twice";
    ASSERT_TRUE(view.casts_shadow.empty() || view.casts_shadow[id] != 0);
    candidate[id] = 1;
  }
  for (std::uint32_t id = 0; id < view.triangles.size(); ++id) {
    if (!view.casts_shadow.empty() && view.casts_shadow[id] == 0) continue;
    ++(candidate[id] != 0 ? tally.kept : tally.dropped);
    for (const Line& line : lines) {
      if (!blocks(id, line)) continue;
      ASSERT_NE(candidate[id], 0) << "left out: " << describe(c, line, id);
      ++tally.blocked;
    }
  }
}

void check(const SoftCase& c, Tally& tally, int lines_a_group,
           SoftGrouping grouping = SoftGrouping::neighbourhood) {
  const PointGroups groups = grouped(c, grouping);
  const std::vector<Given> all = given(c, groups);
  Random random(5);
  for (std::size_t i = 0; i < all.size(); ++i) {
    check_group(c, all[i], lines_of(c, groups, groups.groups[i], random, lines_a_group), tally);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

/// A light somewhere about the soup: beside or inside it, facing its middle or anywhere, tiny to huge.
AreaLight random_light(const Soup& soup, Random& random) {
  const dvec3 middle = 0.5 * (soup.low() + soup.high()), half = 0.5 * (soup.high() - soup.low());
  const double size = glm::length(half);
  const dvec3 centre = middle + half * random.in_cube(random.chance(0.5) ? 1.0 : 2.0);
  const dvec3 normal = random.chance(0.7) ? middle - centre : random.direction();
  const double radius = size * (random.chance(0.8) ? random.in(0.02, 0.3) : std::pow(10.0, random.in(-9, 1)));
  return regular_light(centre, glm::length(normal) > 0 ? normal : dvec3(0, 1, 0), radius,
                       3 + static_cast<int>(random.index(12)));
}

/// The light lies in the plane of a triangle of the soup, around one of its corners.
AreaLight light_in_plane(const Soup& soup, Random& random) {
  const auto id = random.index(static_cast<std::uint32_t>(soup.triangles.size()));
  const dvec3 a(soup.corner(id, 0)), b(soup.corner(id, 1)), c(soup.corner(id, 2));
  const dvec3 n = glm::cross(b - a, c - a);
  if (!(glm::length(n) > 0)) return random_light(soup, random);
  return regular_light(a, random.chance(0.5) ? n : -n, 0.3 * glm::length(b - a), 4);
}

ViewRays random_view(const Soup& soup, const AreaLight& light, Random& random) {
  ShadowLight eye;
  eye.position = glm::vec3(light.centre);
  if (random.chance(0.5)) return view_from_light(eye);
  const dvec3 middle = 0.5 * (soup.low() + soup.high()), half = soup.high() - soup.low();
  return pinhole(middle + half * random.in_cube(1), middle, 0.7, 32, 32);
}

SoftCase make_case(std::string name, Soup soup, AreaLight light, Random& random) {
  SoftCase c;
  c.name = std::move(name);
  c.soup = std::move(soup);
  c.light = std::move(light);
  c.view = random_view(c.soup, c.light, random);
  switch (random.index(3)) {
    case 0:
      c.points = points_on_triangles(c.soup, random, 150);
      break;
    case 1: {  // lines from the light's corners through edges and vertices
      ShadowLight corner;
      corner.position = c.light.vertices[random.index(static_cast<std::uint32_t>(c.light.vertices.size()))];
      c.points = points_behind_edges(c.soup, corner, random, 150);
      break;
    }
    default:
      c.points = view_samples(c.soup.view(), c.view, 24, 24);
  }
  return c;
}

TEST(Shafts, NeverLeaveOutATriangleThatBlocksInAnySoup) {
  Tally tally;
  for (const SoupMaker& maker : soup_makers()) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      Random random(1000 + seed);
      Soup soup = maker.make(random);
      AreaLight light = seed % 4 == 3 ? light_in_plane(soup, random) : random_light(soup, random);
      check(make_case(fmt::format("{}, seed {}", maker.name, seed), std::move(soup), light, random), tally,
            24);
      if (HasFatalFailure()) return;
    }
  }
  tally.print("soups");
  EXPECT_GT(tally.blocked, 20000u);
  EXPECT_GT(tally.dropped, tally.kept);
}

}  // namespace
}  // namespace tenebra::testing
