// Light buffers against the formulas in double, pixel by pixel.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "shade/shading.h"
#include "support/hand_made.h"

namespace tenebra {
namespace {

using std::numbers::pi;
constexpr int buffer_width = 33, buffer_height = 21;

/// Fade of a light towards a point in direction `to_light` (unit) at `distance`, by KHR_lights_punctual.
double expected_fade(const Light& light, const WorldLight& placed, const glm::dvec3& to_light,
                     double distance) {
  const double cosine = -glm::dot(glm::dvec3(placed.direction), to_light);
  double fade = light.falloff == Falloff::inverse_square ? 1.0 / (distance * distance) : 1.0;
  if (light.range_m) fade *= std::clamp(1.0 - std::pow(distance / *light.range_m, 4.0), 0.0, 1.0);
  if (light.type == LightType::spot) {
    const double inner = std::cos(light.inner_cone_rad), outer = std::cos(light.outer_cone_rad);
    fade *= std::pow(std::clamp((cosine - outer) / std::max(0.001, inner - outer), 0.0, 1.0), 2.0);
  }
  const double area = glm::length(glm::cross(glm::dvec3(placed.axis_x), glm::dvec3(placed.axis_y)));
  if (light.type == LightType::area_rect) fade *= 4.0 * area * std::max(cosine, 0.0);
  if (light.type == LightType::area_disk) fade *= pi * area * std::max(cosine, 0.0);
  return fade;
}

glm::dvec3 expected_light(const Light& light, const WorldLight& placed, const Material& material,
                          const glm::dvec3& point, const glm::dvec3& face_to_eye, glm::dvec3 normal) {
  glm::dvec3 to_light = -glm::dvec3(placed.direction);
  double fade = 1.0;
  if (light.type != LightType::directional) {
    const glm::dvec3 path = glm::dvec3(placed.position) - point;
    to_light = glm::normalize(path);
    fade = expected_fade(light, placed, to_light, glm::length(path));
  }
  if (glm::dot(face_to_eye, to_light) <= 0) return glm::dvec3(0.0);
  if (glm::dot(normal, face_to_eye) < 0) normal = -normal;
  if (light.falloff == Falloff::inverse_square) fade /= pi;
  return glm::dvec3(material.base_color) * glm::dvec3(light.color) * double(light.intensity) *
         std::max(glm::dot(normal, to_light), 0.0) * fade;
}

/// The light buffer of a view in which every pixel sees triangle `id`.
io::ImageF buffer_of(const FrameGeometry& frame, const ViewRays& view, int w, int h, std::uint32_t id,
                     const std::vector<Material>& materials, const shade::DrawnLight& light) {
  const std::vector<std::uint32_t> ids(static_cast<std::size_t>(w * h), id);
  const shade::SurfaceTable surfaces(materials);
  io::ImageF image;
  shade::light_buffer({frame, view, surfaces}, {.lights = std::span(&light, 1)}, 0,
                      {.width = w, .height = h, .ids = ids}, image);
  return image;
}

class LightBufferTest : public ::testing::Test {
protected:
  /// A wall over the whole view in the plane z = -6, tilted; checks every pixel. Returns the brightest value
  /// seen.
  double expect_formula(const Light& light, const WorldLight& placed, const ViewRays& view,
                        glm::vec3 normal = glm::vec3(0.0f), bool flip_winding = false) {
    const Material material = make_material({0.8f, 0.5f, 1.5f});
    FrameGeometry g;
    add_triangle(g, {0, 0, -1}, {0, 0, -1}, {0, 0, -1});  // so that ids are not all 0
    glm::vec3 a(-100, -80, -16), b(100, -80, -16), c(0, 160, 8);
    if (flip_winding) std::swap(b, c);
    add_triangle(g, a, b, c, 1, normal);
    const io::ImageF image =
        buffer_of(g, view, buffer_width, buffer_height, 1, {Material{}, material}, {light, placed});
    glm::dvec3 face = glm::normalize(glm::cross(glm::dvec3(b - a), glm::dvec3(c - a)));
    if (face.z < 0) face = -face;  // the eye is in front
    const glm::dvec3 shading = normal == glm::vec3(0.0f) ? face : glm::dvec3(normal);
    double brightest = 0;
    for (int y = 0; y < buffer_height; ++y) {
      for (int x = 0; x < buffer_width; ++x) {
        const glm::dvec3 across = (x + 0.5) * glm::dvec3(view.dx) + (y + 0.5) * glm::dvec3(view.dy);
        const glm::dvec3 origin = glm::dvec3(view.eye) + (view.orthographic ? across : glm::dvec3(0.0));
        const glm::dvec3 ray = glm::dvec3(view.d0) + (view.orthographic ? glm::dvec3(0.0) : across);
        const glm::dvec3 point = origin + glm::dot(face, glm::dvec3(a) - origin) / glm::dot(face, ray) * ray;
        const glm::dvec3 expected = expected_light(light, placed, material, point, face, shading);
        const float* found = &image.pixels[static_cast<std::size_t>(3 * (y * buffer_width + x))];
        for (int i = 0; i < 3; ++i) {
          brightest = std::max(brightest, expected[i]);
          // A cone's edge steepens what the cosine lost.
          EXPECT_NEAR(found[i], expected[i], 2e-5 * std::abs(expected[i]) + 2e-5) << "at " << x << ", " << y;
        }
      }
    }
    return brightest;
  }
};

const ViewRays perspective = forward_view({0, 0, 0}, 20.0f, buffer_width, buffer_height);
const ViewRays orthographic = orthographic_view({0, 0, 0}, 0.25f, buffer_width, buffer_height);

TEST_F(LightBufferTest, PointLightsWithAndWithoutFalloff) {
  Light light = make_light(LightType::point, 40.0f);
  light.color = {1.0f, 0.5f, 0.25f};
  const WorldLight placed{.position = {1, 2, -3}};
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
  EXPECT_GT(expect_formula(light, placed, orthographic), 0.1);
  light.range_m = 8.0f;
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
  light.falloff = Falloff::none;
  light.intensity = 1.0f;
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
}

TEST_F(LightBufferTest, SpotLightsFadeFromInnerToOuterCone) {
  Light light = make_light(LightType::spot, 40.0f);
  light.inner_cone_rad = 0.3f;
  light.outer_cone_rad = 0.8f;
  const WorldLight placed{.position = {1, 2, -1},
                          .direction = glm::normalize(glm::vec3(-0.2f, -0.1f, -1.0f))};
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
  light.outer_cone_rad = 2.0f;  // past 90 degrees
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
}

TEST_F(LightBufferTest, DirectionalLightsKnowNoDistance) {
  Light light = make_light(LightType::directional, 2.0f);
  const WorldLight placed{.direction = glm::normalize(glm::vec3(0.3f, -0.4f, -1.0f))};
  EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
  EXPECT_GT(expect_formula(light, placed, orthographic), 0.1);
}

TEST_F(LightBufferTest, AreaLightsActAsTheirCentreAndShineOneWay) {
  for (LightType type : {LightType::area_rect, LightType::area_disk}) {
    const Light light = make_light(type, 30.0f);
    WorldLight placed{
        .position = {1, 1, -2}, .direction = {0, 0, -1}, .axis_x = {0.5f, 0, 0}, .axis_y = {0, 0.25f, 0}};
    EXPECT_GT(expect_formula(light, placed, perspective), 0.1);
    placed.direction = {0, 0, 1};
    EXPECT_EQ(expect_formula(light, placed, perspective), 0.0);
  }
}

// What an area light's buffer leaves out is the irradiance; of a small light that is area cos cos' / d^2, and
// with it the buffer must be that of the point: both in one relation, for every kind of light and fade.
TEST_F(LightBufferTest, AreaBuffersTimesTheIrradianceOfASmallLightAreThoseOfItsCentre) {
  constexpr double area_m2 = 0.375;
  const WorldLight placed{.position = {1, 2, -1},
                          .direction = glm::normalize(glm::vec3(-0.2f, -0.1f, -1.0f)),
                          .axis_x = {0.75f, 0, 0},
                          .axis_y = {0, 0.125f, 0}};  // a rectangle of 0.375
  FrameGeometry g;
  add_triangle(g, {-100, -80, -16}, {100, -80, -16}, {0, 160, 8});
  const std::vector<Material> materials{make_material({0.8f, 0.5f, 1.5f})};
  const auto polygon = make_rectangle_light(placed.position, placed.axis_x, placed.axis_y);
  ASSERT_TRUE(polygon);
  ASSERT_NEAR(polygon->area_m2, area_m2, 1e-9);
  const glm::dvec3 face = glm::normalize(glm::cross(glm::dvec3(200, 0, 0), glm::dvec3(100, 240, 24)));
  for (const LightType type : {LightType::point, LightType::spot, LightType::area_rect}) {
    for (const Falloff falloff : {Falloff::inverse_square, Falloff::none}) {
      if (type == LightType::area_rect && falloff == Falloff::none) continue;  // no format has it
      Light light = make_light(type, 3.0f, falloff);
      light.color = {1.0f, 0.5f, 0.25f};
      light.range_m = 20.0f;
      light.inner_cone_rad = 0.3f;
      light.outer_cone_rad = 0.9f;
      const io::ImageF point =
          buffer_of(g, perspective, buffer_width, buffer_height, 0, materials, {light, placed});
      const io::ImageF area =
          buffer_of(g, perspective, buffer_width, buffer_height, 0, materials, {light, placed, *polygon});
      const shade::LightTerms terms = shade::light_terms({light, placed, *polygon}, ViewRays{});
      int lit = 0;
      for (int i = 0; i < buffer_width * buffer_height; ++i) {
        const glm::dvec3 ray = glm::dvec3(perspective.d0) +
                               (i % buffer_width + 0.5) * glm::dvec3(perspective.dx) +
                               (i / buffer_width + 0.5) * glm::dvec3(perspective.dy);
        const glm::dvec3 path = glm::dvec3(placed.position) -
                                glm::dot(face, glm::dvec3(-100, -80, -16)) / glm::dot(face, ray) * ray;
        const double distance = glm::length(path);
        const double at_light = glm::dot(glm::dvec3(placed.direction), -path / distance);
        const double irradiance =
            area_m2 * std::max(glm::dot(face, path / distance), 0.0) / (distance * distance);
        // An area light's own cosine is part of the point's light already; a lamp made an area gains it.
        const double factor =
            type == LightType::area_rect ? irradiance * std::max(at_light, 0.0) : irradiance;
        const double fade = shade::fade_of(terms, path / distance, distance);
        for (int c = 0; c < 3; ++c) {
          const auto at = static_cast<std::size_t>(3 * i + c);
          const double in_double = materials[0].base_color[c] * terms.color[c] * fade;
          EXPECT_NEAR(area.pixels[at], in_double, 1e-4 * in_double + 1e-5) << i;
          EXPECT_NEAR(area.pixels[at] * factor, point.pixels[at], 1e-3 * point.pixels[at] + 1e-6) << i;
          lit += point.pixels[at] > 0;
        }
      }
      EXPECT_GT(lit, 100);
    }
  }
}

TEST_F(LightBufferTest, ShadingNormalsTurnToTheEyeWhateverTheWinding) {
  const Light light = make_light(LightType::point, 1.0f, Falloff::none);
  const WorldLight placed{.position = {1, 2, -3}};
  for (const glm::vec3& normal :
       {glm::vec3(0.6f, 0.0f, 0.8f), glm::vec3(-0.6f, 0.0f, -0.8f), glm::vec3(0.0f)}) {
    for (bool flip : {false, true}) EXPECT_GT(expect_formula(light, placed, perspective, normal, flip), 0.1);
  }
}

TEST_F(LightBufferTest, LightsBehindTheFaceGiveNothingEvenIfTheNormalWouldLetThem) {
  const Light light = make_light(LightType::point, 1.0f, Falloff::none);
  const WorldLight behind{.position = {40, 0, -30}};
  EXPECT_EQ(expect_formula(light, behind, perspective, glm::normalize(glm::vec3(1.0f, 0.0f, 0.1f))), 0.0);
}

TEST_F(LightBufferTest, LightOnTheSurfaceStaysFinite) {
  const Light light = make_light(LightType::point, 1e30f);
  FrameGeometry g;
  add_triangle(g, {-9, -9, -4}, {9, -9, -4}, {0, 30, -4});
  const ViewRays view = forward_view({0, 0, 0}, 8.0f, 5, 5);
  for (float height_m : {0.0f, 1e-20f, 1e-6f}) {
    const WorldLight placed{.position = {0, 0, -4 + height_m}};
    const io::ImageF image = buffer_of(g, view, 5, 5, 0, {Material{}}, {light, placed});
    for (float value : image.pixels) EXPECT_TRUE(std::isfinite(value) && value >= 0) << value;
  }
}

TEST_F(LightBufferTest, BackgroundStaysDark) {
  const io::ImageF image = buffer_of({}, perspective, buffer_width, buffer_height, background_id, {},
                                     {make_light(LightType::directional), {}});
  EXPECT_EQ(image.pixels, std::vector<float>(3u * buffer_width * buffer_height, 0.0f));
}

// A pixel's id may be that of a triangle which its ray just misses, or meets edge-on: the sample is then the
// triangle's nearest point or its centre, and never infinite.
TEST_F(LightBufferTest, PixelsBesideTheirTriangleAreMovedIntoIt) {
  const Light light = make_light(LightType::point, 1.0f, Falloff::none);
  const WorldLight placed{.position = {0, 0, -3}};
  FrameGeometry g;
  add_triangle(g, {-0.1f, -0.1f, -4}, {0.1f, -0.1f, -4}, {0, 0.1f, -4});  // smaller than the view
  add_triangle(g, {0, -9, -4}, {0, 9, -4}, {0, 0, -40});                  // in a plane through the eye
  add_triangle(g, {-9, -9, 4}, {9, -9, 4}, {0, 30, 4});                   // behind it
  for (const ViewRays& view :
       {forward_view({0, 0, 0}, 8.0f, 9, 5), orthographic_view({0, 0, 0}, 0.3f, 9, 5)}) {
    for (std::uint32_t id = 0; id < 3; ++id) {
      for (float value : buffer_of(g, view, 9, 5, id, {Material{}}, {light, placed}).pixels) {
        EXPECT_TRUE(value >= 0 && value <= 0.8f) << id;
        if (id == 0) {
          EXPECT_GT(value, 0.8 * 0.98) << "near the light's foot";
        }
      }
    }
  }
}

}  // namespace
}  // namespace tenebra
