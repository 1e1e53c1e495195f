// The side of its triangle that a sample is on: stored, or that of the view that saw it.
#include "points/sample_sides.h"

#include <gtest/gtest.h>

#include "support/samples.h"

namespace tenebra::testing {
namespace {

Soup floor() {
  Soup soup;
  soup.quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  return soup;
}

VisiblePoints points_on(std::size_t count) {
  VisiblePoints points;
  points.width = static_cast<int>(count), points.height = 1;
  points.positions.assign(count, glm::dvec3(0));
  points.triangles.assign(count, 0);
  return points;
}

TEST(SampleSides, AreThoseThatTheViewSees) {
  const Soup soup = floor();
  VisiblePoints points = points_on(1);
  const auto side_from = [&](const ViewRays& view) {
    points.seen_from = view;
    return visible_side(points, soup.view(), 0);
  };
  EXPECT_EQ(side_from({.eye = {0, 1, 0}}), 1);
  EXPECT_EQ(side_from({.eye = {0, -1, 0}}), -1);
  EXPECT_EQ(side_from({.eye = {5, 0, 0}}), 0) << "edge-on";
  EXPECT_EQ(side_from({.eye = {0, -1, 0}, .d0 = {0.3f, -0.1f, 0}, .orthographic = true}), 1)
      << "rays that come down";
  EXPECT_EQ(side_from({.eye = {0, 1, 0}, .d0 = {1, 0, 1}, .orthographic = true}), 0);
}

TEST(SampleSides, AreWhatIsStored) {
  const Soup soup = floor();
  VisiblePoints points = points_on(3);
  points.seen_from = ViewRays{.eye = {0, 1, 0}};
  points.sides = {1, -1, 0};
  const TriangleView triangles = soup.view();
  points::SideFinder sides(points, triangles);
  EXPECT_TRUE(sides.differ());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(sides.at(i), points.sides[i]);
}

}  // namespace
}  // namespace tenebra::testing
