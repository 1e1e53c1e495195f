// The free camera: what moves of the hand do, and that its arguments give the same rays.
#include <gtest/gtest.h>

#include <numbers>

#include "stage/edits/light_edits.h"
#include "support/seeded_random.h"
#include "window/motion/camera_control.h"

namespace tenebra::viewer {
namespace {

using glm::vec3;

constexpr int width = 640, height = 480;

ViewRays rays_of(const FreeCamera& camera) {
  return look_at(camera.eye, camera.target, camera.up,
                 static_cast<float>(camera.fov_deg * std::numbers::pi / 180), 0.01f, width, height);
}

glm::dvec3 middle_of(const ViewRays& view) {
  return glm::dvec3(view.d0) + 0.5 * width * glm::dvec3(view.dx) + 0.5 * height * glm::dvec3(view.dy);
}

TEST(FreeCamera, OrbitKeepsTheDistanceAndNeverTurnsOver) {
  FreeCamera camera{.eye = {0, 1, 5}, .target = {0, 1, 0}};
  for (int i = 0; i < 100; ++i) {
    orbit(camera, 0.3f, i < 50 ? 0.2f : -0.3f);
    EXPECT_NEAR(glm::distance(camera.eye, camera.target), 5, 1e-3) << i;
    EXPECT_EQ(camera.target, vec3(0, 1, 0));
    EXPECT_GT(glm::dot(-rays_of(camera).dy, camera.up), 0) << "up stays up, turn " << i;
  }
}

TEST(FreeCamera, OrbitFollowsTheHand) {
  FreeCamera camera{.eye = {0, 0, 5}, .target = {0, 0, 0}};
  orbit(camera, 0.1f, 0);
  EXPECT_LT(camera.eye.x, 0) << "a drag to the right turns the scene to the right";
  orbit(camera, 0, 0.1f);
  EXPECT_GT(camera.eye.y, 0) << "a drag down looks from above";
}

TEST(FreeCamera, OrbitsAnyPointWithoutMovingItInThePicture) {
  FreeCamera camera{.eye = {0, 1, 5}, .target = {0, 1, 0}};
  const vec3 point{1.5f, 0.5f, 1};
  const glm::dvec3 before = pixel_of(rays_of(camera), point);
  const float away = glm::distance(camera.eye, point);
  for (int i = 0; i < 20; ++i) orbit(camera, 0.05f, -0.01f, point);
  const glm::dvec3 after = pixel_of(rays_of(camera), point);
  EXPECT_NEAR(after.x, before.x, 1) << "what is turned around stays under the pointer";
  EXPECT_NEAR(after.y, before.y, 40) << "but for what looking up and down does to it";
  EXPECT_NEAR(glm::distance(camera.eye, point), away, 1e-4);
  EXPECT_NEAR(glm::distance(camera.eye, camera.target), 5, 1e-4);
  FreeCamera about_target{.eye = {0, 1, 5}, .target = {0, 1, 0}}, plain = about_target;
  orbit(about_target, 0.2f, 0.1f, plain.target);
  orbit(plain, 0.2f, 0.1f);
  EXPECT_NEAR(glm::distance(about_target.eye, plain.eye), 0, 1e-6);
}

TEST(FreeCamera, FramesABoxWithoutWastingThePicture) {
  for (const vec3 eye : {vec3(0, 0, 9), vec3(4, 3, 2), vec3(-1, 20, 0.1f)}) {
    const vec3 low{-1, 0, -3}, high{2, 5, 1};
    FreeCamera camera{.eye = eye, .target = {0, 0, 0}};
    const glm::dvec3 way = glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.eye));
    frame(camera, low, high, double(width) / height);
    EXPECT_NEAR(glm::dot(way, glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.eye))), 1, 1e-6);
    double margin = 1e9;
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 at{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z};
      const glm::dvec3 pixel = pixel_of(rays_of(camera), at);
      ASSERT_GT(pixel.z, 0);
      margin = std::min({margin, pixel.x, pixel.y, width - pixel.x, height - pixel.y});
    }
    EXPECT_GT(margin, 0) << "all of it is seen";
    EXPECT_LT(margin, 0.05 * height) << "and it fills the picture";
  }
}

TEST(FreeCamera, PanMovesTheTargetWithThePointer) {
  FreeCamera camera{.eye = {0, 2, 5}, .target = {0, 0, 0}};
  const vec3 before = camera.target;
  pan(camera, {40, -25}, height);
  const glm::dvec3 pixel = pixel_of(rays_of(camera), before);
  EXPECT_NEAR(pixel.x, width / 2.0 + 40, 0.01);
  EXPECT_NEAR(pixel.y, height / 2.0 - 25, 0.01);
}

TEST(FreeCamera, ZoomStopsBeforeTheTarget) {
  FreeCamera camera{.eye = {0, 0, 5}, .target = {0, 0, 0}};
  for (int i = 0; i < 5000; ++i) zoom(camera, 1);
  EXPECT_NE(camera.eye, camera.target);
  for (int i = 0; i < 50000; ++i) zoom(camera, -1);
  EXPECT_TRUE(std::isfinite(camera.eye.z));
}

TEST(FreeCamera, LookingAroundAndFlyingKeepWhatTheyShould) {
  FreeCamera camera{.eye = {1, 2, 3}, .target = {1, 2, 0}};
  look_around(camera, 0.4f, 0.1f);
  EXPECT_EQ(camera.eye, vec3(1, 2, 3));
  EXPECT_NEAR(glm::distance(camera.eye, camera.target), 3, 1e-4);
  const vec3 forward = glm::normalize(camera.target - camera.eye);
  EXPECT_GT(forward.x, 0) << "to the right";
  EXPECT_LT(forward.y, 0) << "down";
  const vec3 from = camera.eye;
  fly(camera, {0, 0, 2});
  EXPECT_NEAR(glm::distance(camera.eye, from + 2.0f * forward), 0, 1e-5);
  focus(camera, {9, 9, 9});
  EXPECT_EQ(camera.target, vec3(9, 9, 9));
}

TEST(FreeCamera, TakesOverWhatTheSceneCameraSees) {
  testing::Random random(7);
  for (int i = 0; i < 200; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.in(-5, 5)); };
    const FreeCamera seen{.eye = {coordinate(), coordinate(), coordinate()},
                          .target = {coordinate(), coordinate(), coordinate()},
                          .up = {0, 1, 0},
                          .fov_deg = random.in(10, 120)};
    const ViewRays view = rays_of(seen);
    const FreeCamera taken = free_camera(view, width, height, 3);
    EXPECT_EQ(taken.eye, seen.eye);
    EXPECT_NEAR(taken.fov_deg, seen.fov_deg, 1e-3);
    const ViewRays again = rays_of(taken);
    EXPECT_NEAR(glm::length(glm::normalize(middle_of(view)) - glm::normalize(middle_of(again))), 0, 1e-4);
    EXPECT_NEAR(glm::length(glm::normalize(glm::dvec3(view.dx)) - glm::normalize(glm::dvec3(again.dx))), 0,
                2e-3);
  }
}

TEST(FreeCamera, PixelOfIsTheInverseOfTheRays) {
  const ViewRays view = rays_of({.eye = {1, 2, 3}, .target = {0, 0, -4}});
  for (const glm::dvec2 pixel : {glm::dvec2(0, 0), glm::dvec2(100.5, 20.25), glm::dvec2(639, 479)}) {
    const glm::dvec3 point =
        glm::dvec3(view.eye) +
        7.0 * (glm::dvec3(view.d0) + pixel.x * glm::dvec3(view.dx) + pixel.y * glm::dvec3(view.dy));
    const glm::dvec3 found = pixel_of(view, point);
    EXPECT_NEAR(found.x, pixel.x, 1e-6);
    EXPECT_NEAR(found.y, pixel.y, 1e-6);
    EXPECT_NEAR(found.z, 7, 1e-9);
  }
  EXPECT_LT(pixel_of(view, glm::dvec3(view.eye) - glm::dvec3(view.d0)).z, 0) << "behind the eye";
}

}  // namespace
}  // namespace tenebra::viewer
