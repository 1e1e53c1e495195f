// Lights of the scene as polygons, and emissive meshes as lights.
#include "render/area_lights.h"

#include "render/emissive.h"
#include "render/render_fixture.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

const math::Box<double> box{dvec3(-1, 0, -1), dvec3(3, 4, 1)};

void expect_near(const dvec3& found, const dvec3& expected, double slack = 1e-6) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], slack) << i;
}

AreaLight made(const Light& light, const WorldLight& placed, const render::AreaLightSettings& settings) {
  const auto area = render::area_light_of(light, placed, settings, box);
  EXPECT_TRUE(area && *area) << (area ? "no polygon" : area.error().message);
  return area && *area ? **area : AreaLight{};
}

TEST(AreaLights, PointLightsFaceTheCentreOfTheSceneOrWhatIsAskedFor) {
  const WorldLight placed{.position = {1, 9, 0}};
  render::AreaLightSettings settings{.size = {2, 0.5f}};
  const AreaLight light = made({}, placed, settings);
  expect_near(light.normal, {0, -1, 0});
  expect_near(light.centre, {1, 9, 0});
  EXPECT_NEAR(light.area_m2, 1.0, 1e-6);
  settings.facing = vec3(-8, 9, 0);
  expect_near(made({}, placed, settings).normal, {-1, 0, 0});
  settings.facing = placed.position;  // no direction: down
  expect_near(made({}, placed, settings).normal, {0, -1, 0});
}

TEST(AreaLights, WidthIsLevelAndHeightIsNot) {
  render::AreaLightSettings settings{.size = {2, 0.5f}};
  settings.facing = vec3(0, 0, 9);
  const AreaLight light = made({}, {.position = {0, 0, 0}}, settings);
  double wide = 0, high = 0;
  for (const vec3& v : light.vertices) {
    wide = std::max(wide, std::abs(double(v.x)));
    high = std::max(high, std::abs(double(v.y)));
  }
  EXPECT_NEAR(wide, 1.0, 1e-6);
  EXPECT_NEAR(high, 0.25, 1e-6);
}

TEST(AreaLights, SpotsFaceWhereTheyShine) {
  Light spot;
  spot.type = LightType::spot;
  const WorldLight placed{.position = {1, 9, 0}, .direction = {0.6f, -0.8f, 0}};
  render::AreaLightSettings settings{.size = {1, 1}};
  expect_near(made(spot, placed, settings).normal, {0.6, -0.8, 0});
  settings.facing = vec3(1, 0, 0);
  expect_near(made(spot, placed, settings).normal, {0, -1, 0});
}

TEST(AreaLights, PercentCountsTheDiagonal) {
  const render::AreaLightSettings settings{.size = {50, 50}, .percent_of_diagonal = true};
  EXPECT_NEAR(made({}, {.position = {1, 9, 0}}, settings).area_m2, 0.25 * 36, 1e-5);  // diagonal: 6
}

TEST(AreaLights, TheFilesOwnShapesKeepPlaceAndSideWhateverTheirHandedness) {
  for (const LightType type : {LightType::area_rect, LightType::area_disk}) {
    for (const float hand : {1.0f, -1.0f}) {
      Light light;
      light.type = type;
      const WorldLight placed{.position = {1, 2, 3},
                              .direction = {0, 0, -1},
                              .axis_x = {hand * 2.0f, 0, 0},
                              .axis_y = {0, 0.5f, 0}};
      const AreaLight area = made(light, placed, {.size = {9, 9}});
      expect_near(area.normal, {0, 0, -1});
      expect_near(area.centre, {1, 2, 3});
      EXPECT_NEAR(area.area_m2, type == LightType::area_rect ? 4.0 : std::acos(-1.0), 1e-5);
    }
  }
}

TEST(AreaLights, NoSizeNoPolygonAndNoAreaASentence) {
  Light light;
  EXPECT_FALSE(render::area_light_of(light, {}, {}, box).value());
  light.type = LightType::directional;
  EXPECT_FALSE(render::area_light_of(light, {}, {.size = {1, 1}}, box).value());
  light.type = LightType::area_rect;
  const WorldLight flat{.axis_x = {1, 0, 0}, .axis_y = {2, 0, 0}};
  const auto refused = render::area_light_of(light, flat, {}, box);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message, "");
}

TEST(AreaLights, BoxHoldsDrawnTrianglesOnly) {
  FrameGeometry geometry;
  geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {99, 99, 99}};
  geometry.triangles = {{0, 1, 2}, {0, 0, 0}};
  const math::Box<double> found = render::box_of(geometry);
  EXPECT_EQ(found.low, dvec3(0));
  EXPECT_EQ(found.high, dvec3(1, 2, 0));
  geometry.triangles = {{0, 0, 0}};
  EXPECT_TRUE(render::box_of(geometry).empty());
  EXPECT_EQ(render::box_of(geometry).diagonal(), 0.0);
}

TEST(AreaLights, CastersInTheLightsPlaneAreLeftOut) {
  const AreaLight light = make_rectangle_light({1000.1f, 3.3f, 0}, {0.7f, 0.1f, 0}, {0, 0, 0.9f}).value();
  FrameGeometry geometry;
  const auto add = [&](float lift) {
    const auto first = static_cast<std::uint32_t>(geometry.positions.size());
    for (int k = 0; k < 3; ++k) {
      geometry.positions.push_back(light.vertices[static_cast<std::size_t>(k)] + lift * vec3(light.normal));
    }
    geometry.triangles.emplace_back(first, first + 1, first + 2);
    geometry.casts_shadow.push_back(1);
  };
  add(0.01f);
  std::vector<std::uint8_t> casters{7};
  EXPECT_FALSE(render::casters_off_plane(geometry, light, casters));
  EXPECT_EQ(casters, std::vector<std::uint8_t>{7});
  add(0);
  add(-0.01f);
  EXPECT_TRUE(render::casters_off_plane(geometry, light, casters));
  EXPECT_EQ(casters, (std::vector<std::uint8_t>{1, 0, 1}));
}

/// One node with `mesh`, its material 1 shining.
struct Shining {
  Scene scene;
  FrameGeometry geometry;
  std::vector<std::string> notes;

  explicit Shining(Mesh mesh, glm::dvec3 scale = dvec3(1)) {
    scene.materials = {{.name = "dull"}, {.name = "glow", .emissive = {1, 2, 3}}};
    mesh.name = "lamp";
    add_mesh(scene, std::move(mesh));
    scene.nodes[0].scale = scale;
    evaluate_frame(scene, -1, 0, geometry);
  }
  std::vector<render::EmissivePolygon> polygons() {
    return render::emissive_polygons(scene, geometry, notes);
  }
};

TEST(EmissiveMeshes, QuadsShineToTheirFrontAlsoWhereMirrored) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  for (const double mirror : {1.0, -1.0}) {
    Shining lamp(mesh, {mirror, 1, 1});
    const auto found = lamp.polygons();
    ASSERT_EQ(found.size(), 1u);
    expect_near(found[0].area.normal, {0, 0, 1});
    EXPECT_NEAR(found[0].area.area_m2, 2.0, 1e-9);
    EXPECT_EQ(found[0].radiance, vec3(1, 2, 3));
    EXPECT_EQ(found[0].mesh, "lamp");
    EXPECT_TRUE(lamp.notes.empty());
  }
}

TEST(EmissiveMeshes, ATiledQuadFarFromTheOriginIsOnePolygon) {
  Mesh mesh;
  const vec3 corner(811.3f, -407.7f, 93.1f), u(0.31f, 0.07f, 0.11f), v(-0.05f, 0.29f, 0.02f);
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) add_quad(mesh, corner + float(i) * u + float(k) * v, u, v, 1);
  }
  Shining lamp(mesh);
  const auto found = lamp.polygons();
  EXPECT_TRUE(lamp.notes.empty()) << lamp.notes[0];
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].area.area_m2, 16 * glm::length(glm::cross(dvec3(u), dvec3(v))), 1e-3);
}

TEST(EmissiveMeshes, OnlyTheShiningPartOfAMeshIsALight) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  add_quad(mesh, {0, 0, 1}, {2, 0, 1}, {0, 1, 0}, 0);
  EXPECT_EQ(Shining(mesh).polygons().size(), 1u);
}

TEST(EmissiveMeshes, WhatIsNoFlatConvexPolygonIsNamed) {
  Mesh dented;  // an L
  add_quad(dented, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  add_quad(dented, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  Mesh bent;
  add_quad(bent, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  add_quad(bent, {0, 1, 0}, {2, 0, 0}, {0, 1, 0.1f}, 1);
  Mesh roof;  // a pyramid over a square: its outline is flat
  roof.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0.2f}};
  roof.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  roof.materials = {1, 1, 1, 1};
  Mesh both_sides;
  add_quad(both_sides, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  add_quad(both_sides, {0, 0, 0}, {0, 1, 0}, {2, 0, 0}, 1);
  Mesh no_area;
  add_quad(no_area, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}, 1);
  for (const Mesh& mesh : {dented, bent, roof, both_sides, no_area}) {
    Shining lamp(mesh);
    EXPECT_TRUE(lamp.polygons().empty());
    ASSERT_EQ(lamp.notes.size(), 1u);
    EXPECT_TRUE(lamp.notes[0].starts_with("mesh lamp is emissive but lights nothing: ")) << lamp.notes[0];
  }
}

TEST(EmissiveMeshes, HiddenOnesDoNotShine) {
  Mesh mesh;
  add_quad(mesh, {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 1);
  Shining lamp(mesh);
  lamp.scene.nodes[0].visible = false;
  evaluate_frame(lamp.scene, -1, 0, lamp.geometry);
  EXPECT_TRUE(lamp.polygons().empty());
  EXPECT_TRUE(lamp.notes.empty());
}

}  // namespace
}  // namespace tenebra
