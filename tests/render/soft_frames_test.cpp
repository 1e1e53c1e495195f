// Frames with soft shadows: pictures against closed forms, masks against geometry.
#include <cstdint>
#include <random>

#include <tenebra/stop_flag.h>
#include "render/render_fixture.h"

namespace tenebra {
namespace {

using glm::vec3;

constexpr int soft_width = 121, soft_height = 91;
const render::RenderSettings soft{
    .width = soft_width, .height = soft_height, .shadows = render::ShadowMode::soft};

Light rectangle_light(float nits, glm::vec2 size) {
  return {.name = "panel", .type = LightType::area_rect, .intensity = nits, .size_m = size};
}
Light point_light(float intensity, Falloff falloff = Falloff::inverse_square) {
  return {.name = "lamp", .type = LightType::point, .falloff = falloff, .intensity = intensity};
}

render::RenderSettings with_size(glm::vec2 size) {
  render::RenderSettings settings = soft;
  settings.area_lights.size = size;
  return settings;
}

/// Compares every pixel that sees the floor with the linear value of `expected(point on the floor)`.
template <class Expected>
void expect_floor(const render::FrameResult& result, const ViewRays& view, Expected expected) {
  int seen = 0;
  for (int y = 0; y < soft_height; ++y) {
    for (int x = 0; x < soft_width; ++x) {
      const auto p = on_plane(view, x, y);
      if (!p || std::max(std::abs(p->x), std::abs(p->z)) > 9.9) continue;
      ++seen;
      const double level = srgb_level(expected(*p));
      // Half a level of rounding, and what single precision adds to it.
      ASSERT_NEAR(result.image.pixels[static_cast<std::size_t>(3 * (y * soft_width + x))], level, 0.52)
          << x << ' ' << y;
    }
  }
  EXPECT_GT(seen, 5000);
}

/// At (0, 3, 0), 2 wide in x, 1 in z, shining down.
double below_panel(const glm::dvec3& p) {
  return irradiance_below({-1 - p.x, -0.5 - p.z}, {1 - p.x, 0.5 - p.z}, 3);
}

TEST(SoftFrames, AFloorUnderARectangleHasTheIrradianceOfItsFormFactor) {
  Scene scene = white_floor(false);
  add_light(scene, rectangle_light(4, {2, 1}), {0, 3, 0}, facing_down);
  const render::FrameResult result = draw(scene, soft);
  const double pi = std::acos(-1.0);
  // Below the centre: four corners with a = 1/3 and b = 1/6, by hand.
  EXPECT_NEAR(below_panel({0, 0, 0}) / pi, 4 * (0.049588 + 0.052230) / (2 * pi), 1e-5);
  expect_floor(result, frame_of(scene, soft_width, soft_height).view,
               [&](const glm::dvec3& p) { return 4 * below_panel(p) / pi; });
  EXPECT_TRUE(result.notes.empty());
}

TEST(SoftFrames, APointLightMadeARectangleKeepsItsFlux) {
  Scene scene = white_floor(false);
  add_light(scene, point_light(8), {0, 3, 0});
  const render::FrameResult result = draw(scene, with_size({2, 1}));
  expect_floor(result, frame_of(scene, soft_width, soft_height).view, [&](const glm::dvec3& p) {
    return 8.0 / 2.0 * below_panel(p) / std::acos(-1.0);  // radiance = intensity / area
  });
}

TEST(SoftFrames, ALightWithoutFalloffIsScaledByItsDistance) {
  Scene scene = white_floor(false);
  add_light(scene, point_light(0.7f, Falloff::none), {0, 3, 0});
  const render::FrameResult result = draw(scene, with_size({2, 1}));
  expect_floor(result, frame_of(scene, soft_width, soft_height).view, [&](const glm::dvec3& p) {
    const double squared = p.x * p.x + 9 + p.z * p.z;
    return 0.7 * squared / 2.0 * below_panel(p);
  });
}

/// A floor and 6,000 small triangles between it and (0, 3, 0).
Scene floor_below_leaves() {
  std::mt19937 random(73);
  std::uniform_real_distribution<float> across(-6, 6), up(0.8f, 2.0f), step(-0.2f, 0.2f);
  Scene scene = white_floor(false);
  Mesh mesh{.name = "leaves"};
  for (int i = 0; i < 6000; ++i) {
    const vec3 middle(across(random), up(random), across(random));
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(middle + vec3(step(random), step(random), step(random)));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    mesh.materials.push_back(0);
  }
  add_mesh(scene, std::move(mesh));
  return scene;
}

// In museum5, whose lamps have no fall-off and shine evenly, 2/255 were asked for and 0.8 told where 5.9 were
// off.
TEST(SoftFrames, AllowedErrorsAreThoseOfTheLightThatIsShown) {
  Scene scene = floor_below_leaves();
  add_light(scene, point_light(0.7f, Falloff::none), {0, 3, 0});
  render::RenderSettings settings = with_size({2, 2});
  settings.area_lights.emission = render::LightEmission::point;
  settings.aovs.irradiance = true;
  const render::FrameResult exact = draw(scene, settings);
  const std::vector<float>& light = exact.aovs.irradiance.pixels;
  std::vector<float> sorted(light);
  std::sort(sorted.begin(), sorted.end());
  const double white = sorted[sorted.size() * 999 / 1000];
  for (const double asked : {8.0, 4.0}) {
    settings.soft.error_255 = asked;
    const render::FrameResult drawn = draw(scene, settings);
    EXPECT_GT(drawn.soft.points_sampled, 500u);
    double sum = 0;
    int penumbra = 0;
    for (std::size_t i = 0; i < exact.masks[0].visible_fraction.pixels.size(); ++i) {
      const float fraction = exact.masks[0].visible_fraction.pixels[i];
      if (!(fraction > 0 && fraction < 1)) continue;
      const double off = 255 * (drawn.aovs.irradiance.pixels[3 * i] - light[3 * i]) / white;
      sum += off * off, ++penumbra;
    }
    const double error = std::sqrt(sum / penumbra), told = drawn.soft.error_255;
    EXPECT_LE(error, 1.25 * asked);
    EXPECT_LE(error, 1.5 * told) << asked;
    EXPECT_LE(told, 1.5 * error) << asked;
  }
}

TEST(SoftFrames, PercentMeansTheDiagonalOfTheScene) {
  Scene scene = white_floor(false);
  add_light(scene, point_light(8), {0, 3, 0});
  render::RenderSettings percent = with_size({5, 2.5f});
  percent.area_lights.percent_of_diagonal = true;
  const float diagonal = std::sqrt(800.0f);
  EXPECT_EQ(draw(scene, percent).image, draw(scene, with_size({0.05f * diagonal, 0.025f * diagonal})).image);
}

// Light: the square |x|, |z| < 0.5 at y = 5; plate: |x|, |z| < 1 at y = 1. From a point of the floor the
// plate covers, on the light's plane, the square of half width 5 around -4 times the point.
TEST(SoftFrames, TheVisiblePartOfTheLightIsWhatGeometrySays) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(1, {1, 1}), {0, 5, 0}, facing_down);
  const render::FrameResult result = draw(scene, soft);
  const ViewRays view = frame_of(scene, soft_width, soft_height).view;
  ASSERT_EQ(result.masks.size(), 1u);
  const render::LightMask& mask = result.masks[0];
  ASSERT_EQ(mask.visible_fraction.pixels.size(), std::size_t(soft_width) * soft_height);
  int lit = 0, dark = 0, penumbra = 0;
  for (int y = 0; y < soft_height; ++y) {
    for (int x = 0; x < soft_width; ++x) {
      const auto p = on_plane(view, x, y), plate = on_plane(view, x, y, 1);
      if (!p || std::max(std::abs(p->x), std::abs(p->z)) > 9.9) continue;
      if (plate && std::max(std::abs(plate->x), std::abs(plate->z)) < 1.01) continue;
      const auto covered = [](double at) {
        return std::clamp(0.5, -5 - 4 * at, 5 - 4 * at) - std::clamp(-0.5, -5 - 4 * at, 5 - 4 * at);
      };
      const double expected = 1 - covered(p->x) * covered(p->z);
      const std::size_t i = static_cast<std::size_t>(y * soft_width + x);
      ASSERT_NEAR(mask.visible_fraction.pixels[i], expected, 2e-4) << x << ' ' << y;
      ASSERT_EQ(mask.mask.pixels[i], std::lround(255 * mask.visible_fraction.pixels[i]));
      lit += expected == 1;
      dark += expected == 0;
      penumbra += expected > 0 && expected < 1;
    }
  }
  EXPECT_GT(lit, 3000);
  EXPECT_GT(dark, 50);
  EXPECT_GT(penumbra, 30);
  EXPECT_EQ(result.soft.points_penumbra > 0, true);
}

// A small light far above: its cosine is 1 all over the floor, its penumbra 2 mm wide.
TEST(SoftFrames, SmallLightsTendToHardShadows) {
  for (const Falloff falloff : {Falloff::inverse_square, Falloff::none}) {
    Scene scene = white_floor(true);
    add_light(scene, point_light(falloff == Falloff::none ? 0.6f : 5e5f, falloff), {0, 500, 0});
    render::RenderSettings hard = soft;
    hard.shadows = render::ShadowMode::hard;
    const render::FrameResult by_area = draw(scene, with_size({1, 1})), by_point = draw(scene, hard);
    int different = 0;
    for (std::size_t i = 0; i < by_area.image.pixels.size(); ++i) {
      different += std::abs(by_area.image.pixels[i] - by_point.image.pixels[i]) > 1;
    }
    EXPECT_LE(different, 3 * 3) << "no more than three pixels in the penumbra";
    EXPECT_GT(std::count(by_point.masks[0].mask.pixels.begin(), by_point.masks[0].mask.pixels.end(), 0), 50);
  }
}

TEST(SoftFrames, EachOfSeveralLightsHasItsOwnShadow) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(2, {1, 1}), {0, 5, 0}, facing_down);
  add_light(scene, rectangle_light(3, {2, 0.5f}), {3, 4, 0}, facing_down);
  add_light(scene, point_light(5), {-3, 4, 1});
  const render::FrameResult all = draw(scene, with_size({1, 0.5f}));
  ASSERT_EQ(all.masks.size(), 3u);
  std::vector<double> sum(all.image.pixels.size());
  for (int light = 0; light < 3; ++light) {
    render::RenderSettings one = with_size({1, 0.5f});
    one.light = light;
    const render::FrameResult single = draw(scene, one);
    ASSERT_EQ(single.masks.size(), 1u);
    EXPECT_EQ(single.masks[0].light, light);
    EXPECT_EQ(single.masks[0].visible_fraction, all.masks[static_cast<std::size_t>(light)].visible_fraction);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double y = single.image.pixels[i] / 255.0;
      sum[i] += y <= 0.04045 ? y / 12.92 : std::pow((y + 0.055) / 1.055, 2.4);
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    ASSERT_NEAR(all.image.pixels[i], srgb_level(sum[i]), sum[i] < 0.02 ? 6 : 2) << i;
  }
}

TEST(SoftFrames, TheSameBitsForEveryThreadCount) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(2, {1, 1}), {0.3f, 5, 0.1f}, facing_down);
  const render::FrameResult expected = draw(scene, soft);
  for (const int threads : {1, 2, 3, 7}) {
    render::RenderSettings settings = soft;
    settings.threads = threads;
    const render::FrameResult found = draw(scene, settings);
    EXPECT_EQ(found.image, expected.image) << threads;
    EXPECT_EQ(found.masks[0].visible_fraction, expected.masks[0].visible_fraction) << threads;
  }
}

TEST(SoftFrames, EverySolverGivesTheSamePicture) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(2, {1, 1}), {0.3f, 5, 0.1f}, facing_down);
  const render::FrameResult expected = draw(scene, soft);
  for (const SoftSolver solver : {SoftSolver::automatic, SoftSolver::bsp, SoftSolver::clip}) {
    render::RenderSettings settings = soft;
    settings.soft.solver = solver;
    const render::FrameResult found = draw(scene, settings);
    for (std::size_t i = 0; i < expected.image.pixels.size(); ++i) {
      ASSERT_NEAR(found.image.pixels[i], expected.image.pixels[i], 1) << i;
    }
  }
}

TEST(SoftFrames, LightsWithoutASizeKeepHardShadowsAndAreNamedOnce) {
  Scene scene = white_floor(true);
  add_light(scene, point_light(30), {0, 5, 0});
  add_light(scene, {.name = "sun", .type = LightType::directional}, {0, 5, 0}, facing_down);
  render::Renderer renderer = renderer_for(scene);
  const render::FrameInput input = frame_of(scene, soft_width, soft_height);
  render::FrameResult result;
  ASSERT_TRUE(renderer.render_frame(input, soft, result));
  ASSERT_EQ(result.notes.size(), 2u);
  EXPECT_EQ(
      result.notes[0],
      "light 0 (lamp) is a point and keeps hard shadows, unless --light-size or --set-light gives it a size");
  EXPECT_EQ(result.notes[1],
            "light 1 (sun) is directional and keeps hard shadows, unless --light-size sun=DEGREES or "
            "--set-light gives it a "
            "diameter");
  const io::Image8 image = result.image;
  for (const render::LightMask& mask : result.masks) {
    ASSERT_EQ(mask.visible_fraction.pixels.size(), mask.mask.pixels.size());
    for (std::size_t i = 0; i < mask.mask.pixels.size(); ++i) {
      ASSERT_EQ(mask.visible_fraction.pixels[i], mask.mask.pixels[i] / 255.0f);
    }
  }
  render::RenderSettings hard = soft;
  hard.shadows = render::ShadowMode::hard;
  ASSERT_TRUE(renderer.render_frame(input, soft, result));
  EXPECT_TRUE(result.notes.empty());
  ASSERT_TRUE(renderer.render_frame(input, hard, result));
  EXPECT_EQ(result.image, image);
  EXPECT_TRUE(result.masks[0].visible_fraction.pixels.empty());
}

/// A panel of 2 x 1 at (0, 3, 0) that faces down, with or without a material that shines.
Mesh panel(std::uint32_t material) {
  Mesh mesh{.name = "lamp face"};
  add_quad(mesh, {-1, 3, -0.5f}, {2, 0, 0}, {0, 0, 1}, material);
  return mesh;
}

TEST(SoftFrames, TheFaceOfALampDoesNotHideItsLight) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(4, {2, 1}), {0, 3, 0}, facing_down);
  const render::FrameResult bare = draw(scene, soft);
  add_mesh(scene, panel(0));  // casts, and lies in the light
  const render::FrameResult faced = draw(scene, soft);
  const ViewRays view = frame_of(scene, soft_width, soft_height).view;
  int compared = 0;
  for (int y = 0; y < soft_height; ++y) {
    for (int x = 0; x < soft_width; ++x) {
      const auto p = on_plane(view, x, y, 3);
      if (p && std::abs(p->x) < 1.1 && std::abs(p->z) < 0.6) continue;  // the face hides what is behind it
      const std::size_t i = static_cast<std::size_t>(y * soft_width + x);
      ASSERT_EQ(faced.masks[0].visible_fraction.pixels[i], bare.masks[0].visible_fraction.pixels[i]);
      ++compared;
    }
  }
  EXPECT_GT(compared, 8000);
}

TEST(SoftFrames, EmissiveQuadsShineWhenAskedTo) {
  Scene scene = white_floor(false);
  scene.materials.push_back({.name = "glow", .base_color = vec3(0.0f), .emissive = vec3(4.0f)});
  add_mesh(scene, panel(1));
  render::RenderSettings settings = soft;
  const render::FrameResult without = draw(scene, settings);
  EXPECT_TRUE(without.masks.empty());
  settings.area_lights.emissive_quads = true;
  const render::FrameResult result = draw(scene, settings);
  ASSERT_EQ(result.masks.size(), 1u);
  EXPECT_EQ(result.masks[0].light, 0);
  const ViewRays view = frame_of(scene, soft_width, soft_height).view;
  for (int y = 0; y < soft_height; ++y) {
    for (int x = 0; x < soft_width; ++x) {
      const auto p = on_plane(view, x, y), face = on_plane(view, x, y, 3);
      if (!p || std::max(std::abs(p->x), std::abs(p->z)) > 9.9) continue;
      if (face && std::abs(face->x) < 1.1 && std::abs(face->z) < 0.6) continue;
      ASSERT_NEAR(result.image.pixels[static_cast<std::size_t>(3 * (y * soft_width + x))],
                  srgb_level(4 * below_panel(*p) / std::acos(-1.0)), 0.52);
    }
  }
}

TEST(SoftFrames, AnEmissiveFaceOfAnAreaLightCountsOnce) {
  Scene scene = white_floor(false);
  scene.materials.push_back({.name = "glow", .base_color = vec3(0.0f), .emissive = vec3(4.0f)});
  add_mesh(scene, panel(1));
  add_light(scene, rectangle_light(4, {2, 1}), {0, 3, 0}, facing_down);
  render::RenderSettings settings = soft;
  const render::FrameResult expected = draw(scene, settings);
  settings.area_lights.emissive_quads = true;
  const render::FrameResult found = draw(scene, settings);
  EXPECT_EQ(found.image, expected.image);
  EXPECT_EQ(found.notes,
            std::vector<std::string>{"mesh lamp face is the face of an area light and counts once"});
}

TEST(SoftFrames, RefusesWhatItCannotDo) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(4, {2, 1}), {0, 3, 0}, facing_down);
  render::Renderer renderer = renderer_for(scene);
  const render::FrameInput input = frame_of(scene, soft_width, soft_height);
  render::FrameResult result;
  render::RenderSettings depth = soft;
  depth.samples = render::SampleSource::depth;
  const auto from_depth = renderer.render_frame(input, depth, result);
  ASSERT_FALSE(from_depth);
  EXPECT_EQ(from_depth.error().message,
            "samples from the depth buffer: a soft shadow needs the exact points from triangle ids");
  StopFlag stop;
  stop.request();
  const auto stopped = renderer.render_frame(input, soft, result, {}, &stop);
  ASSERT_FALSE(stopped);
  EXPECT_TRUE(is_stop(stopped));
  ASSERT_TRUE(renderer.render_frame(input, soft, result)) << "and goes on afterwards";
}

TEST(SoftFrames, NothingSeenAndNothingLitAreFrames) {
  Scene scene = white_floor(true);
  add_light(scene, rectangle_light(4, {2, 1}), {0, 3, 0}, facing_down);
  render::Renderer renderer = renderer_for(scene);
  render::FrameInput input = frame_of(scene, soft_width, soft_height);
  input.view = look_at({0, 8, 8}, {0, 16, 16}, {0, 1, 0}, 0.8f, 0.1f, soft_width, soft_height);
  render::FrameResult result;
  ASSERT_TRUE(renderer.render_frame(input, soft, result));
  EXPECT_EQ(*std::max_element(result.masks[0].mask.pixels.begin(), result.masks[0].mask.pixels.end()), 0);
  input.lights.clear();
  ASSERT_TRUE(renderer.render_frame(input, soft, result));
  EXPECT_TRUE(result.masks.empty());
}

}  // namespace
}  // namespace tenebra
