#include "bench/ao/ao_crowd.h"

#include <cmath>
#include <numbers>

#include "bench/common/bench_embree.h"
#include "support/seeded_random.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::vec3;

Object floor_of(float half) {
  return {"floor",
          {{-half, 0, -half}, {-half, 0, half}, {half, 0, half}, {half, 0, -half}},
          {{0, 1, 2}, {0, 2, 3}}};
}

/// Keys of one walk on a circle of radius 0.15 m about `place`, and of one turn.
void add_motion(Clip& clip, int node, const dvec3& place, double phase) {
  constexpr int keys = 21;
  Track walk{.components = 3}, turn{.components = 4};
  for (int k = 0; k < keys; ++k) {
    const double part = static_cast<double>(k) / (keys - 1), angle = 2 * std::numbers::pi * (part + phase);
    const dvec3 at = place + 0.15 * dvec3(std::cos(angle), 0, std::sin(angle));
    for (Track* track : {&walk, &turn}) track->times_s.push_back(10 * part);
    walk.values.insert(walk.values.end(), {at.x, at.y, at.z});
    turn.values.insert(turn.values.end(), {0, std::sin(angle / 2), 0, std::cos(angle / 2)});
  }
  for (const auto& [track, path] :
       {std::pair(&walk, ChannelPath::translation), std::pair(&turn, ChannelPath::rotation)}) {
    clip.channels.push_back({node, path, static_cast<int>(clip.tracks.size())});
    clip.tracks.push_back(std::move(*track));
  }
}

}  // namespace

Scene make_crowd(const std::vector<Object>& meshes, int count, double spacing_m) {
  constexpr int row = 10;
  Scene scene;
  scene.name = "crowd";
  scene.materials.emplace_back();
  scene.meshes.push_back(mesh_of(floor_of(30)));
  for (const Object& object : meshes) scene.meshes.push_back(mesh_of(object));
  scene.nodes.emplace_back();
  scene.nodes[0].mesh = 0;
  Clip clip{.name = "round", .end_s = 10};
  testing::Random random(11);
  const double rows = std::ceil(static_cast<double>(count) / row);
  for (int i = 0; i < count; ++i) {
    Node node;
    node.name = "walker " + std::to_string(i);
    node.mesh = 1 + i % static_cast<int>(meshes.size());
    const dvec3 place(spacing_m * (i % row - 0.5 * (row - 1)), 0,
                      spacing_m * (std::floor(static_cast<double>(i) / row) - 0.5 * (rows - 1)));
    node.translation = place;
    scene.nodes.push_back(node);
    add_motion(clip, i + 1, place, random.unit());
  }
  scene.clips.push_back(std::move(clip));
  return scene;
}

void see_crowd(const Scene& crowd, const CrowdView& view, double time_s, int size, BenchFrame& out) {
  evaluate_frame(crowd, 0, time_s, out.geometry);
  out.view = look_at(view.eye, view.target, vec3(0, 1, 0), 0.8f, 0.05f, size, size);
  const auto ids = nearest_triangles(out.triangles(), out.view, size, size);
  compute_visible_points(ids, size, size, out.view, out.triangles(), out.points);
  compute_shading_normals(out.points, out.geometry.normals, out.triangles(), out.normals);
}

}  // namespace tenebra::bench
