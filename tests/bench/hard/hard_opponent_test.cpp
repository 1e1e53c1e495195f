// The harder opponent measures what it claims: its masks are Tenebra's, whatever tree and packets it uses,
// but for the samples that its rounding and its biases decide.
#include <gtest/gtest.h>

#include "bench/common/bench_scenes.h"
#include "bench/hard/hard_opponent.h"
#include "bench/hard/hard_views.h"
#include "render/shadow_lights.h"

namespace tenebra::bench {
namespace {

constexpr TreeKind kinds[] = {TreeKind::rebuild,         TreeKind::refit,  TreeKind::two_level,
                              TreeKind::two_level_refit, TreeKind::medium, TreeKind::high};
constexpr double most_differing_samples = 0.005;

class HardOpponent : public ::testing::Test {
protected:
  // No side is a multiple of a tile's or a square's.
  static constexpr PictureSize size{203, 117};

  void SetUp() override {
    std::unique_ptr<testing::TemporaryFolder> made;
    const auto scene = load_scene(find_scene(bench_scene("city"), {}, made));
    ASSERT_TRUE(scene) << scene.error().message;
    evaluate_hard_view(*scene, 150, size, view_);
    for (const WorldLight& placed : view_.frame.lights)
      lights_.push_back(render::shadow_light(scene->lights[static_cast<std::size_t>(placed.light)], placed));
    ASSERT_EQ(lights_.size(), 2u);
    EXPECT_NE(lights_[0].directional, lights_[1].directional);
    for (const ShadowLight& light : lights_) {
      ShadowTracer().trace_shadow_mask(view_.frame.points, view_.frame.triangles(), light, {},
                                       masks_.emplace_back());
      const auto lit = std::count(masks_.back().begin(), masks_.back().end(), 255);
      EXPECT_GT(lit, 1000) << "nothing to compare";
      EXPECT_LT(lit, static_cast<std::ptrdiff_t>(masks_.back().size()) - 1000);
    }
  }

  void expect_masks(const EmbreeTree& tree, const PacketPlan& plan,
                    SimdLevel simd = SimdLevel::automatic) const {
    const BenchFrame& f = view_.frame;
    std::vector<ShadowMask> found(lights_.size());
    trace_masks(
        {f.points.triangles, size.width, size.height, f.view, f.triangles(), lights_, f.diagonal_m, simd},
        tree, plan, found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      std::size_t differing = 0;
      for (std::size_t k = 0; k < found[i].size(); ++k) differing += found[i][k] != masks_[i][k] ? 1 : 0;
      EXPECT_LT(static_cast<double>(differing), most_differing_samples * static_cast<double>(found[i].size()))
          << packet_plan_name(plan) << ", light " << i;
    }
  }

  HardView view_;
  std::vector<ShadowLight> lights_;
  std::vector<ShadowMask> masks_;
};

TEST_F(HardOpponent, FindsOurMasksByEveryTreeAfterAMove) {
  const auto moved = moved_vertices(view_.before.positions, view_.frame.geometry.positions);
  EXPECT_GT(std::count(moved.begin(), moved.end(), 1), 0);
  EXPECT_GT(std::count(moved.begin(), moved.end(), 0), 0);
  for (const TreeKind kind : kinds) {
    SCOPED_TRACE(tree_name(kind));
    TreeVertices vertices(view_.before.positions);
    EmbreeTree tree(vertices.data(), view_.frame.triangles(), moved, {.kind = kind, .threads = 2});
    vertices.put(view_.frame.geometry.positions);
    tree.follow();
    expect_masks(tree, {});
  }
}

TEST_F(HardOpponent, FindsOurMasksByEveryPacketAtEveryVectorLevel) {
  const TreeVertices vertices(view_.frame.geometry.positions);
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    SCOPED_TRACE(simd_level_name(level));
    const EmbreeTree tree(vertices.data(), view_.frame.triangles(), {},
                          {.kind = TreeKind::medium, .simd = level});
    EXPECT_FALSE(packet_plans(tree).empty());
    for (const PacketPlan& plan : packet_plans(tree)) expect_masks(tree, plan, level);
  }
}

// What primary packets see is what a single ray sees, and what is known of it agrees with the ids.
TEST_F(HardOpponent, SeesWhatSingleRaysSee) {
  // Ray masks, by which the opponent leaves out what casts no shadow, are an option of Embree's build.
  if (!has_ray_masks()) GTEST_SKIP() << "this Embree was built without ray masks";
  const TreeVertices vertices(view_.frame.geometry.positions);
  const EmbreeTree tree(vertices.data(), view_.frame.triangles(), {},
                        {.kind = TreeKind::medium, .only_casters = false});
  const std::vector<std::uint32_t>& expected = view_.frame.points.triangles;
  for (const PacketPlan& plan : packet_plans(tree)) {
    const TileGrid grid(size.width, size.height, plan.shape);
    PacketTracer tracer(tree, plan, SimdLevel::automatic);
    std::vector<std::uint32_t> ids(expected.size(), 0);
    for (int square = 0; square < grid.square_rows() * grid.square_columns(); ++square) {
      for (int tile = 0; tile < 16; ++tile) {
        const glm::ivec2 at =
            grid.first({square % grid.square_columns(), square / grid.square_columns()}, tile);
        std::uint32_t seen[16];
        TilePlanes planes;
        TilePoints points;
        tracer.look(view_.frame.view, static_cast<float>(at.x), static_cast<float>(at.y), seen, planes,
                    points);
        grid.put(seen, at, ids.data());
      }
    }
    std::size_t differing = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) differing += ids[i] != expected[i] ? 1 : 0;
    EXPECT_LT(static_cast<double>(differing), 0.001 * static_cast<double>(ids.size()))
        << packet_plan_name(plan);
  }
}

}  // namespace
}  // namespace tenebra::bench
