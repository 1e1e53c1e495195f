// Frames of smooth-shaded bodies: where grazing light ends on them, and that nothing else changes.
#include <gtest/gtest.h>

#include "render/render_fixture.h"
#include "support/hand_made.h"
#include "support/round_bodies.h"

namespace tenebra {
namespace {

using render::Terminator;
using testing::round_body;
using testing::RoundBody;

constexpr int side = 256;

/// Parallel rays along -Z, so that each sample of a sphere is as far to the right as its pixel. From far
/// off: what is seen does not depend on how far out a point lies.
const ViewRays from_front = orthographic_view({0, 0, 8}, 2.2f / side, side, side);

/// Where the sun is: to the right and a little up, so that its terminator crosses the triangles.
constexpr double sun_height = 0.2;

/// A grey body, over a floor if asked for, with that sun; all as bright as files have it that say nothing.
Scene scene_of(const RoundBody& body, bool with_floor) {
  Scene scene;
  scene.materials.push_back({.name = "grey", .base_color = glm::vec3(0.8f)});
  Mesh mesh{.name = "body"};
  mesh.positions = body.positions, mesh.normals = body.normals, mesh.triangles = body.triangles;
  mesh.materials.assign(mesh.triangles.size(), 0);
  add_mesh(scene, std::move(mesh));
  if (with_floor) {
    Mesh floor{.name = "floor"};
    add_quad(floor, {-10, -1.2f, 10}, {20, 0, 0}, {0, 0, -20});
    add_mesh(scene, std::move(floor));
  }
  // -Z turned to -X, and that down.
  add_light(
      scene, make_light(LightType::directional, 2.0f), {0, 0, 0},
      glm::angleAxis(sun_height, glm::dvec3(0, 0, 1)) * glm::dquat(std::sqrt(0.5), 0, std::sqrt(0.5), 0));
  return scene;
}

render::FrameResult drawn(const Scene& scene, const ViewRays& view, render::RenderSettings settings) {
  settings.width = settings.height = side;
  auto raster = render::FrameRaster::create({.kind = render::RasterKind::cpu});
  EXPECT_TRUE(raster) << raster.error().message;
  render::Renderer renderer = render::Renderer::create(std::move(*raster), scene);
  render::FrameInput input = frame_of(scene, side, side);
  input.view = view;
  render::FrameResult result;
  const auto done = renderer.render_frame(input, settings, result);
  EXPECT_TRUE(done) << done.error().message;
  return result;
}

struct Difference {
  double rms = 0;  ///< 1/255
  int pixels = 0, worst = 0;
};

/// Of two pictures, in the pixels where `in_band` says so.
template <class InBand>
Difference difference(const io::Image8& a, const io::Image8& b, const InBand& in_band) {
  Difference d;
  double sum = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (!in_band(x, y)) continue;
      const std::size_t i = 3 * (static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x));
      const int off = std::abs(int{a.pixels[i]} - int{b.pixels[i]});
      sum += off * off, d.worst = std::max(d.worst, off), ++d.pixels;
    }
  }
  d.rms = std::sqrt(sum / std::max(1, d.pixels));
  return d;
}

/// The terminator's band: as far from the plane between light and dark as the planes of a sphere's triangles
/// are turned from its normals (15 degrees), and inside of the coarse outline.
bool in_band(int x, int y) {
  const double u = (x + 0.5 - side / 2.0) * 2.2 / side, v = (side / 2.0 - y - 0.5) * 2.2 / side;
  const double towards = u * std::cos(sun_height) + v * std::sin(sun_height);
  return std::abs(towards) < std::sin(0.262) && u * u + v * v < 0.94 * 0.94;
}

// The sun is square to the view: what a sphere's normal makes of it then depends on the pixel alone, and not
// on how far before the coarse triangles the fine ones lie.
TEST(Terminator, OfACoarseSphereIsThatOfAFineOne) {
  const Scene coarse = scene_of(round_body(10, 16), false), fine = scene_of(round_body(640, 1024), false);
  render::RenderSettings flat, smooth;
  smooth.terminator = Terminator::smooth;
  const render::FrameResult wanted = drawn(fine, from_front, smooth);
  const Difference before = difference(drawn(coarse, from_front, flat).image, wanted.image, in_band),
                   after = difference(drawn(coarse, from_front, smooth).image, wanted.image, in_band);
  RecordProperty("flat_rms", std::to_string(before.rms));
  RecordProperty("smooth_rms", std::to_string(after.rms));
  std::printf("band of %d pixels: flat %.3f, smooth %.3f /255 (worst %d, %d)\n", after.pixels, before.rms,
              after.rms, before.worst, after.worst);
  EXPECT_GT(after.pixels, side * side / 12);
  EXPECT_GT(before.rms, 3);
  EXPECT_GT(before.worst, 20);
  EXPECT_LT(after.rms, 0.5);
  // The fine sphere's own teeth are a 64th as long.
  const Difference own = difference(drawn(fine, from_front, flat).image, wanted.image, in_band);
  EXPECT_LT(own.rms, before.rms / 8);
}

TEST(Terminator, WithoutShadowsItIsSmoothToo) {
  const Scene coarse = scene_of(round_body(10, 16), false), fine = scene_of(round_body(640, 1024), false);
  render::RenderSettings flat{.shadows = render::ShadowMode::none}, smooth = flat;
  smooth.terminator = Terminator::smooth;
  const render::FrameResult wanted = drawn(fine, from_front, smooth);
  EXPECT_GT(difference(drawn(coarse, from_front, flat).image, wanted.image, in_band).rms, 3);
  EXPECT_LT(difference(drawn(coarse, from_front, smooth).image, wanted.image, in_band).rms, 0.5);
}

/// A rectangle to the right of the body, of 1 m, in place of the sun.
Scene with_area(Scene scene) {
  scene.lights.clear();
  scene.nodes.pop_back();
  add_light(scene, make_light(LightType::point, 200.0f), {8, 0.5, 1});
  return scene;
}

TEST(Terminator, OfSoftShadowsIsThatOfAFineSphere) {
  const Scene coarse = with_area(scene_of(round_body(10, 16), false)),
              fine = with_area(scene_of(round_body(80, 128), false));
  render::RenderSettings flat{.shadows = render::ShadowMode::soft}, smooth = flat;
  flat.area_lights.size = smooth.area_lights.size = glm::vec2(1.0f);
  smooth.terminator = Terminator::smooth;
  const render::FrameResult wanted = drawn(fine, from_front, smooth);
  const auto near = [](int x, int y) { return in_band(x, y); };
  const Difference before = difference(drawn(coarse, from_front, flat).image, wanted.image, near),
                   after = difference(drawn(coarse, from_front, smooth).image, wanted.image, near);
  std::printf("band of %d pixels: flat %.3f, smooth %.3f /255 (worst %d, %d)\n", after.pixels, before.rms,
              after.rms, before.worst, after.worst);
  EXPECT_GT(before.rms, 3 * after.rms);
  EXPECT_LT(after.rms, 0.5);
}

// Exact soft shadows and those of many points of the light, which are hard, agree on lifted points: bumps
// and dents, and light from below the triangles' planes.
TEST(Terminator, SoftShadowsAgreeWithManyHardOnes) {
  const Scene scene = with_area(scene_of(round_body(12, 20, {0, 0, 0}, 0.15), true));
  render::RenderSettings exact{.shadows = render::ShadowMode::soft, .terminator = Terminator::smooth};
  exact.area_lights.size = glm::vec2(2.0f);
  render::RenderSettings points = exact;
  points.soft_points = 400;
  const render::FrameResult a = drawn(scene, from_front, exact), b = drawn(scene, from_front, points);
  const auto everywhere = [](int, int) { return true; };
  const Difference d = difference(a.image, b.image, everywhere);
  std::printf("exact and 400 points: %.3f /255, worst %d\n", d.rms, d.worst);
  EXPECT_LT(d.rms, 0.6);
  EXPECT_LT(d.worst, 12);
  const SoftSolver others[] = {SoftSolver::clip, SoftSolver::bsp};
  for (const SoftSolver solver : others) {
    render::RenderSettings other = exact;
    other.soft.solver = solver;
    EXPECT_LE(difference(a.image, drawn(scene, from_front, other).image, everywhere).worst, 1);
  }
}

// Flat shading, flat floors, shadows that others cast: the same bits.
TEST(Terminator, NothingElseChanges) {
  const ViewRays above = look_at({3, 4, 6}, {0, -0.5f, 0}, {0, 1, 0}, 0.8f, 0.1f, side, side);
  for (const render::ShadowMode shadows : {render::ShadowMode::hard, render::ShadowMode::soft}) {
    render::RenderSettings flat{.shadows = shadows}, smooth = flat;
    flat.area_lights.size = smooth.area_lights.size = glm::vec2(1.0f);
    smooth.terminator = Terminator::smooth;
    RoundBody body = round_body(10, 16);
    const Scene round = with_area(scene_of(body, true));
    const render::FrameResult before = drawn(round, above, flat), after = drawn(round, above, smooth);
    std::fill(body.normals.begin(), body.normals.end(), glm::vec3(0));
    const Scene faceted = with_area(scene_of(body, true));
    const render::FrameResult one = drawn(faceted, above, flat), other = drawn(faceted, above, smooth);
    EXPECT_EQ(one.image.pixels, other.image.pixels);
    EXPECT_EQ(one.masks[0].mask.pixels, other.masks[0].mask.pixels);
    // The floor is below the outline of the body: pixels whose ray meets it first.
    std::size_t floor = 0, shadow = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const auto at = on_plane(above, x, y, double{-1.2f});
        const glm::dvec3 d = glm::normalize(glm::dvec3(above.d0) + (x + 0.5) * glm::dvec3(above.dx) +
                                            (y + 0.5) * glm::dvec3(above.dy));
        const glm::dvec3 eye(above.eye), nearest = eye - glm::dot(eye, d) * d;
        if (!at || glm::length(nearest) < 1.001) continue;
        const std::size_t i = static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x);
        EXPECT_EQ(before.masks[0].mask.pixels[i], after.masks[0].mask.pixels[i]) << x << ' ' << y;
        for (std::size_t c = 0; c < 3; ++c)
          EXPECT_EQ(before.image.pixels[3 * i + c], after.image.pixels[3 * i + c]) << x << ' ' << y;
        ++floor, shadow += before.masks[0].mask.pixels[i] < 255;
      }
    }
    EXPECT_GT(floor, 10000u);
    EXPECT_GT(shadow, 300u);
    EXPECT_NE(before.image.pixels, after.image.pixels);
  }
}

// Ambient occlusion starts from the lifted points: over a convex body nothing is hidden either way.
TEST(Terminator, OcclusionIsThatOfTheLiftedPoints) {
  const Scene scene = scene_of(round_body(10, 16), true);
  const ViewRays above = look_at({3, 4, 6}, {0, -0.5f, 0}, {0, 1, 0}, 0.8f, 0.1f, side, side);
  render::RenderSettings flat{.shadows = render::ShadowMode::none}, smooth = flat;
  Scene lit = scene;
  lit.ambient_light = glm::vec3(1.0f);
  flat.ao.mode = smooth.ao.mode = AoMode::field;
  smooth.terminator = Terminator::smooth;
  const render::FrameResult a = drawn(lit, above, flat), b = drawn(lit, above, smooth);
  const Difference d = difference(a.image, b.image, [](int, int) { return true; });
  std::printf("occlusion: %.3f /255, worst %d\n", d.rms, d.worst);
  EXPECT_LT(d.rms, 3);
}

}  // namespace
}  // namespace tenebra
