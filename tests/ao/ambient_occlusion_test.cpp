// Whole frames: against the reference by rays, and what must not change from frame to frame.
#include <tenebra/ambient_occlusion.h>

#include <set>

#include "ao_case.h"

namespace tenebra {
namespace {

using namespace testing;

/// A floor, two walls, a still block, and two bodies that move over the floor: a ball, and a box that turns.
Scene room_scene() {
  SceneMaker make;
  make.add(quad_mesh({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}));
  make.add(quad_mesh({-4, 0, -4}, {0, 6, 0}, {0, 0, 8}));
  make.add(quad_mesh({-4, 0, -4}, {8, 0, 0}, {0, 6, 0}));
  make.add(box_mesh({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}), {-2, 0, 1});
  const int rolling = make.add(ball_mesh(0.7, 24), {0, 0.7, -1});
  make.move(rolling, {2, 0, 0});
  const int turning = make.add(box_mesh({-0.6f, -0.4f, -0.3f}, {0.6f, 0.4f, 0.3f}), {1.5, 0.5, 1.5});
  make.animate(turning, ChannelPath::rotation, {0, 0, 0, 1}, {0, 0.7071067811865476, 0, 0.7071067811865476});
  return make.scene;
}

constexpr int frame_width = 96, frame_height = 72;
const ViewRays frame_view = pinhole({5, 4, 6}, {0, 0.5, 0}, 0.5, frame_width, frame_height);

AoConfig config_of(AoMode mode, int rays = 64) {
  AoConfig config;
  config.mode = mode;
  config.rays = rays;
  config.distance_m = 1.2;
  config.positions = config.directions = 576;  // quick to build
  return config;
}

TEST(AmbientOcclusion, OfNoneIsAllOpen) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0, frame_view, frame_width, frame_height);
  for (const float value : occlude(scene, frame, config_of(AoMode::none))) EXPECT_EQ(value, 1);
}

TEST(AmbientOcclusion, BackgroundIsOpen) {
  SceneMaker make;
  make.add(box_mesh({-1, -1, -1}, {1, 1, 1}));
  const AoView frame(make.scene, 0, pinhole({4, 4, 4}, {0, 0, 0}, 0.6, 32, 32), 32, 32);
  const auto out = occlude(make.scene, frame, config_of(AoMode::field));
  EXPECT_EQ(frame.points.triangles[0], no_triangle);
  EXPECT_EQ(out[0], 1);
}

TEST(AmbientOcclusion, RoomFollowsTheReference) {
  const Scene scene = room_scene();
  for (const double time_s : {0.0, 0.6}) {
    const AoView frame(scene, time_s, frame_view, frame_width, frame_height);
    const auto reference = occlude(scene, frame, config_of(AoMode::rays, 1024));
    const auto field = occlude(scene, frame, config_of(AoMode::field, 256));
    const Difference d = compare(frame, field, reference);
    EXPECT_LT(d.rms_255, 3.0) << time_s;
    EXPECT_LT(std::abs(d.bias_255), 0.6) << time_s;
  }
}

TEST(AmbientOcclusion, TheReferenceConvergesWithItsRays) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.3, frame_view, frame_width, frame_height);
  const auto best = occlude(scene, frame, config_of(AoMode::rays, 4096));
  double before = 1e9;
  for (const int rays : {16, 64, 256}) {
    const double rms = compare(frame, occlude(scene, frame, config_of(AoMode::rays, rays)), best).rms_255;
    EXPECT_LT(rms, 0.6 * before) << rays;
    before = rms;
  }
  EXPECT_LT(before, 1.5);
}

TEST(AmbientOcclusion, BothLayoutsAndAllBitsFollowTheReference) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.4, frame_view, frame_width, frame_height);
  const auto reference = occlude(scene, frame, config_of(AoMode::rays, 256));
  for (const FieldLayout layout : {FieldLayout::chords, FieldLayout::positions_directions})
    for (const int bits : {1, 8, 32}) {
      AoConfig config = config_of(AoMode::field, 256);
      config.layout = layout;
      config.bits = bits;
      EXPECT_LT(compare(frame, occlude(scene, frame, config), reference).rms_255, bits == 1 ? 9 : 5)
          << bits << (layout == FieldLayout::chords ? " chords" : " directions");
    }
}

TEST(AmbientOcclusion, SameBitsForEveryThreadCountAndInstructionSet) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.2, frame_view, frame_width, frame_height);
  std::vector<float> expected;
  with_threads(1, [&] { expected = occlude(scene, frame, config_of(AoMode::field)); });
  for (const int threads : {2, 3, 8})
    with_threads(threads,
                 [&] { EXPECT_EQ(occlude(scene, frame, config_of(AoMode::field)), expected) << threads; });
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    AoConfig config = config_of(AoMode::field);
    config.simd = level;
    EXPECT_EQ(occlude(scene, frame, config), expected) << simd_level_name(level);
  }
}

// What an object saw before must not matter: frames in any order, one by one or from the state of others.
TEST(AmbientOcclusion, DoesNotDependOnTheFramesBefore) {
  const Scene scene = room_scene();
  AmbientOcclusion kept;
  for (const double time_s : {0.0, 0.7, 0.3, 0.7}) {
    const AoView frame(scene, time_s, frame_view, frame_width, frame_height);
    EXPECT_EQ(occlude(kept, scene, frame, config_of(AoMode::field)),
              occlude(scene, frame, config_of(AoMode::field)))
        << time_s;
  }
}

TEST(AmbientOcclusion, SecondFrameBuildsNothing) {
  const Scene scene = room_scene();
  AmbientOcclusion ao;
  const AoView frame(scene, 0.0, frame_view, frame_width, frame_height);
  occlude(ao, scene, frame, config_of(AoMode::field));
  EXPECT_EQ(ao.stats().fields_built, 1u) << "the ball; the box is met by rays, for it has few triangles";
  EXPECT_EQ(ao.stats().objects, 2u);
  EXPECT_GT(ao.stats().cache_cells, 0u);
  EXPECT_GT(ao.stats().lookups, 0u);
  const std::uint64_t cells = ao.stats().cache_cells;
  occlude(ao, scene, frame, config_of(AoMode::field));
  EXPECT_EQ(ao.stats().fields_built, 0u);
  EXPECT_EQ(ao.stats().cache_cells, cells);
}

/// Points of the first frame that no moving body comes within the reach of in either, by their pixels: with a
/// camera that stands they are the same points, and must not change at all.
TEST(AmbientOcclusion, StillPointsDoNotFlicker) {
  const Scene scene = room_scene();
  AmbientOcclusion ao;
  std::vector<float> before;
  std::vector<std::uint32_t> seen;
  int still = 0;
  for (int f = 0; f <= 5; ++f) {
    const AoView frame(scene, 0.05 * f, frame_view, frame_width, frame_height);
    const auto now = occlude(ao, scene, frame, config_of(AoMode::field));
    for (std::size_t i = 0; f > 0 && i < now.size(); ++i) {
      if (frame.points.triangles[i] != seen[i] || seen[i] == no_triangle) continue;
      bool near = frame.points.triangles[i] >= 18;  // the moving bodies' triangles
      for (const std::size_t node : {4u, 5u}) {
        const glm::dvec3 middle(frame.geometry.pose.nodes[node].to_world[3]);
        near = near || glm::length(middle - frame.points.positions[i]) < 1.2 + 0.9;
      }
      if (near) continue;
      ++still;
      EXPECT_EQ(now[i], before[i]) << f << " " << i;
    }
    before = now;
    seen = frame.points.triangles;
  }
  EXPECT_GT(still, 2000);
}

/// A camera that moves sees the same points at other pixels: they keep their values.
TEST(AmbientOcclusion, PointsKeepTheirValuesUnderAMovingCamera) {
  const Scene scene = room_scene();
  AoView frame(scene, 0.25, frame_view, frame_width, frame_height);
  const auto expected = occlude(scene, frame, config_of(AoMode::field));
  AoView turned = frame;  // the picture upside down: every point at another pixel and in another tile
  std::reverse(turned.points.positions.begin(), turned.points.positions.end());
  std::reverse(turned.points.triangles.begin(), turned.points.triangles.end());
  std::reverse(turned.normals.begin(), turned.normals.end());
  auto found = occlude(scene, turned, config_of(AoMode::field));
  std::reverse(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

/// The whole scene turned, moved and scaled: the same picture but for rounding and the turn of the rays.
TEST(AmbientOcclusion, FollowsTheScenesTransform) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.5, frame_view, frame_width, frame_height);
  const auto expected = occlude(scene, frame, config_of(AoMode::field, 256));
  Scene moved = scene;
  Node root;
  root.translation = {30, -20, 10};
  root.rotation = glm::angleAxis(0.9, glm::normalize(glm::dvec3(1, 1, 0.3)));
  root.scale = glm::dvec3(2.5);
  for (Node& node : moved.nodes) node.parent = 0;
  moved.nodes.insert(moved.nodes.begin(), root);
  for (Channel& channel : moved.clips[0].channels) ++channel.node;
  AoView other = frame;
  evaluate_frame(moved, 0, 0.5, other.geometry);
  const glm::dmat4 to_world = other.geometry.pose.nodes[0].to_world;
  for (glm::dvec3& p : other.points.positions) p = glm::dvec3(to_world * glm::dvec4(p, 1.0));
  for (glm::vec3& n : other.normals) n = glm::vec3(glm::mat3_cast(root.rotation) * glm::dvec3(n));
  AoConfig config = config_of(AoMode::field, 256);
  config.distance_m *= 2.5;
  EXPECT_LT(compare(frame, occlude(moved, other, config), expected).rms_255, 1.5);
}

TEST(AmbientOcclusion, AtVerticesIsExactWhereAllIsFlatAndAlike) {
  SceneMaker make;
  make.add(box_mesh({-1, -1, -1}, {1, 1, 1}));
  make.move(0, {1, 0, 0});
  const AoView frame(make.scene, 0, pinhole({4, 4, 4}, {0, 0, 0}, 0.6, 48, 48), 48, 48);
  AoConfig config = config_of(AoMode::field);
  config.place = AoPlace::vertices;
  AmbientOcclusion ao;
  for (const float value : occlude(ao, make.scene, frame, config)) EXPECT_EQ(value, 1);
  EXPECT_EQ(ao.stats().points, 18u) << "six visible triangles without normals of their own";
}

TEST(AmbientOcclusion, AtVerticesFollowsThePixelsOnFineMeshes) {
  SceneMaker make;
  Mesh floor;
  const int n = 48;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      append(floor, quad_mesh({-3 + 6.0f * i / n, 0, -3 + 6.0f * j / n}, {0, 0, 6.0f / n}, {6.0f / n, 0, 0}));
  make.add(floor);
  make.move(make.add(ball_mesh(0.8, 32), {0, 0.9, 0}), {1, 0, 0});
  const AoView frame(make.scene, 0, pinhole({3, 4, 5}, {0, 0.3, 0}, 0.5, 96, 96), 96, 96);
  AoConfig config = config_of(AoMode::field, 256);
  const auto pixels = occlude(make.scene, frame, config);
  config.place = AoPlace::vertices;
  const auto vertices = occlude(make.scene, frame, config);
  EXPECT_LT(compare(frame, vertices, pixels).rms_255, 3);
  EXPECT_GT(compare(frame, vertices, std::vector<float>(vertices.size(), 1)).rms_255, 15)
      << "there is occlusion";
}

TEST(AmbientOcclusion, HalfTheResolutionStaysClose) {
  const Scene scene = room_scene();
  const ViewRays wide = pinhole({5, 4, 6}, {0, 0.5, 0}, 0.5, 192, 144);
  const AoView frame(scene, 0.5, wide, 192, 144);
  AoConfig config = config_of(AoMode::field);
  const auto full = occlude(scene, frame, config);
  config.downscale = 2;
  AmbientOcclusion ao;
  const auto half = occlude(ao, scene, frame, config);
  EXPECT_LT(compare(frame, half, full).rms_255, 5);
  EXPECT_LT(ao.stats().points, frame.points.triangles.size() / 3);
}

TEST(AmbientOcclusion, DeformingMeshesAreNamedAndMetByRaysOrLeftOut) {
  SceneMaker make;
  make.add(quad_mesh({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}));
  Mesh blob = ball_mesh(0.8, 24);
  blob.name = "blob";
  blob.shapes = {{0, blob.positions, blob.normals}, {1, blob.positions, blob.normals}};
  for (glm::vec3& p : blob.shapes[1].positions) p.x *= 1.5f;
  make.add(blob, {0, 0.8, 0});
  make.move(1, {0, 0, 0.5});  // a clip, so that shapes are evaluated
  const AoView frame(make.scene, 0.5, pinhole({3, 4, 5}, {0, 0.3, 0}, 0.5, 64, 64), 64, 64);
  const auto reference = occlude(make.scene, frame, config_of(AoMode::rays, 256));
  AmbientOcclusion ao;
  AoConfig config = config_of(AoMode::field, 256);
  const auto met = occlude(ao, make.scene, frame, config);
  EXPECT_LT(compare(frame, met, reference).rms_255, 1.0);
  ASSERT_EQ(ao.notes().size(), 1u);
  EXPECT_NE(ao.notes()[0].find("blob"), std::string::npos);
  occlude(ao, make.scene, frame, config);
  EXPECT_EQ(ao.notes().size(), 1u) << "named once";
  config.deforming = false;
  const auto left_out = occlude(make.scene, frame, config);
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (frame.points.triangles[i] >= 2) continue;
    EXPECT_EQ(left_out[i], 1) << "nothing else hides the floor";
  }
}

TEST(AmbientOcclusion, StretchedObjectsFollowTheReference) {
  SceneMaker make;
  make.add(quad_mesh({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}));
  Mesh pair = ball_mesh(0.6, 24);  // two balls side by side: they hide each other
  for (glm::vec3& p : pair.positions) p.x -= 0.65f;
  Mesh other = ball_mesh(0.6, 24);
  for (glm::vec3& p : other.positions) p.x += 0.65f;
  append(pair, other);
  const int node = make.add(pair, {0, 0.7, 0});
  make.animate(node, ChannelPath::scale, {1, 1, 1}, {0.4, 1, 1.5});
  AmbientOcclusion ao;
  for (const double time_s : {0.0, 1.0}) {
    const AoView frame(make.scene, time_s, pinhole({3, 4, 5}, {0, 0.3, 0}, 0.4, 80, 64), 80, 64);
    const auto reference = occlude(make.scene, frame, config_of(AoMode::rays, 256));
    const auto found = occlude(ao, make.scene, frame, config_of(AoMode::field, 256));
    EXPECT_LT(compare(frame, found, reference).rms_255, 4) << time_s;
  }
}

TEST(AmbientOcclusion, WhatCastsNoShadowHidesNoAmbientLight) {
  SceneMaker make;
  make.add(quad_mesh({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}));
  for (const bool moves : {false, true}) {
    Mesh block = ball_mesh(0.5, 16);
    block.casts_shadow = false;
    const int node = make.add(block, {moves ? 1 : -1, 0.5, 0});
    if (moves) make.move(node, {0, 0, 1});
  }
  const AoView frame(make.scene, 0, pinhole({3, 4, 5}, {0, 0.3, 0}, 0.5, 64, 64), 64, 64);
  for (const AoMode mode : {AoMode::field, AoMode::rays}) {
    const auto out = occlude(make.scene, frame, config_of(mode));
    for (std::size_t i = 0; i < out.size(); ++i) {
      if (frame.points.triangles[i] >= 2) continue;
      EXPECT_EQ(out[i], 1) << i;
    }
  }
}

TEST(AmbientOcclusion, OnlyObjectsInReachGetFields) {
  SceneMaker make;
  make.add(quad_mesh({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}));
  make.move(make.add(ball_mesh(0.5, 16), {0, 0.5, 0}), {1, 0, 0});
  make.move(make.add(ball_mesh(0.6, 17), {0, 60, 0}), {1, 0, 0});  // far above
  make.move(make.add(ball_mesh(0.6, 18), {0, -0.9, 0}),
            {0.1, 0, 0});  // below the floor: beyond its hemisphere
  const AoView frame(make.scene, 0, pinhole({3, 4, 5}, {0, 0.3, 0}, 0.5, 64, 64), 64, 64);
  AmbientOcclusion ao;
  AoConfig config = config_of(AoMode::field);
  config.distance_m = 0.4;
  occlude(ao, make.scene, frame, config);
  EXPECT_EQ(ao.stats().fields_built, 1u);
  EXPECT_EQ(ao.stats().objects, 1u);
}

TEST(AmbientOcclusion, BuiltFieldsAreFoundAgainOnDisk) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.1, frame_view, frame_width, frame_height);
  testing::TemporaryFolder folder;
  AoConfig config = config_of(AoMode::field);
  config.cache = folder.path() / "fields";
  AmbientOcclusion first, second;
  const auto expected = occlude(first, scene, frame, config);
  EXPECT_EQ(occlude(second, scene, frame, config), expected);
  EXPECT_EQ(second.stats().fields_built, 0u);
  for (const auto& file : std::filesystem::directory_iterator(config.cache)) {
    std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  }
  AmbientOcclusion third;
  EXPECT_EQ(occlude(third, scene, frame, config), expected) << "a damaged cache is rebuilt";
  EXPECT_EQ(third.stats().fields_built, 1u);
}

TEST(AmbientOcclusion, StopsAndCarriesOn) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.1, frame_view, frame_width, frame_height);
  AmbientOcclusion ao;
  StopFlag stop;
  std::vector<float> out;
  int calls = 0;
  const auto stopping = [&](std::string_view, double) { ++calls, stop.request(); };
  const auto config = config_of(AoMode::field);
  const auto done =
      ao.compute(scene, frame.geometry, frame.points, frame.normals, config, out, stopping, &stop);
  ASSERT_FALSE(done);
  EXPECT_TRUE(is_stop(done));
  EXPECT_GT(calls, 0);
  EXPECT_EQ(occlude(ao, scene, frame, config), occlude(scene, frame, config));
}

TEST(AmbientOcclusion, RefusesSettingsOutOfRange) {
  const Scene scene = room_scene();
  const AoView frame(scene, 0.1, frame_view, frame_width, frame_height);
  const auto message = [&](const auto& change) {
    AoConfig config = config_of(AoMode::field);
    change(config);
    AmbientOcclusion ao;
    std::vector<float> out;
    const auto done = ao.compute(scene, frame.geometry, frame.points, frame.normals, config, out);
    return done ? std::string("accepted") : done.error().message;
  };
  std::set<std::string> messages;
  messages.insert(message([](AoConfig& c) { c.rays = 0; }));
  messages.insert(message([](AoConfig& c) { c.rays = 1 << 20; }));
  messages.insert(message([](AoConfig& c) { c.distance_m = -1; }));
  messages.insert(message([](AoConfig& c) { c.distance_m = NAN; }));
  messages.insert(message([](AoConfig& c) { c.bits = 7; }));
  messages.insert(message([](AoConfig& c) { c.positions = 0; }));
  messages.insert(message([](AoConfig& c) { c.downscale = 0; }));
  EXPECT_EQ(messages.size(), 7u);
  EXPECT_EQ(messages.count("accepted"), 0u);
}

TEST(AmbientOcclusion, EmptyScenesAndPicturesAreFine) {
  Scene empty;
  FrameGeometry geometry;
  evaluate_frame(empty, -1, 0, geometry);
  AmbientOcclusion ao;
  std::vector<float> out(3);
  EXPECT_TRUE(ao.compute(empty, geometry, {}, {}, config_of(AoMode::field), out));
  EXPECT_TRUE(out.empty());
}

}  // namespace
}  // namespace tenebra
