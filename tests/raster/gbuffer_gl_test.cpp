// Ids and depths of the G-buffer against rays cast in double through the pixels' centres.
#include <fmt/core.h>

#include "raster/gbuffer.h"

#include <algorithm>

#include "raster/raster_fixture.h"

namespace tenebra {
namespace {

/// What the ray through a pixel's centre meets, by a test that shares nothing with the rasteriser.
struct Seen {
  std::uint32_t id = background_id;
  double t = std::numeric_limits<double>::infinity();
  bool is_close = false;  ///< to an edge, to the near plane or to another triangle: a rasteriser may differ
};

Seen cast(const FrameGeometry& g, const ViewRays& view, int x, int y) {
  constexpr double edge_slack = 2e-3, depth_slack = 1e-5;
  const glm::dvec3 across = (x + 0.5) * glm::dvec3(view.dx) + (y + 0.5) * glm::dvec3(view.dy);
  const glm::dvec3 origin = glm::dvec3(view.eye) + (view.orthographic ? across : glm::dvec3(0.0));
  const glm::dvec3 ray = glm::dvec3(view.d0) + (view.orthographic ? glm::dvec3(0.0) : across);
  const glm::dvec3 axis = glm::normalize(glm::cross(glm::dvec3(view.dx), glm::dvec3(view.dy)));
  const double near_t = view.near_m / std::abs(glm::dot(axis, glm::dvec3(view.d0)));
  Seen seen;
  for (std::size_t i = 0; i < g.triangles.size(); ++i) {
    const glm::dvec3 a(g.positions[g.triangles[i].x]), b(g.positions[g.triangles[i].y]),
        c(g.positions[g.triangles[i].z]);
    const glm::dvec3 p = glm::cross(ray, c - a);
    const double det = glm::dot(b - a, p);
    if (det == 0) continue;
    const double u = glm::dot(origin - a, p) / det;
    const glm::dvec3 q = glm::cross(origin - a, b - a);
    const double v = glm::dot(ray, q) / det, t = glm::dot(c - a, q) / det, w = 1 - u - v;
    const double inside = std::min({u, v, w});
    if (inside < -edge_slack || t < near_t * (1 - depth_slack)) continue;
    const bool is_close = inside < edge_slack || t < near_t * (1 + depth_slack);
    if (is_close || std::abs(t - seen.t) < depth_slack * t) seen.is_close = true;
    if (!is_close && t < seen.t) seen.t = t, seen.id = static_cast<std::uint32_t>(i);
  }
  return seen;
}

class GBufferTest : public RasterTest {
protected:
  /// Compares every pixel that is not close; `checked` counts them.
  void expect_ids_and_depths(const FrameGeometry& g, const ViewRays& view, int width, int height,
                             int& checked) {
    draw(g, view, width, height);
    ASSERT_EQ(ids.size(), static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    checked = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Seen seen = cast(g, view, x, y);
        if (seen.is_close) continue;
        ++checked;
        const auto pixel = static_cast<std::size_t>(y * width + x);
        ASSERT_EQ(ids[pixel], seen.id) << "at " << x << ", " << y;
        if (seen.id == background_id) {
          ASSERT_EQ(depth[pixel], 0.0f);
          continue;
        }
        const glm::dvec3 p =
            visibility::point_from_depth(view, passes().gbuffer.transform, x, y, depth[pixel]);
        const glm::dvec3 across = (x + 0.5) * glm::dvec3(view.dx) + (y + 0.5) * glm::dvec3(view.dy);
        const glm::dvec3 truth =
            glm::dvec3(view.eye) + across * (view.orthographic ? 1.0 : seen.t) + seen.t * glm::dvec3(view.d0);
        const double distance = glm::length(truth - glm::dvec3(view.eye));
        worst_depth_error = std::max(worst_depth_error, glm::length(p - truth) / distance);
      }
    }
  }
  double worst_depth_error = 0;
};

TEST_P(GBufferTest, IdsAndDepthsAreThoseOfTheRays) {
  int checked = 0;
  const FrameGeometry g = random_soup(60, {1, 2, -8}, 3.0f, 7);
  expect_ids_and_depths(g, forward_view({1, 2, 3}, 120.0f, 151, 97), 151, 97, checked);
  EXPECT_GT(checked, 151 * 97 * 3 / 4);
  EXPECT_LT(worst_depth_error, 2e-5);
}

TEST_P(GBufferTest, OrthographicIdsAndDepthsAreThoseOfTheRays) {
  int checked = 0;
  const FrameGeometry g = random_soup(60, {1, 2, -8}, 3.0f, 11);
  expect_ids_and_depths(g, orthographic_view({1, 2, 3}, 0.08f, 101, 133), 101, 133, checked);
  EXPECT_GT(checked, 101 * 133 * 3 / 4);
  EXPECT_LT(worst_depth_error, 2e-5);
}

TEST_P(GBufferTest, CameraInsideGeometryAndNearPlaneCutsTriangles) {
  int checked = 0;
  const FrameGeometry g = random_soup(80, {0, 0, 0}, 3.0f, 5);  // all around the eye
  expect_ids_and_depths(g, forward_view({0, 0, 0}, 40.0f, 96, 64, 1.5f), 96, 64, checked);
  EXPECT_GT(checked, 96 * 64 / 2);
}

TEST_P(GBufferTest, ObliqueAndShearedViewsFollowTheirRays) {
  int checked = 0;
  const FrameGeometry g = random_soup(60, {0, 0, -9}, 3.0f, 3);
  ViewRays view = forward_view({0, 0, 0}, 100.0f, 120, 80);
  view.d0 = 1.7f * (view.d0 + glm::vec3(0.2f, 0.1f, 0.0f));  // off-axis, and d0 of any length
  view.dx += glm::vec3(0.0f, 0.002f, 0.001f);
  expect_ids_and_depths(g, view, 120, 80, checked);
  EXPECT_GT(checked, 120 * 80 / 2);
}

TEST_P(GBufferTest, SceneMovedFarFromTheOriginKeepsItsIds) {
  int checked = 0;
  const glm::vec3 far(1e5f, -2e5f, 3e5f);
  const FrameGeometry g = random_soup(60, far + glm::vec3(0, 0, -8), 3.0f, 9);
  expect_ids_and_depths(g, forward_view(far, 90.0f, 120, 90), 120, 90, checked);
  EXPECT_GT(checked, 120 * 90 / 2);
}

TEST_P(GBufferTest, OddSizesAndSinglePixels) {
  const FrameGeometry g = random_soup(40, {0, 0, -8}, 3.0f, 13);
  const std::pair<int, int> sizes[] = {{1, 1}, {1, 17}, {23, 1}, {63, 65}, {65, 63}, {3, 129}};
  for (const auto& [width, height] : sizes) {
    int checked = 0;
    expect_ids_and_depths(g, forward_view({0, 0, 0}, 40.0f, width, height), width, height, checked);
    EXPECT_LT(worst_depth_error, 2e-5);
  }
}

TEST_P(GBufferTest, RowZeroIsTheTop) {
  FrameGeometry g;
  add_triangle(g, {-9, 1, -5}, {9, 1, -5}, {0, 30, -5});     // above the eye
  add_triangle(g, {-9, -1, -5}, {9, -1, -5}, {0, -30, -5});  // below
  draw(g, forward_view({0, 0, 0}, 5.0f, 9, 9), 9, 9);
  EXPECT_EQ(ids[0 * 9 + 4], 0u);
  EXPECT_EQ(ids[8 * 9 + 4], 1u);
  EXPECT_EQ(ids[4 * 9 + 4], background_id);
}

TEST_P(GBufferTest, OfEqualDepthsTheSmallerIdIsSeen) {
  FrameGeometry g;
  for (int copy = 0; copy < 3; ++copy) add_triangle(g, {-9, -9, -5}, {9, -9, -5}, {0, 30, -5});
  draw(g, forward_view({0, 0, 0}, 5.0f, 8, 8), 8, 8);
  EXPECT_EQ(ids[4 * 8 + 4], 0u);
}

TEST_P(GBufferTest, DroppedAndDegenerateTrianglesHideNothing) {
  FrameGeometry g;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  add_triangle(g, {nan, inf, -1}, {-inf, 0, nan}, {nan, nan, nan});
  g.triangles[0] = {0, 0, 0};                            // as evaluate_frame drops it
  add_triangle(g, {-1, 0, -2}, {0, 0, -2}, {1, 0, -2});  // collinear
  add_triangle(g, {0, 0, -2}, {0, 0, -2}, {0, 0, -2});   // a point
  add_triangle(g, {-9, -9, -5}, {9, -9, -5}, {0, 30, -5});
  for (const ViewRays& view :
       {forward_view({0, 0, 0}, 9.0f, 9, 9), orthographic_view({0, 0, 0}, 0.1f, 9, 9)}) {
    draw(g, view, 9, 9);
    for (std::uint32_t id : ids) EXPECT_EQ(id, 3u);
  }
}

TEST_P(GBufferTest, EmptySceneIsAllBackground) {
  draw({}, forward_view({0, 0, 0}, 9.0f, 7, 5), 7, 5);
  for (std::uint32_t id : ids) EXPECT_EQ(id, background_id);
  EXPECT_EQ(ids.size(), 35u);
}

TEST_P(GBufferTest, TargetsAndBuffersFollowGrowingAndShrinkingFrames) {
  const FrameGeometry small = random_soup(10, {0, 0, -8}, 3.0f, 1),
                      large = random_soup(90, {0, 0, -8}, 3.0f, 2);
  int checked = 0;
  expect_ids_and_depths(large, forward_view({0, 0, 0}, 30.0f, 40, 30), 40, 30, checked);
  expect_ids_and_depths(small, forward_view({0, 0, 0}, 30.0f, 20, 50), 20, 50, checked);
  expect_ids_and_depths(large, forward_view({0, 0, 0}, 30.0f, 20, 50), 20, 50, checked);
}

TEST_P(GBufferTest, WhatMovesIsSentAndWhatDoesNotStays) {
  FrameGeometry frame = random_soup(5000, {0, 0, -8}, 3.0f, 3);
  const ViewRays view = forward_view({0, 0, 0}, 60.0f, 80, 60);
  const auto as_drawn_anew = [&] {
    raster::GeometryBuffers fresh;
    EXPECT_TRUE(fresh.upload(frame));
    EXPECT_TRUE(passes().gbuffer_pass.draw(view, fresh, 80, 60, passes().gbuffer));
    std::vector<std::uint32_t> expected;
    raster::read_triangle_ids(passes().gbuffer, expected);
    return expected;
  };
  for (const std::size_t moved : {std::size_t{0}, std::size_t{4095}, std::size_t{9000}, std::size_t{14999}}) {
    for (std::size_t i = moved; i < std::min<std::size_t>(moved + 3000, frame.positions.size()); ++i)
      frame.positions[i] += glm::vec3(0.5f, -0.25f, 0.125f);
    std::swap(frame.triangles[moved / 3], frame.triangles[moved / 7]);
    draw(frame, view, 80, 60);
    const auto seen = ids;
    EXPECT_EQ(seen, as_drawn_anew()) << moved;
  }
  frame.see_through.assign(frame.triangles.size(), 0);
  for (std::size_t i = 0; i < frame.see_through.size(); i += 3) frame.see_through[i] = 1;
  draw(frame, view, 80, 60);
  const auto seen = ids;
  EXPECT_EQ(seen, as_drawn_anew());
}

TEST_P(GBufferTest, SizesThatCannotBeDrawnAreRefused) {
  const std::pair<int, int> sizes[] = {{0, 5}, {5, 0}, {-1, 5}, {1 << 20, 1}, {1, 1 << 20}, {16000, 16000}};
  for (const auto& [width, height] : sizes) {
    const auto drawn = passes().gbuffer_pass.draw(forward_view({0, 0, 0}, 9.0f, 1, 1), passes().geometry,
                                                  width, height, passes().gbuffer);
    ASSERT_FALSE(drawn) << width << "x" << height;
    EXPECT_NE(drawn.error().message.find(fmt::format("{}x{}", width, height)), std::string::npos);
  }
}

TEST_P(GBufferTest, LargestWidthIsDrawn) {
  FrameGeometry g;
  add_triangle(g, {-9e4f, -9e4f, -5}, {9e4f, -9e4f, -5}, {0, 9e5f, -5});
  draw(g, forward_view({0, 0, 0}, 100.0f, 16384, 2), 16384, 2);
  EXPECT_EQ(ids.front(), 0u);
  EXPECT_EQ(ids.back(), 0u);
}

TEST_P(GBufferTest, RaysThatSpanNoPictureAreRefused) {
  const ViewRays good = forward_view({0, 0, 0}, 9.0f, 8, 8);
  ViewRays flat = good, parallel = good, not_a_number = good, no_near = good;
  flat.dx = {};
  parallel.dy = parallel.dx;
  not_a_number.eye.y = std::numeric_limits<float>::quiet_NaN();
  no_near.near_m = 0;
  for (const ViewRays& view : {flat, parallel, not_a_number, no_near}) {
    EXPECT_FALSE(passes().gbuffer_pass.draw(view, passes().geometry, 8, 8, passes().gbuffer));
  }
}

struct DrawnIds {
  std::vector<std::uint32_t> ids;
  std::vector<float> depth;
};

DrawnIds draw_soup(gl::ContextKind kind) {
  DrawnIds drawn;
  auto context = gl::Context::create(kind);
  EXPECT_TRUE(context);
  auto pass = raster::GBufferPass::create();
  raster::GeometryBuffers geometry;
  raster::GBuffer gbuffer;
  EXPECT_TRUE(geometry.upload(random_soup(25, {0, 0, -9}, 3.0f, 99)));
  EXPECT_TRUE(pass->draw(forward_view({0, 0, 0}, 200.0f, 257, 191), geometry, 257, 191, gbuffer));
  raster::read_triangle_ids(gbuffer, drawn.ids);
  raster::read_depth(gbuffer, drawn.depth);
  return drawn;
}

TEST(Raster, SameBitsFromEglAndOsmesa) {
  TENEBRA_NEEDS_CONTEXT(gl::ContextKind::osmesa);
  const DrawnIds egl = draw_soup(gl::ContextKind::egl), osmesa = draw_soup(gl::ContextKind::osmesa);
  EXPECT_EQ(egl.ids, osmesa.ids);
  EXPECT_EQ(egl.depth, osmesa.depth);
  EXPECT_GT(std::count(egl.ids.begin(), egl.ids.end(), background_id), 100);
}

TENEBRA_BOTH_CONTEXTS(GBufferTest);

}  // namespace
}  // namespace tenebra
