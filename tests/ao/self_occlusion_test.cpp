// How surfaces hide themselves, against closed forms and against rays.
#include "ao/self_occlusion.h"

#include "ao/scene_objects.h"
#include "ao_case.h"

namespace tenebra {
namespace {

using namespace testing;

/// A shape made from one mesh that stands.
struct Body {
  ObjectShape shape;
  TriangleBvh casters;

  explicit Body(const Mesh& mesh) {
    SceneMaker make;
    make.add(mesh);
    FrameGeometry geometry;
    evaluate_frame(make.scene, -1, 0, geometry);
    shape = find_objects(make.scene, geometry).standing;
    casters = build_triangle_bvh(shape.positions, shape.triangles);
  }
};

const AoKernels kernels = ao_kernels(SimdLevel::automatic);

/// Asks and fills until nothing is missing, as a frame does.
float filled(SelfOcclusion& samples, const SurfacePoint& point) {
  for (int round = 0; round < 6; ++round) {
    std::vector<std::uint64_t> missing;
    const SelfOcclusion::Answer answer = samples.find(point, missing);
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    EXPECT_EQ(missing.empty(), answer.state != SelfOcclusion::State::missing);
    if (answer.state == SelfOcclusion::State::mixed) return samples.look(point, kernels);
    if (missing.empty()) return answer.occlusion;
    EXPECT_TRUE(samples.fill(missing, kernels, {}, nullptr));
  }
  ADD_FAILURE() << "still missing after six rounds";
  return -1;
}

/// Hidden share at the distance a (in reaches) from a wall that is long and high: the integral of the linear
/// fall-off over the cosine-weighted hemisphere.
double beside_wall(double a) {
  return a >= 1 ? 0
                : (std::acos(a) - 2 * a * std::acosh(1 / a) + a * std::sqrt(1 - a * a)) / 3.141592653589793;
}

TEST(SelfOcclusion, FloorBesideAWallFollowsTheClosedForm) {
  Mesh room = quad_mesh({0, 0, -20}, {0, 0, 40}, {40, 0, 0});    // floor, y up
  append(room, quad_mesh({0, 0, -20}, {0, 20, 0}, {0, 0, 40}));  // wall at x = 0
  const Body body(room);
  const double reach = 2;
  SelfOcclusion samples(body.shape, body.casters, reach);
  for (const double x : {0.03, 0.1, 0.3, 0.5, 0.77, 1.0, 1.5, 1.9, 2.5, 7.0}) {
    const double z = 1.37;  // on the second triangle of the floor if x is small
    const double s = (z + 20) / 40, t = x / 40;
    const SurfacePoint point = s > t
                                   ? SurfacePoint{0, static_cast<float>(s - t), static_cast<float>(t), true}
                                   : SurfacePoint{1, static_cast<float>(s), static_cast<float>(t - s), true};
    EXPECT_NEAR(filled(samples, point), beside_wall(x / reach), 1.5 / 255) << x;
  }
}

TEST(SelfOcclusion, ConvexBodiesDoNotHideThemselves) {
  for (const Mesh& mesh : {box_mesh({0, 0, 0}, {3, 1, 2}), ball_mesh(1, 8), ball_mesh(1, 40)}) {
    const Body body(mesh);
    SelfOcclusion samples(body.shape, body.casters, 1.5);
    for (std::uint32_t t = 0; t < body.shape.triangles.size(); ++t) {
      const glm::uvec3 v = body.shape.triangles[t];
      if (body.shape.positions[v.x] == body.shape.positions[v.y] ||
          body.shape.positions[v.y] == body.shape.positions[v.z])
        continue;  // at the poles
      EXPECT_EQ(filled(samples, {t, 0.2f, 0.3f, true}), 0) << t;
    }
  }
}

TEST(SelfOcclusion, TheInsideOfABoxIsDarkerThanItsOutside) {
  const Body body(box_mesh({0, 0, 0}, {1, 1, 1}));
  SelfOcclusion samples(body.shape, body.casters, 4);
  EXPECT_EQ(filled(samples, {0, 0.3f, 0.3f, true}), 0);
  EXPECT_GT(filled(samples, {0, 0.3f, 0.3f, false}), 0.7);
}

// A slab lies on the floor: the floor's samples under it are black, and must not darken the floor beside it.
TEST(SelfOcclusion, BuriedSamplesDoNotSeepOut) {
  Mesh scene = quad_mesh({-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
  append(scene, box_mesh({-1, -0.01f, -1}, {1, 0.02f, 1}));
  const Body body(scene);
  const double reach = 1;
  SelfOcclusion samples(body.shape, body.casters, reach);
  for (const double x : {1.05, 1.1, 1.15}) {  // a step of 0.02 hides at most a 25th of what is 0.5 away
    const double s = 0.53, t = (x + 5) / 10;
    EXPECT_LT(filled(samples, {1, static_cast<float>(s), static_cast<float>(t - s), true}), 0.05) << x;
  }
}

TEST(SelfOcclusion, IsTheSameInWhateverOrderPointsAreSeen) {
  Mesh mesh = quad_mesh({0, 0, -3}, {0, 0, 6}, {6, 0, 0});
  append(mesh, box_mesh({1, 0.3f, 0}, {2, 1, 1}));
  append(mesh, ball_mesh(0.4, 24));
  const Body body(mesh);
  Random random(4);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 300; ++i) {
    const double v = random.unit(), w = random.unit() * (1 - v);
    points.push_back({random.index(static_cast<std::uint32_t>(body.shape.triangles.size())),
                      static_cast<float>(v), static_cast<float>(w), random.chance(0.8)});
  }
  SelfOcclusion forwards(body.shape, body.casters, 0.8), backwards(body.shape, body.casters, 0.8);
  std::vector<float> first;
  for (const SurfacePoint& point : points) first.push_back(filled(forwards, point));
  for (std::size_t i = points.size(); i-- > 0;) EXPECT_EQ(filled(backwards, points[i]), first[i]) << i;
}

TEST(SelfOcclusion, MemoryIsBoundedHoweverShortTheReach) {
  Mesh scene = quad_mesh({-5000, 0, -5000}, {0, 0, 10000}, {10000, 0, 0});
  append(scene, box_mesh({-1, 0, -1}, {1, 2, 1}));
  const Body body(scene);
  SelfOcclusion samples(body.shape, body.casters, 0.01);
  EXPECT_LE(samples.bytes(), 2 * sizeof(std::uint16_t) * SurfaceLayout::most_places + 10000);
  EXPECT_GE(filled(samples, {0, 0.25f, 0.25f, true}), 0);
}

TEST(SelfOcclusion, StopsWhenAsked) {
  const Body body(box_mesh({0, 0, 0}, {1, 1, 1}));
  SelfOcclusion samples(body.shape, body.casters, 4);
  std::vector<std::uint64_t> missing;
  samples.find({0, 0.3f, 0.3f, true}, missing);
  StopFlag stop;
  stop.request();
  EXPECT_FALSE(samples.fill(missing, kernels, {}, &stop));
  std::vector<std::uint64_t> still;
  samples.find({0, 0.3f, 0.3f, true}, still);
  EXPECT_EQ(still, missing);
}

}  // namespace
}  // namespace tenebra
