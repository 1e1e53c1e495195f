// Adaptive occlusion: the error asked for is met, the estimate is right, and cases where other methods
// failed.
#include <tenebra/ambient_occlusion.h>
#include <tenebra/threads.h>

#include "ao_case.h"

namespace tenebra {
namespace {

using namespace testing;

AoConfig adaptive(double error_255, double distance_m) {
  AoConfig config;
  config.mode = AoMode::adaptive;
  config.error_255 = error_255;
  config.distance_m = distance_m;
  return config;
}

std::vector<float> truth_of(const Scene& scene, const AoView& view, double distance_m, int rays = 4096) {
  AoConfig config = adaptive(1, distance_m);
  config.mode = AoMode::rays;
  config.rays = rays;
  return occlude(scene, view, config);
}

/// A floor, walls, a still block and a stack of slats with gaps, a ball that rolls and a box that turns.
Scene yard_scene() {
  SceneMaker make;
  make.add(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}));
  make.add(quad_mesh({-4, 0, -4}, {0, 6, 0}, {0, 0, 8}));
  make.add(quad_mesh({-4, 0, -4}, {8, 0, 0}, {0, 6, 0}));
  make.add(box_mesh({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), {-2, 0, 1});
  Mesh slats;
  for (int i = 0; i < 8; ++i) {
    const float x = 0.25f * static_cast<float>(i);
    append(slats, box_mesh({x, 0, 0}, {x + 0.22f, 0.3f, 1}));
  }
  make.add(slats, {-1, 0, 2});
  make.move(make.add(ball_mesh(0.7, 24), {0, 0.7, -1}), {2, 0, 0});
  const int turning = make.add(box_mesh({-0.6f, -0.4f, -0.3f}, {0.6f, 0.4f, 0.3f}), {1.5, 0.5, 1.5});
  make.animate(turning, ChannelPath::rotation, {0, 0, 0, 1}, {0, 0.7071067811865476, 0, 0.7071067811865476});
  return make.scene;
}

constexpr int width = 160, height = 120;
const ViewRays view = pinhole({5, 4, 6}, {0, 0.5, 0}, 0.5, width, height);

TEST(AdaptiveOcclusion, MeetsTheErrorAskedForAndKnowsIt) {
  const Scene scene = yard_scene();
  for (const double time_s : {0.0, 0.6}) {
    const AoView frame(scene, time_s, view, width, height);
    const std::vector<float> truth = truth_of(scene, frame, 1.2);
    for (const double asked : {5.0, 2.5, 1.0}) {
      AmbientOcclusion ao;
      const Difference d = compare(frame, occlude(ao, scene, frame, adaptive(asked, 1.2)), truth);
      EXPECT_LT(d.rms_255, 1.2 * asked) << time_s;
      EXPECT_LT(d.rms_255, 1.5 * std::max(0.25, ao.stats().error_255)) << asked;
      EXPECT_GT(std::max(0.25, d.rms_255), ao.stats().error_255 / 1.5) << asked;
      EXPECT_LT(std::abs(d.bias_255), 0.3 * asked) << asked;
    }
  }
}

TEST(AdaptiveOcclusion, ATreeFromDiskGivesTheSameBits) {
  const TemporaryFolder folder;
  SceneMaker make;
  make.add(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}));
  make.add(ball_mesh(0.7, 40), {0, 0.7, 0});
  const AoView frame(make.scene, -1, view, width, height);
  AoConfig config = adaptive(2.5, 1.2);
  const std::vector<float> expected = occlude(make.scene, frame, config);
  config.cache = folder.path();
  for (int process = 0; process < 2; ++process) {
    AmbientOcclusion ao;
    EXPECT_EQ(occlude(ao, make.scene, frame, config), expected) << process;
    EXPECT_TRUE(ao.notes().empty());
    const std::filesystem::directory_iterator files(folder.path());
    ASSERT_EQ(std::distance(begin(files), end(files)), 1)
        << "one tree, and nothing that this way does not need";
  }
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    write_text(file.path(), read_text(file.path()).substr(0, 200));
  AmbientOcclusion ao;
  EXPECT_EQ(occlude(ao, make.scene, frame, config), expected);
  ASSERT_EQ(ao.notes().size(), 1u);
  EXPECT_NE(ao.notes().front().find(".tree: found damaged bytes"), std::string::npos);
}

TEST(AdaptiveOcclusion, ExactErrsLittleAtTheWorstPixel) {
  const Scene scene = yard_scene();
  const AoView frame(scene, 0.3, view, width, height);
  const Difference d = compare(frame, occlude(scene, frame, adaptive(1, 1.2)), truth_of(scene, frame, 1.2));
  EXPECT_LT(d.rms_255, 1.0);
  EXPECT_LT(d.most_255, 16);
}

TEST(AdaptiveOcclusion, LooksLessWhereThePictureIsSmooth) {
  SceneMaker make;
  make.add(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}));
  make.add(box_mesh({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}));
  const AoView frame(make.scene, 0, pinhole({3, 5, 3}, {0, 0, 0}, 0.7, 320, 240), 320, 240);
  std::size_t seen = 0;
  for (const std::uint32_t triangle : frame.points.triangles) seen += triangle != no_triangle ? 1 : 0;
  AmbientOcclusion ao;
  occlude(ao, make.scene, frame, adaptive(2.5, 0.8));
  EXPECT_LT(ao.stats().points, seen / 3);
}

TEST(AdaptiveOcclusion, SameBitsForEveryThreadCountAndInstructionSet) {
  const Scene scene = yard_scene();
  const AoView frame(scene, 0.3, view, width, height);
  const std::vector<float> first = occlude(scene, frame, adaptive(2.5, 1.2));
  for (const int threads : {1, 2, 5})
    with_threads(threads, [&] { EXPECT_EQ(occlude(scene, frame, adaptive(2.5, 1.2)), first) << threads; });
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    AoConfig config = adaptive(2.5, 1.2);
    config.simd = level;
    EXPECT_EQ(occlude(scene, frame, config), first) << simd_level_name(level);
  }
}

TEST(AdaptiveOcclusion, DoesNotDependOnTheFramesBefore) {
  const Scene scene = yard_scene();
  const AoView before(scene, 0.1, view, width, height), frame(scene, 0.8, view, width, height);
  AmbientOcclusion ao;
  occlude(ao, scene, before, adaptive(2.5, 1.2));
  EXPECT_EQ(occlude(ao, scene, frame, adaptive(2.5, 1.2)), occlude(scene, frame, adaptive(2.5, 1.2)));
}

/// The corners of a small triangle are buried, what lies between them is open: samples at corners said that
/// all of it is hidden, and whole links of robots' arms were drawn black.
TEST(AdaptiveOcclusion, AnOpenTriangleWithBuriedCornersIsLit) {
  const glm::vec3 corners[] = {{-0.1f, 0, -0.1f}, {0, 0, 0.1f}, {0.1f, 0, -0.1f}};
  Mesh link;
  link.positions.assign(corners, corners + 3);
  link.triangles = {{0, 1, 2}};
  link.materials = {0};
  const glm::vec3 half(0.02f);
  for (const glm::vec3& corner : corners) append(link, box_mesh(corner - half, corner + half));
  SceneMaker make;
  make.move(make.add(link, {0, 1, 0}), {0, 0.1, 0});
  const AoView frame(make.scene, 0, pinhole({0, 1.5, 0.1}, {0, 1, -0.03}, 0.5, 64, 64), 64, 64);
  const std::vector<float> out = occlude(make.scene, frame, adaptive(1, 8)),
                           truth = truth_of(make.scene, frame, 8);
  const std::size_t middle = 32 * 64 + 32;
  ASSERT_NE(frame.points.triangles[middle], no_triangle);
  EXPECT_GT(truth[middle], 0.8f);
  EXPECT_NEAR(out[middle], truth[middle], 0.03f);
  EXPECT_LT(compare(frame, out, truth).most_255, 16);
}

/// Two plates a millionth of a unit apart, 64 units away: in the world, where pixels see one of them, they
/// are in one plane, and neither hides the other. In their own space one did: crowds of many triangles, each
/// body in a tree of its own, had black pixels.
TEST(AdaptiveOcclusion, PlatesThatRoundingJoinsDoNotHideEachOther) {
  const auto plate = [](float y) { return quad_mesh({-0.5f, y, -0.5f}, {0, 0, 1}, {1, 0, 0}); };
  const glm::dvec3 at(64, 64, 64);
  for (const auto& [first, second] : {std::pair{0.0f, 1e-6f}, std::pair{1e-6f, 0.0f}}) {
    SceneMaker make;
    Mesh plates = plate(first);
    append(plates, plate(second));
    make.move(make.add(plates, at), {0, 0.5, 0});
    make.move(make.add(ball_mesh(0.1, 240), at + glm::dvec3(0, 1, 0)), {0, 0.5, 0});  // too many to gather
    const AoView frame(make.scene, 0, pinhole(at + glm::dvec3(0.3, 1, 0.9), at, 0.5, 48, 48), 48, 48);
    const std::vector<float> out = occlude(make.scene, frame, adaptive(1, 2));
    EXPECT_LT(compare(frame, out, truth_of(make.scene, frame, 2)).most_255, 16) << first;
  }
}

TEST(AdaptiveOcclusion, StopsAndCarriesOn) {
  const Scene scene = yard_scene();
  const AoView frame(scene, 0.3, view, width, height);
  const std::vector<float> whole = occlude(scene, frame, adaptive(2.5, 1.2));
  AmbientOcclusion ao;
  StopFlag stop;
  stop.request();
  std::vector<float> out;
  const auto done =
      ao.compute(scene, frame.geometry, frame.points, frame.normals, adaptive(2.5, 1.2), out, {}, &stop);
  ASSERT_FALSE(done);
  EXPECT_TRUE(is_stop(done));
  EXPECT_EQ(occlude(ao, scene, frame, adaptive(2.5, 1.2)), whole);
}

TEST(AdaptiveOcclusion, RefusesErrorsOutOfRange) {
  const Scene scene = yard_scene();
  const AoView frame(scene, 0, view, width, height);
  for (const double error : {0.0, -1.0, 0.01, 1e9, std::nan("")}) {
    AmbientOcclusion ao;
    std::vector<float> out;
    const auto done = ao.compute(scene, frame.geometry, frame.points, frame.normals, adaptive(error, 1), out);
    ASSERT_FALSE(done) << error;
    EXPECT_NE(done.error().message.find("expected 0.1 to 255"), std::string::npos) << done.error().message;
  }
}

TEST(AdaptiveOcclusion, EmptyPicturesAreOpen) {
  const Scene scene = yard_scene();
  const ViewRays away = pinhole({5, 4, 6}, {10, 8, 12}, 0.5, 16, 16);
  const AoView frame(scene, 0, away, 16, 16);
  for (const float value : occlude(scene, frame, adaptive(2.5, 1.2))) EXPECT_EQ(value, 1);
}

}  // namespace
}  // namespace tenebra
