// How surfaces hide themselves, against closed forms and against rays.
#include "ao/surface/self_occlusion.h"

#include "ao/surface/surface_layout_inline.h"
#include "standing_body.h"

namespace tenebra {
namespace {

using namespace testing;

struct OwnBody : StandingBody {
  using StandingBody::StandingBody;

  glm::dvec3 at(const ao::SurfacePoint& p) const {
    const glm::uvec3 t = shape.triangles[p.triangle];
    return (1 - double{p.v} - p.w) * glm::dvec3(shape.positions[t.x]) +
           double{p.v} * glm::dvec3(shape.positions[t.y]) + double{p.w} * glm::dvec3(shape.positions[t.z]);
  }
};

const ao::RayKernels own_kernels = ao::ray_kernels(SimdLevel::automatic);

/// Asks and fills until nothing is missing, as a frame does.
float filled(ao::SelfOcclusion& samples, const ao::SurfacePoint& point) {
  for (int round = 0; round < 6; ++round) {
    std::vector<std::uint64_t> missing;
    const ao::SelfOcclusion::Answer answer = samples.find(point, missing);
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    EXPECT_EQ(missing.empty(), answer.state != ao::SelfOcclusion::State::missing);
    if (answer.state == ao::SelfOcclusion::State::mixed) return samples.look(point, own_kernels);
    if (missing.empty()) return answer.occlusion;
    EXPECT_TRUE(samples.fill(missing, own_kernels, {}, nullptr));
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
  const OwnBody body(room);
  const double reach = 2;
  ao::SelfOcclusion samples(body.shape, body.casters, reach);
  samples.lay();
  for (const double x : {0.03, 0.1, 0.3, 0.5, 0.77, 1.0, 1.5, 1.9, 2.5, 7.0}) {
    const double z = 1.37;  // on the second triangle of the floor if x is small
    const double s = (z + 20) / 40, t = x / 40;
    const ao::SurfacePoint point =
        s > t ? ao::SurfacePoint{0, static_cast<float>(s - t), static_cast<float>(t), true}
              : ao::SurfacePoint{1, static_cast<float>(s), static_cast<float>(t - s), true};
    EXPECT_NEAR(filled(samples, point), beside_wall(x / reach), 1.5 / 255) << x;
  }
}

TEST(SelfOcclusion, ConvexBodiesDoNotHideThemselves) {
  for (const Mesh& mesh : {box_mesh({0, 0, 0}, {3, 1, 2}), ball_mesh(1, 8), ball_mesh(1, 40)}) {
    const OwnBody body(mesh);
    ao::SelfOcclusion samples(body.shape, body.casters, 1.5);
    samples.lay();
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
  const OwnBody body(box_mesh({0, 0, 0}, {1, 1, 1}));
  ao::SelfOcclusion samples(body.shape, body.casters, 4);
  samples.lay();
  EXPECT_EQ(filled(samples, {0, 0.3f, 0.3f, true}), 0);
  EXPECT_GT(filled(samples, {0, 0.3f, 0.3f, false}), 0.7);
}

// A slab lies on the floor: the floor's samples under it are black, and must not darken the floor beside it.
TEST(SelfOcclusion, BuriedSamplesDoNotSeepOut) {
  Mesh scene = quad_mesh({-5, 0, -5}, {0, 0, 10}, {10, 0, 0});
  append(scene, box_mesh({-1, -0.01f, -1}, {1, 0.02f, 1}));
  const OwnBody body(scene);
  const double reach = 1;
  ao::SelfOcclusion samples(body.shape, body.casters, reach);
  samples.lay();
  for (const double x : {1.05, 1.1, 1.15}) {  // a step of 0.02 hides at most a 25th of what is 0.5 away
    const double s = 0.53, t = (x + 5) / 10;
    EXPECT_LT(filled(samples, {1, static_cast<float>(s), static_cast<float>(t - s), true}), 0.05) << x;
  }
}

TEST(SelfOcclusion, IsTheSameInWhateverOrderPointsAreSeen) {
  Mesh mesh = quad_mesh({0, 0, -3}, {0, 0, 6}, {6, 0, 0});
  append(mesh, box_mesh({1, 0.3f, 0}, {2, 1, 1}));
  append(mesh, ball_mesh(0.4, 24));
  const OwnBody body(mesh);
  Random random(4);
  std::vector<ao::SurfacePoint> points;
  for (int i = 0; i < 300; ++i) {
    const double v = random.unit(), w = random.unit() * (1 - v);
    points.push_back({random.index(static_cast<std::uint32_t>(body.shape.triangles.size())),
                      static_cast<float>(v), static_cast<float>(w), random.chance(0.8)});
  }
  ao::SelfOcclusion forwards(body.shape, body.casters, 0.8), backwards(body.shape, body.casters, 0.8);
  forwards.lay(), backwards.lay();
  std::vector<float> first;
  for (const ao::SurfacePoint& point : points) first.push_back(filled(forwards, point));
  for (std::size_t i = points.size(); i-- > 0;) EXPECT_EQ(filled(backwards, points[i]), first[i]) << i;
}

TEST(SelfOcclusion, MemoryIsBoundedHoweverShortTheReach) {
  Mesh scene = quad_mesh({-5000, 0, -5000}, {0, 0, 10000}, {10000, 0, 0});
  append(scene, box_mesh({-1, 0, -1}, {1, 2, 1}));
  const OwnBody body(scene);
  ao::SelfOcclusion samples(body.shape, body.casters, 0.01);
  samples.lay();
  EXPECT_LE(samples.bytes(), 2 * sizeof(std::uint16_t) * ao::SurfaceLayout::most_places + 10000);
  EXPECT_GE(filled(samples, {0, 0.25f, 0.25f, true}), 0);
}

/// A floor under a plate of many small holes: neighbouring samples disagree everywhere.
Mesh sieve() {
  Mesh mesh = quad_mesh({0, 0, 0}, {0, 0, 4}, {4, 0, 0});
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i)
      append(mesh, quad_mesh({0.2f * i, 0.02f, 0.2f * j}, {0, 0, 0.1f}, {0.1f, 0, 0}));
  append(mesh, ball_mesh(0.3, 40));  // small triangles, some of them in the floor
  return mesh;
}

// Beyond the limit, rays answer.
TEST(SelfOcclusion, DividesNoMoreCellsThanAllowed) {
  const OwnBody body(sieve());
  Random random(9);
  std::vector<ao::SurfacePoint> points;
  for (int i = 0; i < 2000; ++i) {
    const double v = random.unit(), w = random.unit() * (1 - v);
    points.push_back({random.index(static_cast<std::uint32_t>(body.shape.triangles.size())),
                      static_cast<float>(v), static_cast<float>(w), random.chance(0.8)});
    points.push_back({random.index(2), static_cast<float>(v), static_cast<float>(w), true});
  }
  ao::SelfOcclusion whole(body.shape, body.casters, 1), few(body.shape, body.casters, 1, 7),
      none(body.shape, body.casters, 1, 0);
  for (ao::SelfOcclusion* samples : {&whole, &few, &none}) samples->lay();
  for (const ao::SurfacePoint& point : points) {
    for (ao::SelfOcclusion* samples : {&whole, &few, &none}) {
      const float hidden = filled(*samples, point);
      EXPECT_GE(hidden, 0);
      EXPECT_LE(hidden, 1);
    }
  }
  EXPECT_GT(whole.cells(), 100u);
  EXPECT_EQ(few.cells(), 7u);
  EXPECT_EQ(none.cells(), 0u);
  constexpr std::size_t cell =
      ao::SurfaceLayout::cell_samples * sizeof(std::uint16_t) + sizeof(std::uint64_t);
  EXPECT_GE(whole.bytes(), none.bytes() + cell * whole.cells());
  EXPECT_LE(few.bytes(), none.bytes() + cell * 7 + 64 * 16);  // and the smallest table
}

// The same answer wherever a number is in the table, and none for keys that were never added.
TEST(CellNumbers, FindsWhatWasAddedAndNothingElse) {
  ao::CellNumbers cells;
  EXPECT_EQ(cells.find(0), ao::CellNumbers::none);
  const auto key = [](std::uint64_t i) { return i << 30 | (i % 7) << 16; };
  for (std::uint64_t i = 0; i < 10000; ++i) cells.add(key(2 * i));
  for (std::uint64_t i = 0; i < 10000; ++i) {
    EXPECT_EQ(cells.find(key(2 * i)), i);
    EXPECT_EQ(cells.keys()[i], key(2 * i));
    EXPECT_EQ(cells.find(key(2 * i + 1)), ao::CellNumbers::none);
  }
  EXPECT_LE(cells.bytes(), 16384 * 8 + 32768 * 16);
}

// All samples of a grid lie on their triangle, within a quarter of a fine step of their own place; those that
// share one sample lie at one place, but for that.
TEST(SurfaceLayout, PlacesSamplesWhereTheyAreAsked) {
  const OwnBody body(sieve());
  const ao::SurfaceLayout layout(body.shape, 1);
  Random random(5);
  int wider = 0;
  for (int i = 0; i < 3000; ++i) {
    const double v = random.unit(), w = random.unit() * (1 - v);
    const ao::SurfacePoint point{random.index(802), static_cast<float>(v), static_cast<float>(w),
                                 random.chance(0.5)};
    ASSERT_FALSE(layout.is_small(point.triangle));
    for (int level = 0; level < layout.levels(point.triangle); ++level) {
      const ao::SampleTriple around = layout.around(point, level);
      double sum_v = 0, sum_w = 0, sum = 0;
      for (int k = 0; k < 3; ++k) {
        ASSERT_LT(around.at[k], layout.samples());
        const ao::SurfacePoint place = layout.place(around.at[k]);
        EXPECT_EQ(place.triangle, point.triangle);
        EXPECT_EQ(place.front, point.front);
        EXPECT_GE(std::min({place.v, place.w, 1 - place.v - place.w}), 0);
        sum_v += double{around.weights[k]} * place.v, sum_w += double{around.weights[k]} * place.w;
        sum += around.weights[k];
        const std::uint32_t shared = layout.shared(around.at[k]);
        const ao::SurfacePoint there = layout.place(shared);
        EXPECT_LT(glm::length(body.at(there) - body.at(place)), 0.1);
        EXPECT_EQ(there.front, place.front);
        EXPECT_EQ(layout.shared(shared), shared);
        wider += shared != around.at[k];
      }
      EXPECT_NEAR(sum, 1, 1e-5);
      EXPECT_NEAR(sum_v, v, 0.05);
      EXPECT_NEAR(sum_w, w, 0.05);
    }
  }
  EXPECT_GT(wider, 300);
}

TEST(SelfOcclusion, StopsWhenAsked) {
  const OwnBody body(box_mesh({0, 0, 0}, {1, 1, 1}));
  ao::SelfOcclusion samples(body.shape, body.casters, 4);
  samples.lay();
  std::vector<std::uint64_t> missing;
  samples.find({0, 0.3f, 0.3f, true}, missing);
  StopFlag stop;
  stop.request();
  EXPECT_FALSE(samples.fill(missing, own_kernels, {}, &stop));
  std::vector<std::uint64_t> still;
  samples.find({0, 0.3f, 0.3f, true}, still);
  EXPECT_EQ(still, missing);
}

}  // namespace
}  // namespace tenebra
