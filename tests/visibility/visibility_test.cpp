// Ids on the CPU against rays in rational numbers, against OpenGL's ids, and against themselves.
#include "visibility/visibility.h"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <random>

#include "formats/import_scene.h"
#include "reference/exact_sight.h"
#include "support/hand_made.h"
#include "tenebra/threads.h"

namespace tenebra {
namespace {

using glm::vec3;

visibility::VisibleIds seen_in(const FrameGeometry& g, const ViewRays& view, int width, int height,
                               SimdLevel simd = SimdLevel::automatic) {
  visibility::VisibilityPass pass;
  visibility::VisibleIds out;
  const auto drawn = pass.draw(g, view, width, height, true, simd, out);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return out;
}

/// What an exact ray caster has to say of every pixel.
class Judge {
public:
  Judge(const FrameGeometry& g, const ViewRays& view) : g_(g), view_(view), sight_(view) {}

  /// Triangles that cover the pixel's centre beyond the near plane, and the depth of each.
  struct Hit {
    std::uint32_t id;
    double depth;
    double slack;  ///< what float depths of this triangle may be off by: sixteen roundings of its terms
  };
  std::vector<Hit> hits(const visibility::VisibleIds& drawn, int x, int y) const {
    std::vector<Hit> found;
    for (std::uint32_t id = 0; id < g_.triangles.size(); ++id) {
      const glm::uvec3 t = g_.triangles[id];
      const vec3 corners[3] = {g_.positions[t.x], g_.positions[t.y], g_.positions[t.z]};
      const auto met = sight_.meeting(corners, x, y);
      if (!met) continue;
      const double depth = depth_of(drawn.transform, met->get_d());
      found.push_back({id, depth, 0x1p-20 * (depth + 66 * slope(drawn.transform, corners))});
    }
    return found;
  }

private:
  double depth_of(const visibility::ClipTransform& c, double t) const {
    const double near_t = c.near_t, far_t = c.far_t;
    return view_.orthographic ? (far_t - t) / (far_t - near_t) : near_t / t;
  }
  /// Change of depth a pixel across and down, together.
  double slope(const visibility::ClipTransform& c, const vec3 corners[3]) const {
    const glm::dvec3 a(corners[0]), n = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
    const glm::dvec3 dx(view_.dx), dy(view_.dy), d0(view_.d0);
    const double steps = std::abs(glm::dot(n, dx)) + std::abs(glm::dot(n, dy));
    if (view_.orthographic) return steps / std::abs(glm::dot(n, d0)) / (double{c.far_t} - double{c.near_t});
    return double{c.near_t} * steps / std::abs(glm::dot(n, a - glm::dvec3(view_.eye)));
  }

  const FrameGeometry& g_;
  const ViewRays& view_;
  test::ExactSight sight_;
};

struct Verdict {
  int covered = 0, ties = 0;
};

/// Every pixel: the triangle seen covers it, none that covers it is nearer by more than depths are off, and
/// where none is seen none covers it.
Verdict expect_exact(const FrameGeometry& g, const ViewRays& view, int width, int height) {
  const visibility::VisibleIds drawn = seen_in(g, view, width, height);
  const Judge judge(g, view);
  Verdict verdict;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::size_t>(y * width + x);
      const std::uint32_t id = drawn.ids[pixel];
      const auto hits = judge.hits(drawn, x, y);
      const auto own = std::find_if(hits.begin(), hits.end(), [&](const auto& hit) { return hit.id == id; });
      if (id != background_id) {
        EXPECT_NE(own, hits.end()) << "triangle " << id << " does not cover " << x << ", " << y;
        if (own == hits.end()) return verdict;
        ++verdict.covered;
        EXPECT_LE(std::abs(own->depth - double{drawn.depth[pixel]}), own->slack) << x << ", " << y;
        EXPECT_LE(own->depth, 1 + own->slack) << "before the near plane";
      }
      for (const auto& hit : hits) {
        if (hit.id == id || hit.depth > 1 - hit.slack) continue;
        const double best = id == background_id ? 0 : own->depth + own->slack;
        EXPECT_LE(hit.depth - hit.slack, best)
            << "triangle " << hit.id << " is before " << id << " at " << x << ", " << y;
        verdict.ties += hit.depth + hit.slack >= best;
      }
    }
  }
  return verdict;
}

TEST(Visibility, SoupsAreSeenAsExactRaysSeeThem) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const FrameGeometry g = random_soup(40, {1, 2, -6}, 3.0f, seed);
    EXPECT_GT(expect_exact(g, forward_view({1, 2, 3}, 60.0f, 71, 47), 71, 47).covered, 71 * 47 / 3);
  }
}

TEST(Visibility, TrianglesAroundAndBehindTheEyeAreCutRight) {
  for (const unsigned seed : {11u, 12u, 13u}) {
    const FrameGeometry g = random_soup(160, {0, 0, 0}, 2.0f, seed);
    EXPECT_GT(expect_exact(g, forward_view({0, 0, 0}, 25.0f, 49, 33, 0.25f), 49, 33).covered, 49 * 33 / 2);
  }
}

TEST(Visibility, OrthographicOffAxisAndFarFromTheOrigin) {
  const FrameGeometry g = random_soup(40, {1, 2, -8}, 3.0f, 21);
  EXPECT_GT(expect_exact(g, orthographic_view({1, 2, 3}, 0.13f, 61, 43), 61, 43).covered, 300);
  ViewRays skewed = forward_view({0, 0, 2}, 50.0f, 61, 43);
  skewed.d0 = 1.7f * (skewed.d0 + vec3(0.2f, 0.1f, 0.0f));
  skewed.dx += vec3(0.0f, 0.002f, 0.001f);
  EXPECT_GT(expect_exact(g, skewed, 61, 43).covered, 300);
  const vec3 far(1e5f, -2e5f, 3e5f);
  EXPECT_GT(
      expect_exact(random_soup(40, far + vec3(0, 0, -8), 3.0f, 22), forward_view(far, 45.0f, 60, 45), 60, 45)
          .covered,
      300);
}

TEST(Visibility, TinyAndHugeScales) {
  for (const float scale : {1e-12f, 1e12f}) {
    const FrameGeometry g = random_soup(30, scale * vec3(0, 0, -6), 3.0f * scale, 31);
    ViewRays view = forward_view({0, 0, 0}, 40.0f, 41, 33, 0.1f * scale);
    EXPECT_GT(expect_exact(g, view, 41, 33).covered, 200) << scale;
  }
}

// Slivers and needles, as thin as floats allow.
TEST(Visibility, SliversCoverWhatTheyCover) {
  FrameGeometry g;
  for (int i = 0; i < 24; ++i) {
    const auto turn = static_cast<float>(i) * 0.26f;
    const vec3 along(std::cos(turn), std::sin(turn), 0.3f), thin(0, std::ldexp(1.0f, -2 - i), 0);
    add_triangle(g, vec3(0, 0, -4) - 3.0f * along, vec3(0, 0, -4) + 3.0f * along,
                 vec3(0, 0, -4) + 3.0f * along + thin);
  }
  EXPECT_GT(expect_exact(g, forward_view({0, 0, 0}, 48.0f, 64, 64), 64, 64).covered, 100);
}

/// A wavy sheet of `cells` x `cells` quads, each of two triangles, from -1 to 1 in x and y, at z = -2.
FrameGeometry sheet(int cells, float wave) {
  FrameGeometry g;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const float x = 2.0f * static_cast<float>(i) / static_cast<float>(cells) - 1,
                  y = 2.0f * static_cast<float>(j) / static_cast<float>(cells) - 1;
      g.positions.emplace_back(x, y, -2.0f + wave * std::sin(9 * x) * std::cos(7 * y));
    }
  }
  const auto row = static_cast<std::uint32_t>(cells + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i;
      g.triangles.emplace_back(a, a + 1, a + row);
      g.triangles.emplace_back(a + 1, a + row + 1, a + row);
    }
  }
  g.materials.resize(g.triangles.size());
  g.casts_shadow.assign(g.triangles.size(), 1);
  g.normals.resize(g.positions.size());
  return g;
}

TEST(Visibility, MeshesHaveNoCracks) {
  for (const int cells : {1, 7, 60, 300}) {
    const FrameGeometry g = sheet(cells, 0.1f);
    const visibility::VisibleIds drawn = seen_in(g, forward_view({0, 0, 0}, 290.0f, 250, 250), 250, 250);
    for (const std::uint32_t id : drawn.ids) ASSERT_NE(id, background_id) << cells;
  }
}

// All vertices and edges go through centres of pixels, so that every sign there is exactly zero.
TEST(Visibility, EdgesAndVerticesOnPixelCentresHaveNoCracksEither) {
  FrameGeometry g = sheet(16, 0.0f);
  for (vec3& p : g.positions) p = vec3(16.0f * p.x, 16.0f * p.y, -2.0f);
  ViewRays view{
      .eye = {-12.5f, 12.5f, 0}, .d0 = {0, 0, -1}, .dx = {1, 0, 0}, .dy = {0, -1, 0}, .orthographic = true};
  const visibility::VisibleIds drawn = seen_in(g, view, 25, 25);
  for (const std::uint32_t id : drawn.ids) ASSERT_NE(id, background_id);
  // Six triangles meet at a vertex, all of one depth: the smallest id is seen.
  const test::ExactSight sight(view);
  for (int y = 0; y < 25; ++y) {
    for (int x = 0; x < 25; ++x) {
      std::uint32_t first = background_id;
      for (std::uint32_t id = 0; id < g.triangles.size() && first == background_id; ++id) {
        const glm::uvec3 t = g.triangles[id];
        const vec3 corners[3] = {g.positions[t.x], g.positions[t.y], g.positions[t.z]};
        if (sight.meeting(corners, x, y)) first = id;
      }
      ASSERT_EQ(drawn.ids[static_cast<std::size_t>(25 * y + x)], first) << x << ", " << y;
    }
  }
}

// A fan of needles between centres of pixels, or a millionth of a pixel beside them: floats cannot say on
// which side of an edge the centres along it are.
TEST(Visibility, EdgesNextToPixelCentresAreDecidedExactly) {
  constexpr int size = 66;
  ViewRays view = forward_view({0, 0, 0}, 66.0f, size, size);
  std::mt19937 random(5);
  const auto centre = [&](int x, int y) {
    const auto shift = [&] { return static_cast<float>(static_cast<int>(random() % 9) - 4) * 0x1p-20f; };
    return 3.0f * (view.d0 + (static_cast<float>(x) + 0.5f + shift()) * view.dx +
                   (static_cast<float>(y) + 0.5f + shift()) * view.dy);
  };
  FrameGeometry g;
  g.positions.push_back(centre(1, 1));
  for (int i = 0; i <= 63; ++i) g.positions.push_back(centre(65, 1 + i));
  for (int i = 63; i-- > 0;) g.positions.push_back(centre(1 + i, 65));
  for (std::uint32_t i = 1; i + 1 < g.positions.size(); ++i) g.triangles.emplace_back(0, i, i + 1);
  g.casts_shadow.assign(g.triangles.size(), 1);
  EXPECT_GT(expect_exact(g, view, size, size).covered, 63 * 63 - 200);
  const visibility::VisibleIds drawn = seen_in(g, view, size, size);
  for (int y = 2; y < 64; ++y)
    for (int x = 2; x < 64; ++x) ASSERT_NE(drawn.ids[static_cast<std::size_t>(size * y + x)], background_id);
}

TEST(Visibility, AFloorAroundTheEyeFillsTheLowerHalf) {
  FrameGeometry g = sheet(40, 0.0f);
  for (vec3& p : g.positions) p = vec3(1e4f * p.x, -1.0f, 1e4f * p.y);
  const visibility::VisibleIds drawn = seen_in(g, forward_view({0.3f, 0, 0.7f}, 100.0f, 200, 200), 200, 200);
  for (std::size_t i = 0; i < drawn.ids.size(); ++i) {
    const std::size_t x = i % 200, y = i / 200;
    if (y < 99) {
      ASSERT_EQ(drawn.ids[i], background_id) << x << ", " << y;
    } else if (y > 101) {
      ASSERT_NE(drawn.ids[i], background_id) << x << ", " << y;
    }
  }
}

TEST(Visibility, OfEqualDepthsTheSmallerIdIsSeen) {
  FrameGeometry g;
  for (int copy = 0; copy < 3; ++copy) add_triangle(g, {-9, -9, -5}, {9, -9, -5}, {0, 30, -5});
  for (const std::uint32_t id : seen_in(g, forward_view({0, 0, 0}, 5.0f, 8, 8), 8, 8).ids) EXPECT_EQ(id, 0u);
}

TEST(Visibility, DroppedAndDegenerateTrianglesHideNothing) {
  FrameGeometry g;
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  add_triangle(g, {nan, inf, -1}, {-inf, 0, nan}, {nan, nan, nan});
  g.triangles[0] = {0, 0, 0};
  add_triangle(g, {-1, 0, -2}, {0, 0, -2}, {1, 0, -2});
  add_triangle(g, {0, 0, -2}, {0, 0, -2}, {0, 0, -2});
  add_triangle(g, {0, -1, -1}, {0, 1, -1}, {0, 0, -3});  // seen edge-on
  add_triangle(g, {-9, -9, -5}, {9, -9, -5}, {0, 30, -5});
  for (const ViewRays& view : {forward_view({0, 0, 0}, 9.0f, 9, 9), orthographic_view({0, 0, 0}, 0.1f, 9, 9)})
    for (const std::uint32_t id : seen_in(g, view, 9, 9).ids) EXPECT_EQ(id, 4u);
}

TEST(Visibility, EmptySceneIsAllBackground) {
  const visibility::VisibleIds drawn = seen_in({}, forward_view({0, 0, 0}, 9.0f, 7, 5), 7, 5);
  EXPECT_EQ(drawn.ids, std::vector<std::uint32_t>(35, background_id));
  EXPECT_EQ(drawn.depth, std::vector<float>(35, 0.0f));
}

TEST(Visibility, SizesAndRaysThatCannotBeDrawnAreRefused) {
  visibility::VisibilityPass pass;
  visibility::VisibleIds out;
  const ViewRays good = forward_view({0, 0, 0}, 9.0f, 8, 8);
  const std::pair<int, int> sizes[] = {{0, 5}, {5, 0}, {-1, 5}, {1 << 20, 1}, {1, 1 << 20}, {16000, 16000}};
  for (const auto& [width, height] : sizes) {
    const auto drawn = pass.draw({}, good, width, height, false, SimdLevel::automatic, out);
    ASSERT_FALSE(drawn);
    EXPECT_NE(drawn.error().message.find(fmt::format("{}x{}", width, height)), std::string::npos);
  }
  ViewRays flat = good;
  flat.dx = {};
  EXPECT_FALSE(pass.draw({}, flat, 8, 8, false, SimdLevel::automatic, out));
}

TEST(Visibility, TheSameBitsFromAllVectorLevelsAndThreads) {
  const FrameGeometry g = mixed_soup(3000);
  const ViewRays view = forward_view({0, 0, 0}, 200.0f, 333, 257);
  const visibility::VisibleIds expected = seen_in(g, view, 333, 257);
  EXPECT_EQ(expected.layer.size(), expected.ids.size());
  for (const SimdLevel level : {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512}) {
    if (!simd_level_supported(level)) continue;
    for (const int threads : {1, 2, 5}) {
      visibility::VisibleIds drawn;
      with_threads(threads, [&] { drawn = seen_in(g, view, 333, 257, level); });
      EXPECT_EQ(drawn.ids, expected.ids) << simd_level_name(level) << ' ' << threads;
      EXPECT_EQ(drawn.depth, expected.depth) << simd_level_name(level) << ' ' << threads;
      EXPECT_EQ(drawn.layer, expected.layer) << simd_level_name(level) << ' ' << threads;
    }
  }
}

TEST(Visibility, TheLayerIsTheNearestSeeThroughTriangleBeforeOpaqueOnes) {
  const FrameGeometry g = mixed_soup(3000);
  const ViewRays view = forward_view({0, 0, 0}, 60.0f, 90, 70);
  const visibility::VisibleIds both = seen_in(g, view, 90, 70);
  FrameGeometry opaque = g, through = g;
  for (std::size_t i = 0; i < g.triangles.size(); ++i)
    (g.see_through[i] != 0 ? opaque : through).triangles[i] = glm::uvec3(0);
  opaque.see_through.clear();
  through.see_through.clear();
  const visibility::VisibleIds behind = seen_in(opaque, view, 90, 70),
                               before = seen_in(through, view, 90, 70);
  EXPECT_EQ(both.ids, behind.ids);
  EXPECT_EQ(both.depth, behind.depth);
  for (std::size_t i = 0; i < both.ids.size(); ++i)
    ASSERT_EQ(both.layer[i], before.depth[i] > behind.depth[i] ? before.ids[i] : background_id);
}

// More triangles in more tiles than are held at once: they are drawn in rounds.
TEST(Visibility, ManyLargeTrianglesAreDrawnInRounds) {
  FrameGeometry g;
  const int count = 22000;
  for (int i = 0; i < count; ++i) {
    const float z = -1.0f - 1e-3f * static_cast<float>(i * 7919 % count), wide = -40 * z;
    add_triangle(g, {-wide, -wide, z}, {wide, -wide, z}, {0, 2 * wide, z});
  }
  // Nearest of all, and equally near: the smaller id comes in a later round than the larger.
  const vec3 corners[3] = {{-40, -20, -0.5f}, {40, -20, -0.5f}, {0, 60, -0.5f}};
  for (const std::size_t id : {1040, 20960})
    for (std::size_t k = 0; k < 3; ++k) g.positions[3 * id + k] = corners[k];
  const visibility::VisibleIds drawn = seen_in(g, forward_view({0, 0, 0}, 300.0f, 640, 640), 640, 640);
  for (const std::uint32_t id : drawn.ids) ASSERT_EQ(id, 1040u);
}

TEST(Visibility, BundledScenesAreSeenAsExactRaysSeeThem) {
  for (const char* name : {"city.glb", "court.glb", "gallery.glb", "square.glb"}) {
    const auto scene = formats::import_scene(std::filesystem::path(TENEBRA_SCENES_DIR) / name);
    ASSERT_TRUE(scene) << scene.error().message;
    FrameGeometry g;
    evaluate_frame(*scene, scene->clips.empty() ? -1 : 0, 2.5, g);
    g.see_through.clear();  // one rule for all
    const ViewRays view = evaluate_camera(*scene, scene->clips.empty() ? -1 : 0, 2.5, 0, 1024, 1024);
    const visibility::VisibleIds drawn = seen_in(g, view, 1024, 1024);
    const Judge judge(g, view);
    // All triangles for a few pixels, chosen by a fixed stride.
    for (int i = 7; i < 1024 * 1024; i += 104729) {
      const int x = i % 1024, y = i / 1024;
      const std::uint32_t id = drawn.ids[static_cast<std::size_t>(i)];
      double nearest = 0, own = 0;
      for (const auto& hit : judge.hits(drawn, x, y)) {
        if (hit.depth <= 1) nearest = std::max(nearest, hit.depth - hit.slack);
        if (hit.id == id) own = hit.depth + hit.slack;
      }
      EXPECT_GE(own, nearest) << name << ' ' << x << ", " << y;
      EXPECT_EQ(own == 0, id == background_id) << name << ' ' << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace tenebra
