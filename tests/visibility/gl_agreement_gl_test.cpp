// Ids of the CPU and of OpenGL differ only where a pixel's centre lies within 1/128 pixel of an edge (OpenGL
// may move vertices to the nearest of 256 places a pixel, and rounds before) or where depths tie.
#include <gtest/gtest.h>

#include <filesystem>

#include "formats/import_scene.h"
#include "gl/context.h"
#include "raster/gbuffer.h"
#include "support/hand_made.h"
#include "visibility/visibility.h"

namespace tenebra {
namespace {

using glm::dvec3;

constexpr double widest_px = 1.0 / 128, depth_tie = 1e-4;

/// Of one triangle at one pixel.
struct Place {
  double inside_px = 0;  ///< distance to the nearest edge's line, negative outside
  double t = 0;          ///< where its plane is met
};

Place place_of(const FrameGeometry& g, const ViewRays& view, std::uint32_t id, int x, int y) {
  const glm::uvec3 triangle = g.triangles[id];
  const dvec3 across = (x + 0.5) * dvec3(view.dx) + (y + 0.5) * dvec3(view.dy);
  const dvec3 from = dvec3(view.eye) + (view.orthographic ? across : dvec3(0.0)),
              along = dvec3(view.d0) + (view.orthographic ? dvec3(0.0) : across);
  dvec3 q[3];
  for (int k = 0; k < 3; ++k) q[k] = dvec3(g.positions[triangle[k]]) - from;
  const dvec3 n = glm::cross(q[1] - q[0], q[2] - q[0]);
  const double side = view.orthographic ? glm::dot(along, n) : glm::dot(q[0], n);
  Place place{.inside_px = 1e30, .t = glm::dot(n, q[0]) / glm::dot(n, along)};
  for (int k = 0; k < 3; ++k) {
    const dvec3 a = q[(k + 1) % 3], b = q[(k + 2) % 3];
    const dvec3 slope = view.orthographic ? glm::cross(along, b - a) : glm::cross(a, b);
    const double value = glm::dot(along, glm::cross(a, b)) * (side < 0 ? -1 : 1);
    const double steepness = std::hypot(glm::dot(slope, dvec3(view.dx)), glm::dot(slope, dvec3(view.dy)));
    place.inside_px = std::min(place.inside_px, value / steepness);
  }
  return place;
}

/// Why the two may differ at a pixel: one of the two triangles has an edge there, or both are as far away.
bool may_differ(const FrameGeometry& g, const ViewRays& view, std::uint32_t a, std::uint32_t b, int x,
                int y) {
  Place places[2];
  int seen = 0;
  for (const std::uint32_t id : {a, b}) {
    if (id == background_id) continue;
    const Place place = place_of(g, view, id, x, y);
    if (std::abs(place.inside_px) < widest_px) return true;
    places[seen++] = place;
  }
  return seen == 2 && std::abs(places[0].t - places[1].t) < depth_tie * std::abs(places[0].t);
}

class GlAgreement : public ::testing::Test {
protected:
  void SetUp() override {
    auto context = gl::Context::create(gl::ContextKind::automatic);
    // What is compared is OpenGL's answer: without a driver there is none.
    if (!context) GTEST_SKIP() << "no OpenGL to compare with: " << context.error().message;
    context_.emplace(std::move(*context));
  }

  /// Draws both; returns the share of pixels that differ, after judging each.
  double differing(const FrameGeometry& g, const ViewRays& view, int width, int height) {
    auto gl_pass = raster::GBufferPass::create();
    raster::GeometryBuffers geometry;
    raster::GBuffer gbuffer;
    EXPECT_TRUE(geometry.upload(g));
    EXPECT_TRUE(gl_pass->draw(view, geometry, width, height, gbuffer));
    std::vector<std::uint32_t> ids;
    raster::read_triangle_ids(gbuffer, ids);
    visibility::VisibilityPass pass;
    visibility::VisibleIds drawn;
    EXPECT_TRUE(pass.draw(g, view, width, height, false, SimdLevel::automatic, drawn));
    int count = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        if (ids[pixel] == drawn.ids[pixel]) continue;
        ++count;
        EXPECT_TRUE(may_differ(g, view, ids[pixel], drawn.ids[pixel], x, y))
            << x << ", " << y << ": " << ids[pixel] << " by OpenGL, " << drawn.ids[pixel] << " on the CPU";
      }
    }
    return static_cast<double>(count) / width / height;
  }

private:
  std::optional<gl::Context> context_;
};

TEST_F(GlAgreement, Soups) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const FrameGeometry g = random_soup(60, {1, 2, -8}, 3.0f, seed);
    EXPECT_LT(differing(g, forward_view({1, 2, 3}, 240.0f, 303, 197), 303, 197), 2e-3);
    EXPECT_LT(differing(g, orthographic_view({1, 2, 3}, 0.03f, 303, 197), 303, 197), 2e-3);
  }
}

TEST_F(GlAgreement, BundledScenes) {
  for (const char* name : {"city.glb", "court.glb", "gallery.glb", "square.glb"}) {
    const auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / name);
    ASSERT_TRUE(scene) << scene.error().message;
    FrameGeometry g;
    const int clip = scene->clips.empty() ? -1 : 0;
    evaluate_frame(*scene, clip, 5.0, g);
    EXPECT_LT(differing(g, evaluate_camera(*scene, clip, 5.0, 0, 640, 480), 640, 480), 2e-3) << name;
  }
}

}  // namespace
}  // namespace tenebra
