// A host's lists from memory, and its matrices as rays.
#include <tenebra/host_frame.h>

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace tenebra {
namespace {

using Ids = std::vector<std::uint32_t>;

TEST(HostFrame, HasTheTopRowFirstAndTrianglesFromZero) {
  const Ids ids{0, 1, 2, 3, 4, 7};
  const std::vector<float> depth{0, 1, 2, 3, 4, 5};
  HostFrame frame;
  ASSERT_TRUE(take_host_frame(ids, depth, 2, 3, {.first_id = 1}, frame));
  EXPECT_EQ(frame.ids, (Ids{3, 6, 1, 2, no_triangle, 0}));
  EXPECT_EQ(frame.depth, (std::vector<float>{4, 5, 2, 3, 0, 1}));
  ASSERT_TRUE(take_host_frame(ids, {}, 3, 2, {.bottom_row_first = false}, frame));
  EXPECT_EQ(frame.ids, ids);
  EXPECT_TRUE(frame.depth.empty());
}

TEST(HostFrame, RefusesListsOfAnotherSize) {
  HostFrame frame;
  const Ids ids(6);
  const std::vector<float> depth(5);
  EXPECT_EQ(take_host_frame(ids, {}, 2, 2, {}, frame).error().message,
            "host's frame: found 6 ids, expected 2x2");
  EXPECT_EQ(take_host_frame(ids, depth, 2, 3, {}, frame).error().message,
            "host's frame: found 5 depths, expected 2x3 or none");
  EXPECT_EQ(take_host_frame(ids, {}, -2, -3, {}, frame).error().message,
            "host's frame: found size -2x-3, expected at least 1x1");
}

constexpr int picture_width = 64, picture_height = 48;

HostCamera looking(const glm::dmat4& clip_from_view, bool zero_to_one = false) {
  return {glm::lookAt(glm::dvec3(3, 2, 5), glm::dvec3(0, 0.5, 0), glm::dvec3(0.1, 1, 0)), clip_from_view,
          zero_to_one};
}

/// Points ahead of the camera, projected by its matrices, lie on the rays of the pixels that they fall on;
/// their depths lead back to them.
void expect_rays_and_depths_agree(const HostCamera& camera) {
  const auto view = host_view(camera, picture_width, picture_height);
  ASSERT_TRUE(view) << view.error().message;
  const glm::dmat4 clip_from_world = camera.clip_from_view * camera.view_from_world;
  HostFrame frame{picture_width, picture_height, Ids(picture_width * picture_height),
                  std::vector<float>(picture_width * picture_height, 1.0f)};
  for (const auto& [x, y] : {std::pair(0, 0), {63, 0}, {5, 40}, {32, 24}}) {
    const glm::dvec3 across = (x + 0.5) * glm::dvec3(view->dx) + (y + 0.5) * glm::dvec3(view->dy);
    const glm::dvec3 start = glm::dvec3(view->eye) + (view->orthographic ? across : glm::dvec3(0));
    const glm::dvec3 along = glm::dvec3(view->d0) + (view->orthographic ? glm::dvec3(0) : across);
    const glm::dvec3 point = start + 3.0 * along;
    const glm::dvec4 clip = clip_from_world * glm::dvec4(point, 1.0);
    EXPECT_NEAR(clip.x / clip.w, 2 * (x + 0.5) / picture_width - 1, 1e-6);
    EXPECT_NEAR(clip.y / clip.w, 1 - 2 * (y + 0.5) / picture_height, 1e-6);
    const double z = clip.z / clip.w;
    EXPECT_TRUE(z > -1 && z < 1) << z;
    const auto pixel = static_cast<std::size_t>(picture_width * y + x);
    frame.depth[pixel] = static_cast<float>(camera.depth_zero_to_one ? z : 0.5 * z + 0.5);
    std::vector<glm::dvec3> positions;
    ASSERT_TRUE(positions_from_depth(frame, camera, 1.0, positions));
    EXPECT_LT(glm::distance(positions[pixel], point), 1e-4);
    EXPECT_TRUE(std::isnan(positions[7].x));
  }
}

TEST(HostCamera, IsThatOfItsMatrices) {
  expect_rays_and_depths_agree(looking(glm::perspective(0.9, 4.0 / 3, 0.5, 20.0)));
  expect_rays_and_depths_agree(looking(glm::perspectiveZO(0.9, 4.0 / 3, 0.5, 20.0), true));
  expect_rays_and_depths_agree(looking(glm::perspectiveZO(0.9, 4.0 / 3, 20.0, 0.5), true));  // reversed
  expect_rays_and_depths_agree(looking(glm::frustum(-0.2, 0.4, -0.3, 0.1, 0.5, 20.0)));
  expect_rays_and_depths_agree(looking(glm::ortho(-2.0, 2.5, -1.0, 2.0, 0.5, 20.0)));
}

TEST(HostCamera, RefusesMatricesThatSpanNoPicture) {
  EXPECT_FALSE(host_view({.clip_from_view = glm::dmat4(0.0)}, picture_width, picture_height));
  EXPECT_FALSE(host_view({.clip_from_view = glm::dmat4(std::nan(""))}, picture_width, picture_height));
  EXPECT_FALSE(host_view(looking(glm::perspective(0.9, 1.0, 0.5, 20.0)), 0, picture_height));
  std::vector<glm::dvec3> positions;
  EXPECT_FALSE(positions_from_depth({2, 2, Ids(4), {}}, {}, 1.0, positions));
}

}  // namespace
}  // namespace tenebra
