// Every active point is in one group; groups are small, lie together and know what they hold.
#include "soft/groups/point_groups.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "parallel/parallel.h"
#include "reference/exact_segment.h"
#include "soft/group_case.h"

namespace tenebra::testing {
namespace {

using glm::dvec3;

int seen_side(const TriangleView& triangles, std::uint32_t id, const ViewRays& view) {
  return points::eye_side(points::corners_of(triangles, id).v, view);
}

soft::PointGroups groups_by(const GroupCase& c, SoftGrouping grouping) {
  soft::PointGroups groups;
  soft::group_points(seen_from(c.points, c.view), c.soup.view(), c.light, grouping, groups);
  return groups;
}

/// How far, relative to what double resolves, the point is from being reached; below 0: reached for certain.
/// Seen edge-on: never reached.
double out_of_reach(const GroupCase& c, std::size_t pixel) {
  const std::uint32_t id = c.points.triangles[pixel];
  if (id == no_triangle || seen_side(c.soup.view(), id, c.view) == 0) return INFINITY;
  const dvec3 p = c.points.positions[pixel];
  const double size = glm::length(p) + glm::length(c.light.centre);
  double out = -glm::dot(p - c.light.centre, c.light.normal) / size;
  const points::Corners t = points::corners_of(c.soup.view(), id);
  const dvec3 a(t.v[0]), e(dvec3(t.v[1]) - a), f(dvec3(t.v[2]) - a);
  double below = INFINITY;
  for (const glm::dvec2& v : c.light.polygon) {
    const dvec3 q = light_point(c.light, v);
    const double height = glm::dot(glm::cross(e, f), q - a) * seen_side(c.soup.view(), id, c.view);
    below = std::min(below, -height / (glm::length(e) * glm::length(f) *
                                       (glm::length(q) + glm::length(a) + glm::length(c.light.centre))));
  }
  return std::max(out, below);
}

void expect_partition(const GroupCase& c, SoftGrouping grouping) {
  const soft::PointGroups groups = groups_by(c, grouping);
  std::vector<int> times(c.points.triangles.size(), 0);
  for (const soft::PointGroup& group : groups.groups)
    for (const std::uint32_t pixel : groups.pixels_of(group)) ++times[pixel];
  for (std::size_t i = 0; i < times.size(); ++i) {
    ASSERT_LE(times[i], 1) << c.name << ", pixel " << i;
    const double out = out_of_reach(c, i);
    ASSERT_TRUE(out > -1e-15 || times[i] == 1) << c.name << ", pixel " << i << " is reached: " << out;
    ASSERT_TRUE(out < 1e-12 || times[i] == 0) << c.name << ", pixel " << i << " is not: " << out;
  }
}

/// No direction finds a point of the group farther than its cell.
void expect_cell_around(const GroupCase& c, const soft::PointGroups& groups, const soft::PointGroup& group) {
  const soft::Cell& cell = group.cell;
  std::vector<dvec3> directions;
  for (int k = 0; k < 3; ++k) {
    directions.push_back(glm::cross(cell.axis[k], cell.axis[(k + 1) % 3]));
    directions.push_back(cell.axis[k]);
  }
  Random random(group.first);
  for (int i = 0; i < 6; ++i) directions.push_back(random.direction());
  for (const dvec3& m : directions) {
    const double size = std::abs(m.x) + std::abs(m.y) + std::abs(m.z);
    double reach = size * cell.slack;
    for (const dvec3& a : cell.axis) reach += std::abs(glm::dot(m, a));
    for (const std::uint32_t pixel : groups.pixels_of(group)) {
      const dvec3 p = c.points.positions[pixel] - c.light.centre;
      const double out = std::abs(glm::dot(m, p - cell.centre)) - reach;
      ASSERT_LE(out, 0x1p-48 * size * (cell.reach + glm::length(c.light.centre))) << c.name;
      ASSERT_LE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), cell.reach) << c.name;
    }
  }
}

void expect_true_groups(const GroupCase& c, SoftGrouping grouping) {
  const soft::PointGroups groups = groups_by(c, grouping);
  for (const soft::PointGroup& group : groups.groups) {
    ASSERT_GT(group.count, 0u);
    dvec3 low(INFINITY), high(-INFINITY);
    std::set<std::uint32_t> receivers, tiles;
    for (std::uint32_t i = 0; i < group.count; ++i) {
      const std::uint32_t pixel = groups.pixels_of(group)[i];
      const dvec3 p = c.points.positions[pixel];
      low = glm::min(low, p), high = glm::max(high, p);
      receivers.insert(c.points.triangles[pixel]);
      const auto width = static_cast<std::uint32_t>(c.points.width);
      tiles.insert(pixel / width / 8 * width + pixel % width / 8);
    }
    EXPECT_EQ(low, group.low);
    EXPECT_EQ(high, group.high);
    expect_cell_around(c, groups, group);
    std::vector<std::uint32_t> listed;
    for (const soft::Receiver& receiver : groups.receivers_of(group)) {
      listed.push_back(receiver.triangle);
      EXPECT_EQ(receiver.side, seen_side(c.soup.view(), receiver.triangle, c.view));
    }
    EXPECT_EQ(listed, std::vector<std::uint32_t>(receivers.begin(), receivers.end()));
    if (grouping == SoftGrouping::triangle) {
      EXPECT_EQ(receivers.size(), 1u);
    } else {
      EXPECT_EQ(tiles.size(), 1u);
      EXPECT_LE(group.count, soft::largest_neighbourhood);
    }
  }
}

void expect_true_tree(const soft::PointGroups& groups) {
  ASSERT_EQ(groups.nodes.empty(), groups.groups.empty());
  if (groups.nodes.empty()) return;
  EXPECT_EQ(groups.nodes[0].count, groups.groups.size());
  for (const soft::GroupNode& node : groups.nodes) {
    dvec3 low(INFINITY), high(-INFINITY);
    std::uint32_t points = 0;
    for (std::uint32_t g = node.first; g < node.first + node.count; ++g) {
      low = glm::min(low, groups.groups[g].low), high = glm::max(high, groups.groups[g].high);
      points += groups.groups[g].count;
    }
    ASSERT_EQ(low, node.low);
    ASSERT_EQ(high, node.high);
    ASSERT_EQ(points, node.points);
    ASSERT_EQ(node.children == 0, node.count == 1);
    if (node.children == 0) continue;
    const soft::GroupNode &a = groups.nodes[node.children], &b = groups.nodes[node.children + 1];
    ASSERT_EQ(a.first, node.first);
    ASSERT_EQ(b.first, a.first + a.count);
    ASSERT_EQ(a.count + b.count, node.count);
  }
}

TEST(PointGroups, HoldEveryActivePointOnceWithTrueBoxesAndReceivers) {
  int active = 0;
  for (const SoupMaker& maker : soup_makers()) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Random random(3000 + seed);
      Soup soup = maker.make(random);
      const AreaLight light = seed == 3 ? light_in_plane(soup, random) : random_light(soup, random);
      const GroupCase c =
          random_case(fmt::format("{}, seed {}", maker.name, seed), std::move(soup), light, random);
      for (const SoftGrouping grouping : {SoftGrouping::neighbourhood, SoftGrouping::triangle}) {
        expect_partition(c, grouping);
        expect_true_groups(c, grouping);
        expect_true_tree(groups_by(c, grouping));
        if (HasFatalFailure()) return;
        active += static_cast<int>(groups_by(c, grouping).groups.size());
      }
    }
  }
  EXPECT_GT(active, 1000);
}

/// A floor at y = 0, seen by a camera that looks down and ahead.
GroupCase stage(int width, int height) {
  GroupCase c;
  c.name = "stage";
  c.soup.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0});
  c.light = regular_light({0, 4, 0}, {0, -1, 0}, 0.5, 4);
  c.view = pinhole({0, 3, 3}, {0, 0, 0}, 0.4, width, height);
  c.points = view_samples(c.soup.view(), c.view, width, height);
  return c;
}

TEST(PointGroups, CoverPicturesOfAnySize) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 17}, {17, 1}, {7, 9}, {8, 8}, {9, 7}, {15, 16}, {33, 31}}) {
    const GroupCase c = stage(width, height);
    for (const SoftGrouping grouping : {SoftGrouping::neighbourhood, SoftGrouping::triangle}) {
      expect_partition(c, grouping);
      expect_true_groups(c, grouping);
    }
    std::uint32_t points = 0, expected = 0;
    for (const soft::PointGroup& group : groups_by(c, SoftGrouping::neighbourhood).groups)
      points += group.count;
    for (const std::uint32_t id : c.points.triangles) expected += id != no_triangle;
    EXPECT_EQ(points, expected);
    EXPECT_GT(points, 0u);
  }
}

TEST(PointGroups, OfNothingAreNone) {
  GroupCase c = stage(8, 8);
  c.points = {};
  for (const SoftGrouping grouping : {SoftGrouping::neighbourhood, SoftGrouping::triangle}) {
    const soft::PointGroups groups = groups_by(c, grouping);
    EXPECT_TRUE(groups.groups.empty() && groups.nodes.empty());
  }
}

// Pixels of one tile on the floor and on a table far above it.
TEST(PointGroups, AreSplitAtGapsInDepth) {
  GroupCase c = stage(8, 8);
  EXPECT_EQ(groups_by(c, SoftGrouping::neighbourhood).groups.size(), 1u);
  c.soup.quad({-4, 2, 2}, {0, 0, 8}, {8, 0, 0});
  c.points = view_samples(c.soup.view(), c.view, 8, 8);
  const soft::PointGroups groups = groups_by(c, SoftGrouping::neighbourhood);
  ASSERT_EQ(groups.groups.size(), 2u);
  for (const soft::PointGroup& group : groups.groups) EXPECT_LT(group.high.y - group.low.y, 1e-9);
}

// Any half of a full tile is a compact part of it, for solvers that take fewer points.
TEST(PointGroups, OrderTheirPointsAlongAZCurve) {
  const soft::PointGroups groups = groups_by(stage(8, 8), SoftGrouping::neighbourhood);
  ASSERT_EQ(groups.groups.size(), 1u);
  for (std::uint32_t part = 0; part < 4; ++part) {
    std::set<std::uint32_t> columns, rows;
    for (const std::uint32_t pixel : groups.pixels_of(groups.groups[0]).subspan(16 * part, 16))
      columns.insert(pixel % 8), rows.insert(pixel / 8);
    EXPECT_EQ(columns.size(), 4u);
    EXPECT_EQ(rows.size(), 4u);
  }
}

TEST(PointGroups, LeaveOutWhatTheLightCannotReach) {
  GroupCase c = stage(16, 16);
  c.light = regular_light({0, 4, 0}, {0, 1, 0}, 0.5, 4);  // shines up
  EXPECT_TRUE(groups_by(c, SoftGrouping::neighbourhood).groups.empty());
  c.light = regular_light({0, -4, 0}, {0, 1, 0}, 0.5, 4);  // below the floor
  EXPECT_TRUE(groups_by(c, SoftGrouping::neighbourhood).groups.empty());
  c.light = regular_light({0, 0, -2}, {0, 0, 1}, 0.5, 4);  // half of it below; half of the floor behind it
  std::uint32_t points = 0, expected = 0;
  for (const soft::PointGroup& group : groups_by(c, SoftGrouping::neighbourhood).groups)
    points += group.count;
  for (const dvec3& p : c.points.positions) expected += p.z > -2;
  EXPECT_EQ(points, expected);
  EXPECT_GT(points, 0u);
}

/// All that is known of the groups, bit for bit.
std::vector<double> numbers_of(const soft::PointGroups& groups) {
  std::vector<double> all;
  const auto add = [&](const dvec3& v) { all.insert(all.end(), {v.x, v.y, v.z}); };
  for (const soft::PointGroup& g : groups.groups) {
    all.insert(all.end(), {double(g.count), double(g.receiver_count), g.cell.slack, g.cell.reach});
    for (const std::uint32_t pixel : groups.pixels_of(g)) all.push_back(pixel);
    for (const dvec3& v : {g.low, g.high, g.cell.centre, g.cell.axis[0], g.cell.axis[1], g.cell.axis[2]})
      add(v);
    for (const soft::Receiver& r : groups.receivers_of(g)) {
      all.insert(all.end(), {double(r.triangle), double(r.side), r.tau, r.limit});
      add(r.m);
    }
  }
  for (const soft::GroupNode& n : groups.nodes) {
    all.insert(all.end(), {double(n.first), double(n.count), double(n.points), double(n.children)});
    add(n.low), add(n.high);
  }
  return all;
}

TEST(PointGroups, AreTheSameForAnyNumberOfThreadsAndAnyInstructions) {
  Random random(41);
  GroupCase c = stage(404, 301);
  c.soup.append(room(random, 100));
  c.points = view_samples(c.soup.view(), c.view, 404, 301);
  for (const SoftGrouping grouping : {SoftGrouping::neighbourhood, SoftGrouping::triangle}) {
    const std::vector<double> expected = numbers_of(groups_by(c, grouping));
    EXPECT_GT(expected.size(), 10000u);
    for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
      if (!simd_level_supported(level)) continue;
      for (const int threads : {1, 2, 3, 7})
        with_threads(threads, [&] {
          soft::PointGroups groups;
          soft::group_points(seen_from(c.points, c.view), c.soup.view(), c.light, grouping, groups, level);
          EXPECT_EQ(numbers_of(groups), expected) << simd_level_name(level);
        });
    }
  }
}

}  // namespace
}  // namespace tenebra::testing
