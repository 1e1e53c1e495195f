// Scenes made of boxes, and what a camera shows of them, by rays.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

#include <tenebra/frame_geometry.h>

namespace tenebra::testing {

using glm::dvec3;

/// Corners of a box, and its twelve triangles, fronts outward.
inline void add_box(Mesh& mesh, glm::vec3 low, glm::vec3 high) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                                (i & 4) != 0 ? high.z : low.z);
  for (const glm::uvec3& t : std::initializer_list<glm::uvec3>{{0, 2, 1},
                                                               {1, 2, 3},
                                                               {4, 5, 6},
                                                               {5, 7, 6},
                                                               {0, 1, 4},
                                                               {1, 5, 4},
                                                               {2, 6, 3},
                                                               {3, 6, 7},
                                                               {0, 4, 2},
                                                               {2, 4, 6},
                                                               {1, 3, 5},
                                                               {3, 7, 5}})
    mesh.triangles.push_back(first + t);
  mesh.materials.assign(mesh.triangles.size(), 0);
}

inline Scene scene_of(std::vector<Mesh> meshes) {
  Scene scene;
  scene.materials.emplace_back();
  for (Mesh& mesh : meshes) {
    Node node;
    node.mesh = static_cast<int>(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.nodes.push_back(node);
  }
  return scene;
}

/// Closed boxes, as one mesh each.
inline Scene boxes(const std::vector<std::pair<glm::vec3, glm::vec3>>& all) {
  std::vector<Mesh> meshes(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) add_box(meshes[i], all[i].first, all[i].second);
  return scene_of(std::move(meshes));
}

/// The way along origin + t direction, t > 0, to the first of the triangles; none: it meets none.
inline std::optional<double> first_hit(const FrameGeometry& frame, std::size_t triangles, const dvec3& origin,
                                       const dvec3& direction) {
  std::optional<double> nearest;
  for (std::size_t i = 0; i < triangles; ++i) {
    const glm::uvec3 t = frame.triangles[i];
    const dvec3 a(frame.positions[t.x]), e1 = dvec3(frame.positions[t.y]) - a,
                                         e2 = dvec3(frame.positions[t.z]) - a, n = glm::cross(e1, e2);
    const double speed = glm::dot(n, direction), way = glm::dot(n, a - origin) / speed;
    if (!(way > 1e-9) || (nearest && way >= *nearest)) continue;
    const dvec3 p = origin + way * direction - a;
    const double u = glm::dot(glm::cross(p, e2), n) / glm::dot(n, n),
                 v = glm::dot(glm::cross(e1, p), n) / glm::dot(n, n);
    if (u >= 0 && v >= 0 && u + v <= 1) nearest = way;
  }
  return nearest;
}

struct BoxShares {
  double subject = 0, shadow = 0;
};
/// Of a picture's pixels, by rays: what sees the first `subject` triangles, and what sees their shadow on the
/// others.
inline BoxShares shares_of(const Scene& scene, const FrameGeometry& frame, std::size_t subject) {
  const int height = 60, width = static_cast<int>(height * scene.cameras[0].aspect.value_or(4 / 3.0f));
  const int clip = scene.clips.empty() ? -1 : 0;
  const ViewRays view = evaluate_camera(scene, clip, 0, 0, width, height);
  const auto lights = evaluate_lights(scene, clip, 0);
  BoxShares shares;
  for (int i = 0; i < width * height; ++i) {
    const dvec3 direction =
        dvec3(view.d0) + (i % width + 0.5) * dvec3(view.dx) + (i / width + 0.5) * dvec3(view.dy);
    const auto whole = first_hit(frame, frame.triangles.size(), dvec3(view.eye), direction);
    if (!whole) continue;
    if (first_hit(frame, subject, dvec3(view.eye), direction) == whole) {
      ++shares.subject;
      continue;
    }
    const dvec3 on_floor = dvec3(view.eye) + *whole * direction;
    shares.shadow += first_hit(frame, subject, on_floor, -dvec3(lights.at(0).direction)).has_value();
  }
  return {shares.subject / (width * height), shares.shadow / (width * height)};
}

inline FrameGeometry frame_at(const Scene& scene, double time_s = 0) {
  FrameGeometry frame;
  evaluate_frame(scene, scene.clips.empty() ? -1 : 0, time_s, frame);
  return frame;
}

/// All corners of the first `triangles` are in the added camera's picture.
inline void expect_in_picture(const Scene& scene, const FrameGeometry& frame, std::size_t triangles) {
  const ViewRays view =
      evaluate_camera(scene, -1, 0, 0, 100, static_cast<int>(100 / *scene.cameras[0].aspect));
  const glm::dmat3 rays(view.dx, view.dy, view.d0);
  const double height = std::floor(100 / *scene.cameras[0].aspect);
  for (std::size_t i = 0; i < triangles; ++i) {
    for (int k = 0; k < 3; ++k) {
      const dvec3 pixel =
          glm::inverse(rays) * (dvec3(frame.positions[frame.triangles[i][k]]) - dvec3(view.eye));
      EXPECT_GT(pixel.z, 0);
      EXPECT_TRUE(pixel.x > 0 && pixel.x < 100 * pixel.z && pixel.y > 0 && pixel.y < height * pixel.z);
    }
  }
}

}  // namespace tenebra::testing
