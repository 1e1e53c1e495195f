// Area lights as a few points: where they lie, and that their shadows go to the exact ones as they grow.
#include "render/light_points.h"
#include <tenebra/stop_flag.h>
#include "render/render_fixture.h"

namespace tenebra {
namespace {

using glm::dvec2;
using glm::vec3;

AreaLight light_of(const std::vector<vec3>& vertices) {
  const auto light = make_area_light(vertices);
  EXPECT_TRUE(light) << light.error().message;
  return *light;
}

/// A square, a long rectangle, a triangle and a 12-gon, none along the axes.
std::vector<AreaLight> lights() {
  return {*make_rectangle_light({1, 2, 3}, {1, 0.5f, 0}, {-0.5f, 1, 0}),
          *make_rectangle_light({0, 5, 0}, {8, 0, 1}, {0.02f, 0, -0.16f}),
          light_of({{0, 0, 0}, {3, 0, 1}, {1, 0, -4}}),
          *make_disc_light({-3, 1, 2}, {0.7f, 0.1f, 0}, {-0.1f, 0.7f, 0})};
}

/// Area of the part of a convex outline where dot(direction, p) > offset.
double area_beyond(const std::vector<dvec2>& outline, dvec2 direction, double offset) {
  double doubled = 0;
  std::vector<dvec2> part;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
    const double ha = glm::dot(a, direction) - offset, hb = glm::dot(b, direction) - offset;
    if (ha > 0) part.push_back(a);
    if ((ha > 0) != (hb > 0)) part.push_back(a + ha / (ha - hb) * (b - a));
  }
  for (std::size_t i = 0; i < part.size(); ++i) {
    const dvec2 a = part[i], b = part[(i + 1) % part.size()];
    doubled += a.x * b.y - a.y * b.x;
  }
  return std::abs(doubled) / 2;
}

TEST(LightPoints, StandForEqualAreas) {
  constexpr int count = 256;
  for (const AreaLight& light : lights()) {
    std::vector<dvec2> places;
    for (const vec3& p : render::points_on_light(light, count)) {
      const glm::dvec3 from = glm::dvec3(p) - light.centre;
      EXPECT_NEAR(glm::dot(from, light.normal), 0, 1e-6);
      places.emplace_back(glm::dot(from, light.ex), glm::dot(from, light.ey));
    }
    ASSERT_EQ(places.size(), std::size_t{count});
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.5236 * i + 0.1;
      const dvec2 direction(std::cos(angle), std::sin(angle));
      for (const double offset : {-0.3, 0.0, 0.2}) {
        const auto beyond = std::count_if(places.begin(), places.end(),
                                          [&](const dvec2& p) { return glm::dot(p, direction) > offset; });
        // The discrepancy of such lattices for half planes: some sqrt(count) / 2 at most.
        EXPECT_NEAR(static_cast<double>(beyond),
                    count * area_beyond(light.polygon, direction, offset) / light.area_m2, 8)
            << light.polygon.size() << " vertices, " << i << ' ' << offset;
      }
    }
  }
}

TEST(LightPoints, LieOnTheLightHoweverFew) {
  for (const AreaLight& light : lights()) {
    for (const int count : {1, 2, 3, 7}) {
      for (const vec3& p : render::points_on_light(light, count)) {
        const glm::dvec3 from = glm::dvec3(p) - light.centre;
        const dvec2 q(glm::dot(from, light.ex), glm::dot(from, light.ey));
        for (std::size_t i = 0; i < light.polygon.size(); ++i) {
          const dvec2 a = light.polygon[i], along = light.polygon[(i + 1) % light.polygon.size()] - a;
          EXPECT_GE(along.x * (q.y - a.y) - along.y * (q.x - a.x), -1e-6) << count;
        }
      }
    }
  }
}

/// A plate over a floor, a panel of 2 x 1 above it.
Scene panel_scene() {
  Scene scene = white_floor(true);
  add_light(scene, {.name = "panel", .type = LightType::area_rect, .intensity = 4, .size_m = {2, 1}},
            {0, 3, 0}, facing_down);
  return scene;
}

render::FrameResult with_points(int count) {
  render::RenderSettings settings{.width = 121, .height = 91, .shadows = render::ShadowMode::soft};
  settings.soft_points = count;
  return draw(panel_scene(), settings);
}

double rms(const io::ImageF& a, const io::ImageF& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::pow(double(a.pixels[i]) - double(b.pixels[i]), 2);
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

TEST(LightPoints, GoToTheExactShadowAsTheyGrow) {
  const render::FrameResult exact = with_points(0);
  const double few = rms(with_points(8).masks[0].visible_fraction, exact.masks[0].visible_fraction),
               many = rms(with_points(512).masks[0].visible_fraction, exact.masks[0].visible_fraction);
  EXPECT_GT(few, 0.005) << "eight steps are no penumbra";
  EXPECT_LT(many, few / 16) << "less than independent samples would gain by a factor of two";
  int farthest = 0;
  const render::FrameResult near = with_points(512);
  for (std::size_t i = 0; i < exact.image.pixels.size(); ++i)
    farthest = std::max(farthest, std::abs(near.image.pixels[i] - exact.image.pixels[i]));
  EXPECT_LE(farthest, 4) << "irradiance as well as fractions";
}

// A wall stands behind the panel: its upper half lies behind the light's plane and gets nothing of it.
TEST(LightPoints, ShowAllOrNothingWhereTheLightShowsAllOrNothing) {
  Scene scene = panel_scene();
  Mesh wall{.name = "wall"};
  add_quad(wall, {-6, 0, -3}, {12, 0, 0}, {0, 8, 0});
  add_mesh(scene, std::move(wall));
  render::RenderSettings settings{.width = 121, .height = 91, .shadows = render::ShadowMode::soft};
  const render::FrameResult exact = draw(scene, settings);
  settings.soft_points = 8;
  const render::FrameResult points = draw(scene, settings);
  std::size_t all = 0, nothing = 0;
  for (std::size_t i = 0; i < exact.masks[0].visible_fraction.pixels.size(); ++i) {
    const float fraction = exact.masks[0].visible_fraction.pixels[i];
    if (fraction != 0 && fraction != 1) continue;
    ++(fraction == 0 ? nothing : all);
    ASSERT_EQ(points.masks[0].visible_fraction.pixels[i], fraction) << i;
  }
  EXPECT_GT(all, 1000u);
  EXPECT_GT(nothing, 1000u);
}

TEST(LightPoints, GiveSoManySteps) {
  const render::FrameResult result = with_points(8);
  for (const float fraction : result.masks[0].visible_fraction.pixels)
    ASSERT_EQ(fraction * 8, std::round(fraction * 8));
  EXPECT_GT(result.stats.rays, 0u);
  EXPECT_TRUE(result.masks[0].classes.empty());
  EXPECT_EQ(result.soft.groups, 0u) << "no exact solver beside";
}

TEST(LightPoints, AreTheSameBitsWhateverDoesTheWork) {
  render::RenderSettings settings{.width = 121, .height = 91, .shadows = render::ShadowMode::soft};
  settings.soft_points = 5;
  const io::Image8 expected = draw(panel_scene(), settings).image;
  for (const int threads : {1, 3}) {
    settings.threads = threads;
    for (const Variant variant : {Variant::tiles, Variant::precise_seatp}) {
      settings.hard.variant = variant;
      EXPECT_EQ(draw(panel_scene(), settings).image, expected) << threads;
    }
  }
}

TEST(LightPoints, StopWhenAsked) {
  const Scene scene = panel_scene();
  render::Renderer renderer = renderer_for(scene);
  render::RenderSettings settings{.width = 32, .height = 24, .shadows = render::ShadowMode::soft};
  settings.soft_points = 1000;
  StopFlag stop;
  stop.request();
  render::FrameResult result;
  const auto drawn = renderer.render_frame(frame_of(scene, 32, 24), settings, result, {}, &stop);
  ASSERT_FALSE(drawn);
  EXPECT_TRUE(is_stop(drawn));
}

}  // namespace
}  // namespace tenebra
