// Scenes in which ambient occlusion went wrong elsewhere, or is likely to: each hard in one way.
#pragma once

#include <string>
#include <vector>

#include "ao_case.h"

namespace tenebra::testing {

/// A scene that is hard in one way, and a view of it.
struct HardCase {
  const char* name;
  Scene scene;
  ViewRays view;
  double distance_m;
};

inline std::vector<HardCase> hard_cases() {
  std::vector<HardCase> cases;
  const auto room = [](double size, const glm::dvec3& at) {
    SceneMaker make;
    const auto s = static_cast<float>(size);
    make.add(quad_mesh(glm::vec3(-s, 0, -s), {0, 0, 2 * s}, {2 * s, 0, 0}), at);
    make.add(box_mesh(glm::vec3(-0.3f * s, 0, -0.3f * s), glm::vec3(0.3f * s, 0.5f * s, 0.3f * s)), at);
    make.move(make.add(ball_mesh(0.3 * size, 16), at + glm::dvec3(0.6 * size, 0.3 * size, 0)),
              {0, 0.1 * size, 0});
    return make.scene;
  };
  const auto eye = [](double size, const glm::dvec3& at) {
    return pinhole(at + glm::dvec3(2.0, 1.8, 2.0) * size, at, 0.6, 64, 48);
  };
  for (const double size : {1e-4, 1.0, 1e5})
    cases.push_back({"size", room(size, {}), eye(size, {}), 0.5 * size});
  const glm::dvec3 far(4096, -512, 2048);
  cases.push_back({"far off", room(1, far), eye(1, far), 0.5});

  SceneMaker slivers;
  slivers.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  Mesh needles;
  for (int i = 0; i < 64; ++i) {
    const float x = -1 + static_cast<float>(i) / 32;
    append(needles, quad_mesh({x, 0.1f, -1}, {0, 0, 2}, {1e-5f, 0, 0}));
    append(needles, quad_mesh({x, 0, -1}, {0, 0, 2}, {0, 0.15f, 0}));
  }
  slivers.add(needles);
  cases.push_back({"slivers", slivers.scene, eye(1, {}), 0.5});

  SceneMaker inverted;
  Mesh box = box_mesh({-0.3f, 0, -0.3f}, {0.3f, 0.5f, 0.3f});
  for (glm::uvec3& t : box.triangles) std::swap(t.y, t.z);
  inverted.add(quad_mesh({-1, 0, -1}, {2, 0, 0}, {0, 0, 2}));
  inverted.move(inverted.add(box), {0, 0.1, 0});
  cases.push_back({"inverted", inverted.scene, eye(1, {}), 0.5});

  SceneMaker open;
  open.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  open.move(open.add(quad_mesh({-0.5f, 0, 0}, {1, 0, 0}, {0, 0.6f, 0.2f})), {0, 0.1, 0});
  cases.push_back({"open", open.scene, eye(1, {}), 0.5});

  SceneMaker coplanar;
  coplanar.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  coplanar.add(quad_mesh({-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}));
  coplanar.move(coplanar.add(box_mesh({-0.2f, 0, -0.2f}, {0.2f, 0.4f, 0.2f})), {0.1, 0, 0});
  cases.push_back({"coplanar", coplanar.scene, eye(1, {}), 0.5});

  SceneMaker inside;
  inside.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  inside.move(inside.add(quad_mesh({-0.4f, -0.1f, -0.4f}, {0, 0.6f, 0}, {0.8f, 0, 0})), {0.1, 0, 0});
  inside.move(inside.add(quad_mesh({-0.4f, -0.1f, -0.4f}, {0, 0, 0.8f}, {0, 0.6f, 0})), {0.1, 0, 0});
  inside.move(inside.add(box_mesh({-0.1f, -0.2f, -0.1f}, {0.1f, 0.2f, 0.1f})), {0.1, 0, 0});
  cases.push_back({"inside", inside.scene, eye(1, {}), 0.5});

  SceneMaker many;
  many.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  const int parent = many.add(box_mesh({-0.9f, 0, -0.9f}, {-0.88f, 0.05f, -0.88f}));
  for (int i = 1; i < 2000; ++i)
    many.place(many.scene.nodes[static_cast<std::size_t>(parent)].mesh, {0.04 * (i % 45), 0, 0.04 * (i / 45)},
               parent);
  many.move(parent, {0.01, 0, 0});
  cases.push_back({"two thousand instances", many.scene, eye(1, {}), 0.2});

  SceneMaker within;  // a floor and a block inside a closed body, and the camera with them
  within.add(quad_mesh({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}));
  within.add(box_mesh({-0.3f, 0, -0.3f}, {0.3f, 0.5f, 0.3f}));
  within.move(within.add(box_mesh({-2.6f, -0.4f, -2.6f}, {2.6f, 2.2f, 2.6f})), {0, 0.1, 0});
  cases.push_back({"within a body", within.scene, eye(1, {}), 0.5});
  return cases;
}

}  // namespace tenebra::testing
