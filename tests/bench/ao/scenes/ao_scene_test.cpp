// The parts that whole scenes of ambient occlusion are measured with: truth, errors, the opponent's rays, its
// filter, and what it needs for an error.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "bench/ao/scenes/ao_scene_errors.h"
#include "bench/ao/scenes/ao_scene_match.h"
#include "bench/ao/scenes/ao_scene_peer.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

using glm::vec3;

constexpr float far_m = 1000;

/// A floor at y = 0 and, at x = 0, a wall that both end far away; points on the floor, `apart_m` apart in x.
struct Corner {
  AoSceneView view;
  explicit Corner(bool wall, int width = 16, int height = 16, float apart_m = 0.125f) {
    FrameGeometry& g = view.now.geometry;
    g.positions = {{-far_m, 0, -far_m}, {-far_m, 0, far_m}, {far_m, 0, far_m}, {far_m, 0, -far_m},
                   {0, -far_m, -far_m}, {0, -far_m, far_m}, {0, far_m, far_m}, {0, far_m, -far_m}};
    g.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (wall) g.triangles.insert(g.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
    g.casts_shadow.assign(g.triangles.size(), 1);
    VisiblePoints& points = view.now.points;
    points.width = width, points.height = height;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        points.positions.emplace_back(apart_m * (x + 1), 0, 0.125 * (y + 1));
        points.triangles.push_back(0);
        view.now.normals.emplace_back(0, 1, 0);
      }
    }
    view.reach_m = 1;
    view.before.geometry = g;
  }
  TruthQuestion question(int rays = 4096, int step = 1) const {
    return {view.now.triangles(), view.now.points, view.now.normals, view.reach_m, rays, step};
  }
};

/// Openness of a floor at `distance` from an endless wall, in reaches: of the directions at an angle p to the
/// wall's normal those meet it within the reach whose sine exceeds k / cos p; over these the cosine-weighted
/// integral of 1 - distance / reach is (1 - k / cos p)^2 / 2, and over p the closed form below.
double beside_a_wall(double k) {
  if (k >= 1) return 1;
  const double root = std::sqrt(1 - k * k);
  return 1 - (std::acos(k) - 2 * k * std::log((1 + root) / k) + k * root) / std::numbers::pi;
}

TEST(AoSceneTruth, MeetsTheClosedFormBesideAWall) {
  const Corner corner(true);
  const AoSceneTruth truth = cast_truth(corner.question());
  ASSERT_EQ(truth.pixels.size(), 256u);
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    const double distance = corner.view.now.points.positions[truth.pixels[k]].x;
    EXPECT_NEAR(truth.open[k], beside_a_wall(distance), 1e-3) << distance;
  }
  EXPECT_LT(beside_a_wall(0.125), 0.8);
}

TEST(AoSceneTruth, MirrorsRaysAtTheTriangle) {
  Corner open(false);
  for (vec3& normal : open.view.now.normals) normal = glm::normalize(vec3(1, 0.2f, 0));
  for (const float value : cast_truth(open.question(256)).open) EXPECT_EQ(value, 1);
}

TEST(AoSceneTruth, LooksAtTheLatticeWhereSomethingIsSeen) {
  Corner corner(true);
  corner.view.now.points.triangles[2 * 16 + 7] = no_triangle;
  const AoSceneTruth truth = cast_truth(corner.question(16, 5));
  EXPECT_EQ(truth.pixels, (std::vector<std::size_t>{34, 44, 114, 119, 124, 194, 199, 204}));
}

TEST(AoSceneTruth, IsKeptForTheSameQuestionOnly) {
  const testing::TemporaryFolder folder;
  const Corner corner(true);
  const auto sparse = find_truth(corner.question(64, 5), "a corner", folder.path());
  ASSERT_EQ(folder.names().size(), 1u);
  const auto all = find_truth(corner.question(64), "a corner", folder.path());
  EXPECT_EQ(folder.names().size(), 1u) << "one file for all steps";
  EXPECT_EQ(all.open, cast_truth(corner.question(64)).open);
  for (std::size_t k = 0; k < sparse.pixels.size(); ++k)
    EXPECT_EQ(sparse.open[k], all.open[sparse.pixels[k]]);

  const std::vector<float> written(256, 0.25f);
  std::ofstream(folder / folder.names()[0], std::ios::binary)
      .write(reinterpret_cast<const char*>(written.data()), 4 * 256);
  EXPECT_EQ(find_truth(corner.question(64), "a corner", folder.path()).open, written) << "read, not cast";
  Corner other(true);
  other.view.reach_m = 2;
  EXPECT_NE(find_truth(other.question(64), "a corner", folder.path()).open, written);
  EXPECT_NE(find_truth(corner.question(128), "a corner", folder.path()).open, written);
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(AoSceneErrors, AreThoseOfTheTruthsPixels) {
  AoSceneTruth truth{1, {}, {}};
  std::vector<float> values(250, 0.5f);
  for (std::size_t i = 0; i < 200; ++i) truth.pixels.push_back(i + 50), truth.open.push_back(0.5f);
  for (const std::size_t i : {60u, 70u}) values[i] = 0.5f + 3.0f / 255;
  values[80] = 0.5f - 12.0f / 255;
  values[10] = 0;  // not asked for
  const AoSceneErrors errors = scene_errors(values, truth);
  EXPECT_NEAR(errors.rms, std::sqrt((9 + 9 + 144) / 200.0), 1e-3);
  EXPECT_NEAR(errors.p99, 3, 1e-3) << "two of 200 are above what 198 do not exceed";
  EXPECT_NEAR(errors.worst, 12, 1e-3);
  const auto worst = worst_pixels(values, truth, 50, 2, 15);
  ASSERT_EQ(worst.size(), 2u);
  EXPECT_EQ(worst[0].pixel, 80u);
  EXPECT_EQ(worst[1].pixel, 60u) << "70 is near 80";
  values[100] = NAN;
  EXPECT_EQ(scene_errors(values, truth).worst, 255);
}

CostCurve curve(const char* name, bool converges, std::vector<RayCost> costs) {
  return {name, converges, std::move(costs)};
}

TEST(AoSceneMatch, IsALineInLogarithms) {
  // Error 8 / rays, 10 ms a ray.
  const std::vector curves{curve("a", true, {{1, 8, 10}, {4, 2, 40}, {16, 0.5, 160}})};
  for (const double rms : {7.0, 4.0, 2.0, 1.0, 0.5}) {
    const ErrorMatch match = match_error(curves, rms);
    EXPECT_NEAR(match.ms, 80 / rms, 1e-6);
    EXPECT_NEAR(match.rays, 8 / rms, 1e-6);
    EXPECT_FALSE(match.bound);
  }
  EXPECT_EQ(match_error(curves, 20).ms, 10) << "nobody casts less than the fewest rays";
}

TEST(AoSceneMatch, TakesTheFasterAndBoundsWhatNoneReaches) {
  const std::vector curves{curve("rays", true, {{1, 30, 10}, {4, 10, 40}, {16, 3, 160}}),
                           curve("filtered", false, {{1, 5, 12}, {4, 4, 42}, {16, 4, 162}})};
  EXPECT_EQ(match_error(curves, 5).name, "filtered");
  EXPECT_EQ(match_error(curves, 5).ms, 12);
  EXPECT_EQ(match_error(curves, 3.5).name, "rays") << "the filter's own error stays";
  EXPECT_TRUE(reaches(curves, 3));
  EXPECT_FALSE(reaches(curves, 2.9));
  const ErrorMatch bound = match_error(curves, 2);
  EXPECT_TRUE(bound.bound);
  EXPECT_EQ(bound.ms, 160) << "no filter gets there, however many rays";
}

TEST(AoScenePattern, IsTheCosineLatticeShiftedWithinItsCells) {
  for (const int rays : {1, 2, 4, 8, 64, 256}) {
    const AoScenePattern pattern(rays);
    glm::dvec3 mean(0.0);
    double apart = 0;
    for (int tile = 0; tile < 16; ++tile) {
      for (int i = 0; i < rays; ++i) {
        const PatternRow& row = pattern.rows(4 * (tile % 4), 4 * (tile / 4))[i];
        for (int lane = 0; lane < 16; ++lane) {
          const vec3 d(row.x[lane], row.y[lane], row.z[lane]), e(row.x[0], row.y[0], row.z[0]);
          EXPECT_NEAR(glm::length(d), 1, 1e-6);
          EXPECT_GE(d.z, 0);
          mean += glm::dvec3(d) / (256.0 * rays);
          apart += glm::distance(d, e) / (256.0 * rays);
        }
      }
    }
    // All shifts together are spread like the cosine, without gaps.
    EXPECT_NEAR(mean.z, 2.0 / 3, 0.01) << rays << " rays";
    EXPECT_NEAR(glm::length(glm::dvec2(mean)), 0, 0.03) << rays << " rays";
    EXPECT_LT(apart, 4 / std::sqrt(rays)) << rays << " rays: neighbours look the same way";
    EXPECT_GT(apart, 0.2 / std::sqrt(rays)) << rays << " rays: but not along the same rays";
  }
}

TEST(AoScenePeer, MeetsTheClosedFormBesideAWall) {
  const Corner corner(true);
  AoScenePeer peer(corner.view);
  peer.follow_ms();
  peer.trace_ms(1024, 1);
  peer.finish_ms({1, 0});
  const std::vector<float> open = peer.picture();
  for (std::size_t i = 0; i < open.size(); ++i)
    EXPECT_NEAR(open[i], beside_a_wall(corner.view.now.points.positions[i].x), 3e-3);
}

TEST(AoScenePeer, FiltersMendNoiseAndHalfResolutionIsJoined) {
  const Corner corner(true, 64, 64, 1.0f / 64);
  AoSceneTruth truth = cast_truth(corner.question(1024));
  AoScenePeer peer(corner.view);
  const auto rms = [&](const PeerVariant& variant) {
    peer.trace_ms(4, variant.step);
    peer.finish_ms(variant);
    return scene_errors(peer.picture(), truth).rms;
  };
  const double noisy = rms({1, 0});
  EXPECT_GT(noisy, 4);
  EXPECT_LT(rms({1, 1}), noisy / 3);
  EXPECT_LT(rms({2, 1}), noisy / 2);
}

/// Above 1 by a rounding, which once counted as no value at all.
TEST(AoScenePeer, KeepsTheConstantAndTheRange) {
  Corner open(false);
  open.view.reach_m = 8.857f;
  AoScenePeer peer(open.view);
  for (const int rays : {2, 16, 64}) {
    for (const PeerVariant& variant : peer_variants) {
      peer.trace_ms(rays, variant.step);
      peer.finish_ms(variant);
      for (const float value : peer.picture()) {
        EXPECT_NEAR(value, 1, 1e-5) << peer_variant_name(variant);
        EXPECT_LE(value, 1) << peer_variant_name(variant);
      }
    }
  }
}

/// Two sheets side by side in the picture, values 0 on the left one and 1 on the right one.
void expect_edge(const vec3& right_normal, float right_step_m) {
  Corner sheets(false, 32, 16, 0.01f);
  BenchFrame& frame = sheets.view.now;
  std::vector<float> from, to;
  PixelPlanes planes(frame, PixelGrid::of(frame.points, 1, {0, 0}));
  const PlaneLayout& layout = planes.layout();
  from.assign(layout.size(), 0.0f), to = from;
  for (int y = 0; y < 16; ++y) {
    for (int x = 16; x < 32; ++x) {
      const auto i = static_cast<std::size_t>(32 * y + x);
      frame.normals[i] = right_normal;
      frame.points.positions[i].y += double{right_step_m};
      from[static_cast<std::size_t>(layout.at(x, y))] = 1;
    }
  }
  planes.take();
  const AoFilterWeights weights{{1, 1, 0.5f}, 1 / 0.05f, 1 / 0.25f, 1 / 0.15f};
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; x += 16)
      ao_scene_kernels().filter(planes.view(), from.data(), to.data(), layout.at(x, y), layout.pitch(), 1,
                                weights);
    for (int x = 0; x < 32; ++x) EXPECT_EQ(to[static_cast<std::size_t>(layout.at(x, y))], x < 16 ? 0 : 1);
  }
}

TEST(AoSceneFilter, KeepsEdgesBetweenPlanes) {
  expect_edge({1, 0, 0}, 0);        // a fold
  expect_edge({0, 1, 0}, 0.1f);     // a step
  expect_edge({0, 0.8f, 0.6f}, 0);  // a bend
}

}  // namespace
}  // namespace tenebra::bench
