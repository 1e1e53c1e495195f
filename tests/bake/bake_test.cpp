// Lightmaps: no light in closed rooms, samples inside their triangles, known light, borders, places in the
// map.
#include <gtest/gtest.h>

#include <gmpxx.h>
#include <cmath>
#include <numbers>

#include "bake/box_room.h"
#include "bake/map_layout.h"
#include "support/samples.h"

namespace tenebra {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec3;
using testing::add_light;
using testing::bake_map;
using testing::box_room;
using testing::MapRequest;

MapRequest request_of(render::ShadowMode shadows, AoMode ao = AoMode::none) {
  MapRequest request;
  request.light.settings.shadows = shadows;
  request.light.settings.ao.mode = ao;
  return request;
}

TEST(Lightmap, AClosedRoomLitFromOutsideIsDark) {
  for (const vec3 at : {vec3(0), vec3(-1000.25f, 37.7f, 512.1f)}) {
    for (const LightType type : {LightType::point, LightType::area_rect, LightType::directional}) {
      for (const float gap : {0.0f, 0.031f}) {
        Scene scene = box_room(at, at + vec3(4.1f, 2.7f, 6.3f), gap);
        add_light(scene, type, at + vec3(1.3f, 5, 2));    // above
        add_light(scene, type, at + vec3(-3, 0, 0));      // in the floor's plane
        add_light(scene, type, at + vec3(-2, -1, 6.3f));  // below, in a wall's plane
        for (const auto shadows : {render::ShadowMode::hard, render::ShadowMode::soft}) {
          const bake::BakedMap map = bake_map(scene, request_of(shadows));
          EXPECT_GT(map.filled_texels(), 3000u);
          EXPECT_EQ(map.lit_texels(), 0u) << static_cast<int>(type) << " " << gap;
        }
      }
    }
  }
}

TEST(Lightmap, SamplesOnEdgesWouldBeLitFromOutside) {
  Scene scene = box_room(vec3(0), vec3(4.1f, 2.7f, 6.3f));
  add_light(scene, LightType::point, vec3(1.3f, 5, 2));
  add_light(scene, LightType::point, vec3(-3, 1, 2));
  render::FrameInput input;
  evaluate_frame(scene, -1, 0, input.geometry);
  input.lights = evaluate_lights(scene, -1, 0);
  std::vector<bake::Sample> samples;
  for (std::uint32_t t = 0; t < input.geometry.triangles.size(); ++t)
    for (const dvec3 weights : {dvec3(1, 0, 0), dvec3(0.3, 0.7, 0), dvec3(0, 0.6, 0.4), dvec3(0.5, 0, 0.5)})
      samples.push_back({t, t, 1.0f, weights});
  std::vector<std::string> notes;
  auto light = bake::SurfaceLight::create(scene, input, {}, notes).value();
  const auto lit = [&] {
    std::vector<bake::Light> values(samples.size());
    EXPECT_TRUE(light.at(samples, values, nullptr, {}).has_value());
    return std::count_if(values.begin(), values.end(), [](const bake::Light& l) { return l.r > 0; });
  };
  EXPECT_GT(lit(), 0) << "a point on a wall's plane is not blocked by it";
  bake::move_inside(input.geometry, bake::edge_margin(bake::extent_of(input.geometry)), samples);
  EXPECT_EQ(lit(), 0);
}

TEST(Lightmap, ALampInTheRoomLightsAllOfIt) {
  Scene scene = box_room(vec3(0), vec3(4, 3, 4));
  add_light(scene, LightType::point, vec3(2, 1.5f, 2));
  const bake::BakedMap map = bake_map(scene, request_of(render::ShadowMode::hard));
  EXPECT_EQ(map.lit_texels(), map.filled_texels());
  // The floor's middle: 100 cd at 1.5 m, of which a white surface shows 1 / pi.
  const double expected = 100 / (1.5 * 1.5) / std::numbers::pi;
  double brightest = 0;
  for (const bake::Light& texel : map.texels) brightest = std::max(brightest, static_cast<double>(texel.r));
  EXPECT_NEAR(brightest, expected, 0.02 * expected);
}

TEST(Lightmap, ThreadsAndInstructionSetsGiveTheSameBits) {
  std::vector<bake::Light> first;
  for (const int threads : {1, 2}) {
    for (const SimdLevel simd : {SimdLevel::scalar, SimdLevel::automatic}) {
      Scene scene = box_room(vec3(0), vec3(4, 3, 4));
      add_light(scene, LightType::area_rect, vec3(2, 2.9f, 2));
      MapRequest request = request_of(render::ShadowMode::soft, AoMode::adaptive);
      request.size = 32;
      render::RenderSettings& settings = request.light.settings;
      settings.threads = threads;
      settings.hard.simd = settings.soft.simd = settings.ao.simd = simd;
      const bake::BakedMap map = bake_map(scene, request);
      if (first.empty()) first = map.texels;
      EXPECT_EQ(map.texels, first) << threads;
    }
  }
}

using Exact = mpq_class;
struct ExactVector {
  Exact x, y, z;
};
ExactVector exact(const dvec3& v) {
  return {v.x, v.y, v.z};
}
ExactVector minus(const ExactVector& a, const ExactVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Exact dot(const ExactVector& a, const ExactVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Whether `p` is on the inner side of the three planes that stand upright on the triangle's edges.
bool strictly_inside(const bake::Triangle& t, const dvec3& p) {
  const ExactVector corners[3] = {exact(t[0]), exact(t[1]), exact(t[2])};
  const ExactVector normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
  for (int i = 0; i < 3; ++i) {
    const ExactVector edge = minus(corners[(i + 1) % 3], corners[i]);
    if (dot(cross(normal, edge), minus(exact(p), corners[i])) <= 0) return false;
  }
  return true;
}

TEST(Sample, LiesStrictlyInsideItsTriangle) {
  testing::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const double offset = i % 3 == 0 ? 1000.0 : 0.0, thin = i % 2 == 0 ? 1.0 : 1e-3;
    bake::Triangle t;
    double extent = 0;
    for (dvec3& c : t) {
      c = dvec3(
          vec3(offset + (2 * random.unit() - 1), thin * (2 * random.unit() - 1), (2 * random.unit() - 1)));
      extent = std::max({extent, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    }
    const double on_edge = random.unit();
    for (const dvec3 weights :
         {dvec3(1, 0, 0), dvec3(on_edge, 1 - on_edge, 0), dvec3(0, on_edge, 1 - on_edge),
          dvec3(0.25, 0.25, 0.5), dvec3(0.5, 0.5 + 1e-9, -1e-9)}) {
      const auto inside = bake::weights_inside(t, weights, bake::edge_margin(extent));
      if (!inside) continue;
      const dvec3 p = inside->x * t[0] + inside->y * t[1] + inside->z * t[2];
      EXPECT_TRUE(strictly_inside(t, p)) << i;
    }
  }
  const bake::Triangle flat{dvec3(0), dvec3(1, 0, 0), dvec3(2, 0, 0)};
  EXPECT_FALSE(bake::weights_inside(flat, dvec3(1, 0, 0), 1e-6).has_value());
}

TEST(TexelCoverage, CountsPlacesSliversAndOverlaps) {
  // A square of 4 x 4 texels in two triangles, and a strip thinner than the places are apart.
  std::vector<bake::MapTriangle> triangles{{{dvec2(2, 2), dvec2(6, 2), dvec2(6, 6)}, 0, 0},
                                           {{dvec2(2, 2), dvec2(6, 6), dvec2(2, 6)}, 1, 0},
                                           {{dvec2(8.01, 8), dvec2(8.02, 8), dvec2(8.01, 11)}, 2, 0}};
  const bake::TexelCoverage coverage(triangles, 16, 2);
  EXPECT_EQ(coverage.covered_places(), 64u);
  EXPECT_EQ(coverage.overlaps_within() + coverage.overlaps_between(), 0u) << "neighbours share an edge";
  std::vector<bake::Sample> samples;
  coverage.samples_of_band(0, samples);
  ASSERT_EQ(samples.size(), 64u + 3u);
  std::size_t slivers = 0;
  for (const bake::Sample& s : samples) {
    EXPECT_GT(std::min({s.weights.x, s.weights.y, s.weights.z}), 0) << "inside its own triangle";
    EXPECT_NEAR(s.weights.x + s.weights.y + s.weights.z, 1, 1e-12);
    slivers += s.triangle == 2;
  }
  EXPECT_EQ(slivers, 3u);
  triangles.push_back({{dvec2(2, 2), dvec2(6, 2), dvec2(6, 6)}, 3, 1});
  EXPECT_EQ(bake::TexelCoverage(triangles, 16, 2).overlaps_between(), 36u) << "8 x 9 / 2 places";
}

TEST(BakedMap, DilatesRingByRing) {
  bake::BakedMap map(8);
  const auto at = [](std::size_t x, std::size_t y) { return y * 8 + x; };
  map.texels[at(2, 2)] = bake::Light(1.0f), map.filled[at(2, 2)] = 1;
  map.texels[at(3, 2)] = bake::Light(3.0f), map.filled[at(3, 2)] = 1;
  bake::dilate(map, 2);
  EXPECT_EQ(map.texels[at(1, 1)].r, 1.0f);
  EXPECT_EQ(map.texels[at(2, 1)].r, 2.0f) << "the mean of both";
  EXPECT_EQ(map.texels[at(2, 2)].r, 1.0f) << "what was baked stays";
  EXPECT_EQ(map.filled_texels(), 30u) << "6 x 5 of 8 x 8";
  EXPECT_EQ(map.filled[at(6, 2)], 0);
}

TEST(MapLayout, SquaresDoNotOverlap) {
  const std::vector<double> areas{3, 100, 0, 7, 0.5, 100, 20};
  const auto squares = bake::lay_out(areas, 1000);
  ASSERT_TRUE(squares.has_value());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const auto& a = (*squares)[i];
    EXPECT_EQ(a.side > 0, areas[i] > 0);
    EXPECT_LE(a.origin.x + a.side, 1000) << i;
    EXPECT_LE(a.origin.y + a.side, 1000) << i;
    for (std::size_t k = 0; k < i; ++k) {
      const auto& b = (*squares)[k];
      const dvec2 apart = glm::max(a.origin - (b.origin + b.side), b.origin - (a.origin + a.side));
      EXPECT_TRUE(a.side == 0 || b.side == 0 || std::max(apart.x, apart.y) >= 3) << i << " " << k;
    }
  }
  EXPECT_GT((*squares)[1].side, (*squares)[4].side);
  EXPECT_FALSE(bake::lay_out(std::vector<double>(5000, 1.0), 64).has_value());
}

TEST(MapLayout, ASmallMeshBesideALargeOneGetsItsEightTexels) {
  const auto squares = bake::lay_out(std::vector<double>{1e4, 0.25}, 1024);
  ASSERT_TRUE(squares.has_value());
  EXPECT_EQ((*squares)[1].side + 3, 8);
}

/// The frame turns the triangles of mirrored nodes round, and the samples' weights with them.
TEST(BakedScene, MirroredNodesKeepTheirPlaces) {
  Scene scene = box_room(vec3(0), vec3(4, 3, 4));
  FrameGeometry plain, mirrored;
  evaluate_frame(scene, -1, 0, plain);
  const auto before = bake::place_in_map(scene, plain, 256);
  scene.nodes[0].scale = {-1, 1, 1};
  evaluate_frame(scene, -1, 0, mirrored);
  const auto after = bake::place_in_map(scene, mirrored, 256);
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->triangles.size(), after->triangles.size());
  for (std::size_t i = 0; i < before->triangles.size(); ++i) {
    const std::uint32_t t = before->triangles[i].triangle;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        if (plain.triangles[t][k] == mirrored.triangles[t][l]) {
          EXPECT_EQ(before->triangles[i].corners[std::size_t(k)], after->triangles[i].corners[std::size_t(l)])
              << i;
        }
  }
}

TEST(BakedScene, InstancesAreApartAndGetPlacesOfTheirOwn) {
  Scene scene = box_room(vec3(0), vec3(4, 3, 4));
  scene.nodes.resize(2);
  scene.nodes[1].mesh = 0;
  scene.nodes[1].translation = {10, 0, 0};
  bake::separate_meshes(scene);
  ASSERT_EQ(scene.meshes.size(), 2u);
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  const auto places = bake::place_in_map(scene, frame, 256);
  ASSERT_TRUE(places.has_value());
  EXPECT_TRUE(places->own_squares);
  EXPECT_EQ(bake::TexelCoverage(places->triangles, 256, 2).overlaps_between(), 0u);
  EXPECT_NE(scene.meshes[0].texture_coordinates[1], scene.meshes[1].texture_coordinates[1]);
  for (Mesh& mesh : scene.meshes) mesh.texture_coordinates[1].clear();
  const auto none = bake::place_in_map(scene, frame, 256);
  ASSERT_FALSE(none.has_value());
  EXPECT_NE(none.error().message.find("TEXCOORD_1"), std::string::npos);
}

TEST(BakedScene, ColoursOfVerticesEndAtFlatEdges) {
  Scene scene = box_room(vec3(0), vec3(4, 3, 4));
  bake::separate_flat_corners(scene);
  ASSERT_EQ(scene.meshes[0].positions.size(), 36u);
  EXPECT_EQ(scene.meshes[0].texture_coordinates[1].size(), 36u);
  FrameGeometry frame;
  evaluate_frame(scene, -1, 0, frame);
  EXPECT_EQ(bake::vertex_samples(frame).size(), 36u);
  const auto clipped =
      bake::colour_vertices(scene, std::vector<bake::Light>(36, bake::Light(2, 0.5f, 0, 1)), 1, false);
  EXPECT_EQ(clipped.vertices, 36u);
  EXPECT_EQ(clipped.brightest, 2);
  EXPECT_EQ(scene.meshes[0].colors[7], glm::vec4(1, 0.5f, 0, 1));
  EXPECT_EQ(scene.materials[0].model, SurfaceModel::unlit);
}

TEST(BakedScene, ANormalOfZeroSeparatesItsCornersAlone) {
  Scene scene = box_room(vec3(0), vec3(4, 3, 4));
  Mesh& mesh = scene.meshes[0];
  const std::size_t vertices = mesh.positions.size();
  mesh.normals.assign(vertices, vec3(0, 1, 0));
  const std::uint32_t flat = mesh.triangles[3].y;
  mesh.normals[flat] = vec3(0);
  std::vector<vec3> before;
  std::size_t corners = 0;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) before.push_back(mesh.positions[t[k]]), corners += t[k] == flat;
  bake::separate_flat_corners(scene);
  EXPECT_EQ(mesh.positions.size(), vertices - 1 + corners);
  EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  std::vector<vec3> after;
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) after.push_back(mesh.positions[t[k]]);
  EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace tenebra
