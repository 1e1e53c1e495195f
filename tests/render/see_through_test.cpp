// See-through surfaces in whole frames: masks, coloured masks, and the picture.
#include "render/render_fixture.h"

#include "render/mask_colour.h"

namespace tenebra {
namespace {

using render::FrameResult;
using render::RenderSettings;

constexpr int glass_width = 96, glass_height = 72;
const glm::vec3 passed{0.75f, 0.5f, 0.25f};

/// The floor with a pane in the plate's place, lit from 5 m above its middle.
Scene floor_with_pane(const Material& pane, bool with_pane = true) {
  Scene scene = white_floor(false);
  scene.materials.push_back(pane);
  Mesh mesh{.name = "pane"};
  add_quad(mesh, {-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, 1);
  if (with_pane) add_mesh(scene, std::move(mesh));
  Light light;
  light.falloff = Falloff::none;
  light.intensity = 0.8f;
  add_light(scene, light, {0, 5, 0});
  return scene;
}

Material tinted() {
  Material m;
  m.base_color = passed;
  m.transmission = 1;
  m.tinted_transmission = true;
  return m;
}

FrameResult draw_small(const Scene& scene, SeeThrough see_through = SeeThrough::tint,
                       render::ShadowMode shadows = render::ShadowMode::hard) {
  RenderSettings settings;
  settings.width = glass_width;
  settings.height = glass_height;
  settings.shadows = shadows;
  settings.see_through = see_through;
  return draw(scene, settings);
}

/// Of each pixel: whether its ray meets the pane, and whether its place of the floor lies behind it; neither
/// where that is a close call.
struct Places {
  std::vector<bool> before_pane, clear_of_pane, behind_pane;
  Places() {
    const ViewRays view = frame_of(white_floor(false), glass_width, glass_height).view;
    for (int y = 0; y < glass_height; ++y)
      for (int x = 0; x < glass_width; ++x) {
        const auto met = on_plane(view, x, y, 1), floor = on_plane(view, x, y);
        const double from_pane = met ? std::max(std::abs(met->x), std::abs(met->z)) : 9;
        const double from_shadow = floor ? 0.8 * std::max(std::abs(floor->x), std::abs(floor->z)) : 9;
        before_pane.push_back(from_pane < 0.99);
        clear_of_pane.push_back(from_pane > 1.01);
        behind_pane.push_back(from_shadow < 0.99);
      }
  }
};

TEST(SeeThroughFrames, TheMaskIsOfOpaqueCastersAndTheTintOfPanes) {
  const FrameResult without = draw_small(floor_with_pane(tinted(), false));
  const FrameResult with = draw_small(floor_with_pane(tinted()));
  ASSERT_EQ(with.masks.size(), 1u);
  EXPECT_EQ(with.masks[0].mask, without.masks[0].mask);
  EXPECT_TRUE(without.masks[0].tint.pixels.empty());
  const io::ImageF colour = render::mask_colour(with.masks[0]);
  const io::Image8 colour8 = render::mask_colour8(with.masks[0]);
  const Places places;
  std::size_t behind = 0;
  for (std::size_t i = 0; i < places.behind_pane.size(); ++i) {
    if (!places.behind_pane[i]) continue;
    ++behind;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(colour.pixels[3 * i + c], passed[static_cast<int>(c)]) << i;
      ASSERT_EQ(colour8.pixels[3 * i + c], std::lround(255 * passed[static_cast<int>(c)])) << i;
    }
  }
  EXPECT_GT(behind, 100u);
}

TEST(SeeThroughFrames, CastAndIgnoreAreBlackAndNothing) {
  Material opaque;
  const FrameResult black = draw_small(floor_with_pane(opaque));
  const FrameResult cast = draw_small(floor_with_pane(tinted()), SeeThrough::cast);
  const FrameResult without = draw_small(floor_with_pane(tinted(), false));
  const FrameResult ignored = draw_small(floor_with_pane(tinted()), SeeThrough::ignore);
  EXPECT_TRUE(cast.masks[0].tint.pixels.empty());
  EXPECT_TRUE(ignored.masks[0].tint.pixels.empty());
  EXPECT_EQ(ignored.masks[0].mask, without.masks[0].mask);
  const Places places;
  std::size_t dark = 0;
  for (std::size_t i = 0; i < places.clear_of_pane.size(); ++i) {
    if (!places.clear_of_pane[i]) continue;
    ASSERT_EQ(cast.masks[0].mask.pixels[i], black.masks[0].mask.pixels[i]) << i;
    dark += cast.masks[0].mask.pixels[i] == 0;
  }
  EXPECT_GT(dark, 20u);
}

TEST(SeeThroughFrames, TheNearestPaneIsDrawnOverWhatIsBehind) {
  Material veil;
  veil.alpha_mode = AlphaMode::blend;
  veil.alpha = 0.25f;
  veil.base_color = {1, 0, 0};
  Scene scene = floor_with_pane(veil), bare = floor_with_pane(veil, false);
  for (Scene* s : {&scene, &bare}) {
    s->ambient_light = glm::vec3(0.5f);
    s->lights[0].intensity = 0;
  }
  const FrameResult with = draw_small(scene), without = draw_small(bare);
  const Places places;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < places.before_pane.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (places.clear_of_pane[i]) {
        ASSERT_EQ(with.image.pixels[3 * i + c], without.image.pixels[3 * i + c]) << i;
      } else if (places.before_pane[i]) {
        const double expected = srgb_level(0.75 * 0.5 + 0.25 * (c == 0 ? 0.5 : 0.0));
        ASSERT_NEAR(with.image.pixels[3 * i + c], expected, 1) << i;
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 300u);
}

TEST(SeeThroughFrames, EveryPaneBeforeAPlaceDimsIt) {
  Scene scene = floor_with_pane(tinted());
  Mesh second{.name = "second"};
  add_quad(second, {-1, 0.5f, 1}, {2, 0, 0}, {0, 0, -2}, 1);
  add_mesh(scene, std::move(second));
  scene.ambient_light = glm::vec3(0.5f);
  scene.lights[0].intensity = 0;
  const FrameResult result = draw_small(scene);
  const ViewRays view = frame_of(scene, glass_width, glass_height).view;
  std::size_t twice = 0;
  for (int y = 0; y < glass_height; ++y)
    for (int x = 0; x < glass_width; ++x) {
      const auto one = on_plane(view, x, y, 1), two = on_plane(view, x, y, 0.5);
      if (!one || !two ||
          std::max({std::abs(one->x), std::abs(one->z), std::abs(two->x), std::abs(two->z)}) > 0.99)
        continue;
      ++twice;
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(result.image.pixels[static_cast<std::size_t>(3 * (y * glass_width + x) + c)],
                    srgb_level(0.5 * passed[c] * passed[c]), 1);
    }
  EXPECT_GT(twice, 100u);
}

TEST(SeeThroughFrames, LightThroughAPaneColoursTheFloor) {
  const FrameResult with = draw_small(floor_with_pane(tinted()));
  const FrameResult without = draw_small(floor_with_pane(tinted(), false));
  const ViewRays view = frame_of(white_floor(false), glass_width, glass_height).view;
  const Places places;
  std::size_t coloured = 0;
  for (int y = 0; y < glass_height; ++y)
    for (int x = 0; x < glass_width; ++x) {
      const auto i = static_cast<std::size_t>(y * glass_width + x);
      if (!places.clear_of_pane[i]) continue;
      const auto floor = on_plane(view, x, y);
      if (places.behind_pane[i]) {
        const glm::dvec3 way = glm::dvec3(0, 5, 0) - *floor;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(with.image.pixels[3 * i + static_cast<std::size_t>(c)],
                      srgb_level(0.8 * way.y / glm::length(way) * passed[c]), 1);
        ++coloured;
      } else if (0.8 * std::max(std::abs(floor->x), std::abs(floor->z)) > 1.01) {
        ASSERT_EQ(with.image.pixels[3 * i], without.image.pixels[3 * i]);
      }
    }
  EXPECT_GT(coloured, 20u);
}

TEST(SeeThroughFrames, AnAllowedErrorOfSoftShadowsIsOneOfTintsToo) {
  Scene scene = white_floor(false);
  scene.materials.push_back(tinted());
  Mesh mesh{.name = "pane of many quads"};
  const float side = 2 / 24.0f;  // of a quad: more than 24 triangles are before a point
  for (int x = 0; x < 24; ++x)
    for (int z = 0; z < 24; ++z)
      add_quad(mesh, {-1 + side * static_cast<float>(x), 1, 1 - side * static_cast<float>(z)}, {side, 0, 0},
               {0, 0, -side}, 1);
  add_mesh(scene, std::move(mesh));
  add_light(scene, {.name = "panel", .type = LightType::area_rect, .intensity = 2, .size_m = {2, 2}},
            {0, 5, 0}, facing_down);
  RenderSettings settings;
  settings.width = glass_width, settings.height = glass_height;
  settings.shadows = render::ShadowMode::soft;
  const FrameResult exact = draw(scene, settings);
  settings.soft.error_255 = 12;
  const FrameResult rough = draw(scene, settings);
  ASSERT_EQ(exact.masks.size(), 1u);
  const io::ImageF a = render::mask_colour(exact.masks[0]), b = render::mask_colour(rough.masks[0]);
  ASSERT_GT(exact.masks[0].tint.pixels.size(), 300u);
  float most = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    most = std::max(most, std::abs(a.pixels[i] - b.pixels[i]));
  EXPECT_GT(most, 1 / 255.0f) << "fewer places of the light";
  EXPECT_LT(most, 0.1f);
}

}  // namespace
}  // namespace tenebra
