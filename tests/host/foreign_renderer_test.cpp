// A program with a renderer of its own (tests/consumer/foreign_renderer.cpp) draws a bundled scene and asks
// for its shadows: the masks of its ids are those of Tenebra's own raster, bit for bit, wherever the ids are.
#include <tenebra/hard_shadows.h>
#include <tenebra/host_frame.h>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "formats/import_scene.h"
#include "support/virtual_display.h"
#include "visibility/visibility.h"

namespace tenebra {
namespace {

constexpr int width = 320, height = 240;

#ifdef TENEBRA_FOREIGN_RENDERER
constexpr const char* program = TENEBRA_FOREIGN_RENDERER;
#else
constexpr const char* program = nullptr;
#endif

/// The matrices that a host would have for this view.
HostCamera matrices_of(const ViewRays& view) {
  const glm::dvec3 eye(view.eye), dx(view.dx), dy(view.dy), d0(view.d0);
  const glm::dvec3 back = glm::normalize(glm::cross(dx, -dy));
  const double half_height = 0.5 * height * glm::length(dy) / -glm::dot(d0, back);
  return {
      .view_from_world = glm::lookAt(eye, eye - back, -dy),
      .clip_from_view = glm::perspective(2 * std::atan(half_height), double{width} / height, 0.1, 1000.0)};
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}
template <class T>
void append_list(std::string& bytes, const std::vector<T>& list) {
  append(bytes, static_cast<std::uint32_t>(list.size()));
  bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
}
template <class T>
std::vector<T> read_list(const std::filesystem::path& path) {
  const std::string bytes = testing::read_text(path);
  std::vector<T> list(bytes.size() / sizeof(T));
  std::memcpy(list.data(), bytes.data(), list.size() * sizeof(T));
  return list;
}

/// One instant of a bundled scene, without what is see-through, and a light in it.
struct Instant {
  FrameGeometry geometry;
  HostCamera camera;
  ViewRays view;
  glm::vec3 light{0.0f};
};

Instant instant_of(const char* name, double time_s) {
  const auto scene = formats::import_scene(std::string(TENEBRA_SCENES_DIR "/") + name);
  EXPECT_TRUE(scene) << scene.error().message;
  Instant now;
  evaluate_frame(*scene, 0, time_s, now.geometry);
  for (std::size_t i = 0; i < now.geometry.see_through.size(); ++i)
    if (now.geometry.see_through[i] != 0) now.geometry.triangles[i] = glm::uvec3(0);
  now.geometry.see_through.clear();
  now.camera = matrices_of(evaluate_camera(*scene, 0, time_s, 0, width, height));
  now.view = host_view(now.camera, width, height).value();
  for (const WorldLight& light : evaluate_lights(*scene, 0, time_s)) {
    const bool far = scene->lights[static_cast<std::size_t>(light.light)].type == LightType::directional;
    now.light = far ? -500.0f * light.direction : light.position;
  }
  return now;
}

std::string bytes_of(const Instant& now) {
  std::string bytes;
  append(bytes, std::uint32_t{width});
  append(bytes, std::uint32_t{height});
  append_list(bytes, now.geometry.positions);
  append_list(bytes, now.geometry.triangles);
  append_list(bytes, now.geometry.casts_shadow);
  append_list(bytes, now.geometry.parts);
  append(bytes, now.camera.view_from_world);
  append(bytes, now.camera.clip_from_view);
  append(bytes, now.light);
  return bytes;
}

ShadowMask mask_of(const Instant& now, const std::vector<std::uint32_t>& ids, Variant variant) {
  VisiblePoints points;
  ShadowTracer tracer;
  ShadowMask mask;
  const TriangleView triangles = triangle_view(now.geometry);
  compute_visible_points(ids, width, height, now.view, triangles, points);
  tracer.trace_shadow_mask(points, triangles, {.position = now.light}, {.variant = variant}, mask);
  return mask;
}

std::vector<std::uint32_t> own_ids(const Instant& now) {
  visibility::VisibilityPass pass;
  visibility::VisibleIds seen;
  const auto drawn = pass.draw(now.geometry, now.view, width, height, false, SimdLevel::automatic, seen);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return seen.ids;
}

class ForeignRenderer : public ::testing::TestWithParam<const char*> {
protected:
  void SetUp() override {
    // The renderer is a GLFW program, and GLFW comes with the program that may be left out of a build.
    // Its window needs a display; setup installs a virtual one.
    if (program == nullptr) GTEST_SKIP() << "built without the window's library, which the renderer takes";
    if (!testing::has_program("Xvfb")) GTEST_SKIP() << "Xvfb is missing: tools/setup.sh --tests";
  }
};

TEST_P(ForeignRenderer, GetsTheMasksOfItsOwnIdsBitForBit) {
  const testing::TemporaryFolder folder;
  const testing::VirtualDisplay display;
  const Instant now = instant_of(GetParam(), 2.0);
  testing::write_text(folder / "scene.bin", bytes_of(now));
  const auto ran = testing::run_program({program, folder.path().string()}, [&display] {
    display.enter();
    ::setenv("ASAN_OPTIONS", "detect_leaks=0", 0);  // the driver's: it is unloaded before they are looked for
  });
  if (ran.exit_code == 77) GTEST_SKIP() << ran.errors;
  ASSERT_EQ(ran.exit_code, 0) << ran.errors;
  const auto ids = read_list<std::uint32_t>(folder / "ids.bin");
  const auto mask = read_list<std::uint8_t>(folder / "mask.bin");
  ASSERT_EQ(ids.size(), std::size_t{width * height});
  EXPECT_EQ(mask, mask_of(now, ids, Variant::precise_sorted));

  const auto own = own_ids(now);
  const auto own_mask = mask_of(now, own, Variant::tiles);
  int other_ids = 0, lit = 0, seen = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    seen += own[i] != no_triangle;
    lit += own_mask[i] != 0;
    other_ids += ids[i] != own[i];
    if (ids[i] == own[i]) {
      ASSERT_EQ(mask[i], own_mask[i]) << i;
    }
  }
  EXPECT_GT(lit, 3000);
  EXPECT_GT(seen - lit, 3000);
  EXPECT_LT(other_ids, width * height / 200);  // edges, where OpenGL rounds vertices

  // docs/foreign_renderer.md has these figures.
  std::string line =
      fmt::format("{}: {} seen, {} ids differ; wrong from depth alone:", GetParam(), seen, other_ids);
  for (const int bias_mm : {0, 1, 3, 10, 30, 100, 300}) {
    const auto rough = read_list<std::uint8_t>(folder / fmt::format("depth_mask_{}.bin", bias_mm));
    int wrong = 0;
    for (std::size_t i = 0; i < own.size(); ++i) wrong += ids[i] != no_triangle && rough[i] != mask[i];
    line += fmt::format(" {} mm {}", bias_mm, wrong);
    EXPECT_GT(wrong, 0) << "depth alone is exact with " << bias_mm << " mm?";
  }
  RecordProperty("wrong", line);
  std::puts(line.c_str());
}

INSTANTIATE_TEST_SUITE_P(, ForeignRenderer, ::testing::Values("city.glb", "court.glb"),
                         [](const auto& info) { return std::string(info.param).substr(0, 4); });

}  // namespace
}  // namespace tenebra
