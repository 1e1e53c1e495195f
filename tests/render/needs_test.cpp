// Only what a scene requires: which work is skipped, and that the picture has the same bits as if it were
// not.
#include <array>

#include "formats/import_scene.h"
#include "render/render_fixture.h"

namespace tenebra {
namespace {

constexpr int needs_width = 120, needs_height = 90;

Scene bundled(const char* file) {
  auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / file);
  EXPECT_TRUE(scene) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

render::FrameInput frame_at(const Scene& scene, double time_s) {
  render::FrameInput input;
  evaluate_frame(scene, 0, time_s, input.geometry);
  input.lights = evaluate_lights(scene, 0, time_s);
  input.view = evaluate_camera(scene, 0, time_s, 0, needs_width, needs_height);
  return input;
}

render::FrameResult drawn(render::Renderer& renderer, const render::FrameInput& input,
                          const render::RenderSettings& settings) {
  render::FrameResult result;
  const auto done = renderer.render_frame(input, settings, result);
  EXPECT_TRUE(done) << done.error().message;
  return result;
}

// 1e-30 of the light adds nothing that a picture could hold, but has to be traced; 0 has not.
TEST(Needs, ALightThatIsOffIsNotTraced) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "on", .falloff = Falloff::none, .intensity = 0.5f}, {1, 4, 0});
  add_light(scene, {.name = "off", .falloff = Falloff::none, .intensity = 0}, {-3, 5, 1});
  for (const render::ShadowMode mode : {render::ShadowMode::hard, render::ShadowMode::soft}) {
    render::RenderSettings settings{.width = needs_width, .height = needs_height, .shadows = mode};
    settings.area_lights.size = {1, 1};
    scene.lights[1].intensity = 0;
    const render::FrameResult off = draw(scene, settings);
    scene.lights[1].intensity = 1e-30f;
    const render::FrameResult faint = draw(scene, settings);
    EXPECT_EQ(off.image, faint.image);
    EXPECT_EQ(off.masks.size(), 1u);
    EXPECT_EQ(faint.masks.size(), 2u);
    EXPECT_LT(off.stats.rays + off.soft.groups, faint.stats.rays + faint.soft.groups);
  }
}

TEST(Needs, WithoutShadowsAndOcclusionNoPointIsComputed) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "lamp", .falloff = Falloff::none, .intensity = 0.5f}, {1, 40, 0});
  render::RenderSettings settings{
      .width = needs_width, .height = needs_height, .shadows = render::ShadowMode::none};
  const render::FrameResult plain = draw(scene, settings);
  EXPECT_EQ(plain.timings.points_ms, 0);
  EXPECT_TRUE(plain.masks.empty());
  settings.shadows = render::ShadowMode::hard;
  scene.nodes[0].mesh = -1;  // nothing there: the same sky with shadows as without
  const render::FrameResult sky = draw(scene, settings);
  settings.shadows = render::ShadowMode::none;
  EXPECT_EQ(sky.image, draw(scene, settings).image);
  EXPECT_EQ(sky.stats.rays, 0u);
  EXPECT_EQ(sky.stats.nodes, 0u);
  EXPECT_EQ(sky.stats.leaf_tests, 0u);
}

// Boxes are refitted around what moved, the order of the triangles is kept: a renderer that followed the
// animation draws what a new one draws, and one that has just met every vertex elsewhere.
TEST(Needs, WhatStandsIsNotRefitted) {
  const Scene scene = bundled("city.glb");
  const render::RenderSettings settings{.width = needs_width, .height = needs_height};
  const std::array times_s{1.0, 1.1, 2.5};
  std::vector<io::Image8> followed;
  {
    render::Renderer kept = renderer_for(scene);
    for (const double t : times_s) followed.push_back(drawn(kept, frame_at(scene, t), settings).image);
  }
  {
    render::Renderer shaken = renderer_for(scene);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      const render::FrameInput input = frame_at(scene, times_s[i]);
      render::FrameInput moved = input;
      for (glm::vec3& p : moved.geometry.positions) p.x += 7;
      drawn(shaken, moved, settings);
      EXPECT_EQ(drawn(shaken, input, settings).image, followed[i]) << times_s[i];
    }
  }
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    render::Renderer fresh = renderer_for(scene);
    EXPECT_EQ(drawn(fresh, frame_at(scene, times_s[i]), settings).image, followed[i]) << times_s[i];
  }
}

// Sorted or not, in one pass or two, with a tree over the triangles or without.
TEST(Needs, SortAndPassesChangeTheWorkAndNotThePicture) {
  const Scene scene = bundled("city.glb");
  const render::FrameInput input = frame_at(scene, 5);
  render::Renderer renderer = renderer_for(scene);
  render::RenderSettings settings{.width = needs_width, .height = needs_height};
  const io::Image8 expected = drawn(renderer, input, settings).image;
  std::uint64_t nodes[2] = {};
  for (const Variant variant : {Variant::precise, Variant::precise_sorted, Variant::precise_sea,
                                Variant::precise_eatp, Variant::precise_seatp}) {
    settings.hard.variant = variant;
    const render::FrameResult result = drawn(renderer, input, settings);
    EXPECT_EQ(result.image, expected) << variant_name(variant);
    if (variant == Variant::precise) nodes[0] = result.stats.nodes;
    if (variant == Variant::precise_sorted) nodes[1] = result.stats.nodes;
  }
  EXPECT_LT(nodes[1], nodes[0]) << "the sort is there for something";
}

// Points that the light's range does not hold get no ray; they are as dark with a ray that finds nothing.
TEST(Needs, PointsOutOfALightsReachGetNoRay) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "lamp", .falloff = Falloff::none, .intensity = 0.5f}, {1, 4, 0});
  render::RenderSettings settings{.width = needs_width, .height = needs_height};
  const render::FrameResult all = draw(scene, settings);
  scene.lights[0].range_m = 6.0f;
  const render::FrameResult few = draw(scene, settings);
  EXPECT_LT(few.stats.rays, all.stats.rays);
  const auto &with_rays = all.masks[0].mask.pixels, &without = few.masks[0].mask.pixels;
  settings.shadows = render::ShadowMode::none;
  const io::Image8 lit = draw(scene, settings).image;
  std::size_t spared = 0;
  for (std::size_t i = 0; i < without.size(); ++i) {
    ASSERT_LE(without[i], with_rays[i]) << "a ray less blocks nothing";
    if (without[i] == with_rays[i]) continue;
    ++spared;
    for (std::size_t c = 0; c < 3; ++c)
      ASSERT_EQ(lit.pixels[3 * i + c], few.image.pixels[3 * i + c]) << "lit or not, it is the same picture";
  }
  EXPECT_GT(spared, 100u);
}

// Shafts leave out what cannot stand between a group and the light: more of it changes no bit.
TEST(Needs, WhatLiesOutsideEveryShaftCostsNoCandidate) {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "panel", .type = LightType::area_rect, .intensity = 4, .size_m = {1, 1}},
            {0, 3, 0}, facing_down);
  render::RenderSettings settings{
      .width = needs_width, .height = needs_height, .shadows = render::ShadowMode::soft};
  const render::FrameResult before = draw(scene, settings);
  Mesh below{.name = "below the floor"};
  for (int i = 0; i < 500; ++i)
    add_quad(below, {0.03f * static_cast<float>(i) - 7, -2, 1}, {0.02f, 0, 0}, {0, 0, -2});
  add_mesh(scene, std::move(below));
  const render::FrameResult after = draw(scene, settings);
  EXPECT_EQ(after.image, before.image);
  EXPECT_EQ(after.masks[0].visible_fraction.pixels, before.masks[0].visible_fraction.pixels);
  EXPECT_EQ(after.soft.candidates, before.soft.candidates);
  EXPECT_GT(before.soft.points_lit, before.soft.points_penumbra) << "decided without a solver";
  EXPECT_GT(before.soft.points_dark, 0u);
}

// Fields and samples are made when something visible needs them; those made for other views change no bit.
TEST(Needs, OcclusionOfAViewDoesNotDependOnWhatWasSeenBefore) {
  const Scene scene = bundled("city.glb");
  render::RenderSettings settings{
      .width = needs_width, .height = needs_height, .shadows = render::ShadowMode::none};
  settings.ao.mode = AoMode::field;
  settings.ao.rays = 16;
  settings.ao.positions = settings.ao.directions = 64;
  const render::FrameInput here = frame_at(scene, 5);
  render::FrameInput sky = here;
  sky.view.d0 = {0, 1, 0}, sky.view.dx = {1e-4f, 0, 0}, sky.view.dy = {0, 0, 1e-4f};
  sky.view.eye.y += 1000;
  render::FrameResult expected;
  {
    render::Renderer fresh = renderer_for(scene);
    expected = drawn(fresh, here, settings);
  }
  EXPECT_GT(expected.ao.fields_built, 0u);
  render::Renderer travelled = renderer_for(scene);
  const render::FrameResult nothing = drawn(travelled, sky, settings);
  EXPECT_EQ(nothing.ao.fields_built, 0u) << "nobody sees where they would matter";
  EXPECT_EQ(nothing.ao.cache_cells, 0u);
  const render::FrameResult elsewhere = drawn(travelled, frame_at(scene, 1), settings);
  EXPECT_GT(elsewhere.ao.cache_cells, 0u);
  const render::FrameResult again = drawn(travelled, here, settings);
  EXPECT_EQ(again.image, expected.image);
  EXPECT_GE(again.ao.cache_cells, expected.ao.cache_cells);
  EXPECT_EQ(drawn(travelled, here, settings).ao.fields_built, 0u) << "kept";
}

}  // namespace
}  // namespace tenebra
