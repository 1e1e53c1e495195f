// Ids at several places of each pixel against those of views that are shifted there, each drawn by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "formats/import_scene.h"
#include "reference/exact_sight.h"
#include "support/hand_made.h"
#include "tenebra/threads.h"
#include "visibility/visibility.h"

namespace tenebra {
namespace {

using glm::vec2;
using glm::vec3;

const std::vector<vec2> places{{19 / 64.0f, 19 / 64.0f},   {-26 / 64.0f, 7 / 64.0f}, {7 / 64.0f, -26 / 64.0f},
                               {-29 / 64.0f, -4 / 64.0f},  {26 / 64.0f, 23 / 64.0f}, {0.0f, 0.0f},
                               {-22 / 64.0f, -26 / 64.0f}, {8 / 64.0f, 27 / 64.0f}};

float in_steps(float value, float step) {
  return step * std::round(value / step);
}
vec3 in_steps(vec3 v, float step) {
  return {in_steps(v.x, step), in_steps(v.y, step), in_steps(v.z, step)};
}

/// A view much like `view` whose shift by 1/64 pixels is exact in float; of rays about as long as 1.
ViewRays shiftable(ViewRays view) {
  view.d0 = in_steps(view.d0, 0x1p-21f);
  view.dx = in_steps(view.dx, 0x1p-15f);
  view.dy = in_steps(view.dy, 0x1p-15f);
  return view;
}

ViewRays shifted(ViewRays view, vec2 place) {
  vec3& moved = view.orthographic ? view.eye : view.d0;
  const glm::dvec3 exact =
      glm::dvec3(moved) + double{place.x} * glm::dvec3(view.dx) + double{place.y} * glm::dvec3(view.dy);
  moved = vec3(exact);
  EXPECT_EQ(glm::dvec3(moved), exact) << "the test's own view";
  return view;
}

visibility::PlaceIds seen_at_places(const FrameGeometry& g, const ViewRays& view, int width, int height,
                                    SimdLevel simd = SimdLevel::automatic) {
  visibility::VisibilityPass pass;
  visibility::PlaceIds out;
  const auto drawn = pass.draw_places(g, view, width, height, places, simd, out);
  EXPECT_TRUE(drawn) << drawn.error().message;
  EXPECT_TRUE(drawn && *drawn);
  return out;
}

/// Where a ray through the centre of a pixel meets triangles.
class Ray {
public:
  Ray(const FrameGeometry& g, const ViewRays& view, int x, int y) : g_(g), sight_(view), x_(x), y_(y) {}
  /// The parameter along it; 0: beside the triangle.
  double meets(std::uint32_t id) const {
    if (id >= g_.triangles.size()) return 0;
    const glm::uvec3 t = g_.triangles[id];
    const vec3 corners[3] = {g_.positions[t.x], g_.positions[t.y], g_.positions[t.z]};
    const auto met = sight_.meeting(corners, x_, y_);
    return met ? met->get_d() : 0;
  }

private:
  const FrameGeometry& g_;
  test::ExactSight sight_;
  int x_, y_;
};

struct Agreement {
  int samples = 0, ties = 0, alone = 0;  ///< alone: of pixels that are known to see one triangle
};

/// Every sample sees what the view shifted there sees, or another triangle that is as near but for roundings.
Agreement expect_shifted_views(const FrameGeometry& g, const ViewRays& view, int width, int height) {
  const visibility::PlaceIds seen = seen_at_places(g, view, width, height);
  Agreement agreement;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ViewRays there = shifted(view, places[k]);
    visibility::VisibilityPass pass;
    visibility::VisibleIds drawn;
    EXPECT_TRUE(pass.draw(g, there, width, height, false, SimdLevel::automatic, drawn));
    EXPECT_EQ(seen.has_layer(), drawn.has_layer);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto pixel = static_cast<std::size_t>(y * width + x);
        const visibility::PixelPlaces sees = seen.of_pixel(x, y);
        ++agreement.samples;
        agreement.alone += sees.ids == nullptr ? 1 : 0;
        const auto compare = [&](std::uint32_t found, std::uint32_t expected) {
          if (found == expected) return;
          ++agreement.ties;
          const Ray ray(g, there, x, y);
          const double a = ray.meets(found), b = ray.meets(expected);
          EXPECT_GT(a, 0) << found << " in place of " << expected << " at " << x << ", " << y;
          EXPECT_NEAR(a, b, 0x1p-18 * b) << found << ", " << expected << " at " << x << ", " << y;
        };
        compare(sees.id(k), drawn.ids[pixel]);
        if (drawn.has_layer) compare(sees.layer(k), drawn.layer[pixel]);
      }
    }
  }
  return agreement;
}

TEST(Places, SoupsAreSeenAsFromShiftedViews) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const FrameGeometry few = random_soup(40, {1, 2, -6}, 3.0f, seed);
    const Agreement agreement = expect_shifted_views(few, forward_view({1, 2, 3}, 64.0f, 71, 47), 71, 47);
    EXPECT_EQ(agreement.ties, 0);
    EXPECT_GT(agreement.alone, agreement.samples / 10);
    const FrameGeometry many = random_soup(3000, {0, 0, -6}, 3.0f, seed);
    EXPECT_LE(expect_shifted_views(many, forward_view({0, 0, 0}, 128.0f, 203, 157), 203, 157).ties, 2);
  }
}

TEST(Places, TrianglesAroundTheEyeAndOrthographicViews) {
  for (const unsigned seed : {11u, 12u}) {
    const FrameGeometry g = random_soup(160, {0, 0, 0}, 2.0f, seed);
    EXPECT_LE(expect_shifted_views(g, forward_view({0, 0, 0}, 32.0f, 49, 33, 0.25f), 49, 33).ties, 2);
  }
  const FrameGeometry g = random_soup(40, {1, 2, -8}, 3.0f, 21);
  EXPECT_LE(expect_shifted_views(g, orthographic_view({1, 2, 3}, 0.125f, 61, 43), 61, 43).ties, 2);
}

TEST(Places, MeshesWithoutCracksAndThinThings) {
  FrameGeometry g;
  for (int i = 0; i < 40; ++i) {  // wires thinner than pixels before a wall of two triangles
    const float x = -1.5f + 0.08f * static_cast<float>(i), w = 0.0007f * static_cast<float>(1 + i % 7);
    add_triangle(g, {x, -1, -2}, {x + w, -1, -2}, {x + 0.3f, 1, -2});
  }
  add_triangle(g, {-9, -9, -3}, {9, -9, -3}, {-9, 9, -3});
  add_triangle(g, {9, 9, -3}, {-9, 9, -3}, {9, -9, -3});
  const Agreement agreement = expect_shifted_views(g, forward_view({0, 0, 0}, 128.0f, 251, 187), 251, 187);
  EXPECT_EQ(agreement.ties, 0);
  EXPECT_GT(agreement.alone, agreement.samples / 4);
  EXPECT_LT(agreement.alone, agreement.samples);
}

TEST(Places, LayersToo) {
  EXPECT_LE(expect_shifted_views(mixed_soup(1500), forward_view({0, 0, 0}, 64.0f, 93, 70), 93, 70).ties, 2);
}

TEST(Places, BundledScenesAtAnOddSize) {
  for (const char* name : {"city.glb", "court.glb", "gallery.glb", "square.glb"}) {
    const auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / name);
    ASSERT_TRUE(scene) << scene.error().message;
    FrameGeometry g;
    evaluate_frame(*scene, scene->clips.empty() ? -1 : 0, 2.5, g);
    const ViewRays view = shiftable(evaluate_camera(*scene, scene->clips.empty() ? -1 : 0, 2.5, 0, 333, 257));
    const Agreement agreement = expect_shifted_views(g, view, 333, 257);
    EXPECT_LT(agreement.ties, agreement.samples / 1000) << name;
    EXPECT_GT(agreement.alone, agreement.samples / 10) << name;
  }
}

TEST(Places, TheSameBitsFromAllVectorLevelsAndThreads) {
  const FrameGeometry g = mixed_soup(1500);
  const ViewRays view = forward_view({0, 0, 0}, 200.0f, 333, 257);
  const visibility::PlaceIds expected = seen_at_places(g, view, 333, 257);
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    for (const int threads : {1, 5}) {
      visibility::PlaceIds found;
      with_threads(threads, [&] { found = seen_at_places(g, view, 333, 257, level); });
      int differing = 0;
      for (int y = 0; y < 257; ++y)
        for (int x = 0; x < 333; ++x)
          for (std::size_t k = 0; k < places.size(); ++k) {
            const visibility::PixelPlaces a = found.of_pixel(x, y), b = expected.of_pixel(x, y);
            differing += a.id(k) != b.id(k) || a.layer(k) != b.layer(k) ? 1 : 0;
          }
      EXPECT_EQ(differing, 0) << simd_level_name(level) << ' ' << threads;
    }
  }
}

TEST(Places, TooManyAreLeftToOtherWays) {
  visibility::VisibilityPass pass;
  visibility::PlaceIds out;
  const std::vector<vec2> seventeen(17, vec2(0.25f));
  const FrameGeometry g = random_soup(4, {0, 0, -6}, 3.0f, 5);
  const auto drawn =
      pass.draw_places(g, forward_view({0, 0, 0}, 8.0f, 9, 9), 9, 9, seventeen, SimdLevel::automatic, out);
  ASSERT_TRUE(drawn);
  EXPECT_FALSE(*drawn);
}

}  // namespace
}  // namespace tenebra
