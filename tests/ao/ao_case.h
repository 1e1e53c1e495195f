// Small scenes for the tests of ambient occlusion, and a frame of them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <tenebra/ambient_occlusion.h>
#include "parallel/parallel.h"
#include "support/samples.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

inline Mesh quad_mesh(glm::vec3 corner, glm::vec3 u, glm::vec3 v) {
  Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0, 0};
  return mesh;
}

inline void append(Mesh& to, const Mesh& from) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
  to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  for (const glm::uvec3& t : from.triangles) to.triangles.push_back(t + base);
  to.materials.insert(to.materials.end(), from.materials.begin(), from.materials.end());
}

/// Seen from outside counter-clockwise.
inline Mesh box_mesh(glm::vec3 low, glm::vec3 high) {
  const glm::vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  Mesh mesh;
  for (const Mesh& side : {quad_mesh(low, y, x), quad_mesh(low, z, y), quad_mesh(low, x, z),
                           quad_mesh(high, -x, -y), quad_mesh(high, -y, -z), quad_mesh(high, -z, -x)})
    append(mesh, side);
  return mesh;
}

/// A ball of 2 x n x n triangles with normals of its own.
inline Mesh ball_mesh(double radius, std::uint32_t n) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) {
      const double a = 6.283185307179586 * (i % n) / n, b = 3.141592653589793 * j / n;
      const glm::dvec3 d(std::sin(b) * std::cos(a), std::cos(b), -std::sin(b) * std::sin(a));
      mesh.positions.push_back(glm::vec3(radius * d));
      mesh.normals.push_back(glm::vec3(d));
      if (i == n || j == n) continue;
      const std::uint32_t k = j * (n + 1) + i;
      mesh.triangles.push_back({k, k + n + 1, k + n + 2});
      mesh.triangles.push_back({k, k + n + 2, k + 1});
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  return mesh;
}

/// A scene of one clip, put together node by node.
class SceneMaker {
public:
  SceneMaker() { scene.materials.emplace_back(); }

  int add(Mesh mesh, glm::dvec3 at = glm::dvec3(0), int parent = -1) {
    scene.meshes.push_back(std::move(mesh));
    return place(static_cast<int>(scene.meshes.size()) - 1, at, parent);
  }
  /// An instance.
  int place(int mesh, glm::dvec3 at, int parent = -1) {
    Node node;
    node.mesh = mesh;
    node.translation = at;
    node.parent = parent;
    node.name = "node " + std::to_string(scene.nodes.size());
    scene.nodes.push_back(node);
    return static_cast<int>(scene.nodes.size()) - 1;
  }
  /// Values at 0 s and 1 s.
  void animate(int node, ChannelPath path, std::vector<double> from, const std::vector<double>& to) {
    if (scene.clips.empty()) scene.clips.push_back({.name = "clip", .end_s = 1});
    Clip& clip = scene.clips.front();
    Track track;
    track.components = static_cast<int>(from.size());
    track.times_s = {0, 1};
    track.values = std::move(from);
    track.values.insert(track.values.end(), to.begin(), to.end());
    clip.channels.push_back({node, path, static_cast<int>(clip.tracks.size())});
    clip.tracks.push_back(std::move(track));
  }
  /// From its place by `way` in a second.
  void move(int node, glm::dvec3 way) {
    const glm::dvec3 from = scene.nodes[static_cast<std::size_t>(node)].translation, to = from + way;
    animate(node, ChannelPath::translation, {from.x, from.y, from.z}, {to.x, to.y, to.z});
  }

  Scene scene;
};

/// An instant of a scene from a camera, ready for compute().
struct AoView {
  FrameGeometry geometry;
  VisiblePoints points;
  std::vector<glm::vec3> normals;

  AoView(const Scene& scene, double time_s, const ViewRays& view, int width, int height) {
    evaluate_frame(scene, scene.clips.empty() ? -1 : 0, time_s, geometry);
    points = view_samples(triangle_view(geometry), view, width, height);
    compute_shading_normals(points, geometry.normals, triangle_view(geometry), normals);
  }
};

/// compute() that must succeed.
inline std::vector<float> occlude(AmbientOcclusion& ao, const Scene& scene, const AoView& view,
                                  const AoConfig& config) {
  std::vector<float> out;
  const auto done = ao.compute(scene, view.geometry, view.points, view.normals, config, out);
  EXPECT_TRUE(done) << (done ? "" : done.error().message);
  for (const float value : out) {
    if (!(value >= 0 && value <= 1)) ADD_FAILURE() << "not in 0..1: " << value;
  }
  return out;
}
inline std::vector<float> occlude(const Scene& scene, const AoView& view, const AoConfig& config) {
  AmbientOcclusion ao;
  return occlude(ao, scene, view, config);
}

struct Difference {
  double rms_255 = 0;  ///< over pixels that see a triangle, in 1/255
  double bias_255 = 0;
  double most_255 = 0;
};
inline Difference compare(const AoView& view, const std::vector<float>& a, const std::vector<float>& b) {
  Difference d;
  double count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (view.points.triangles[i] == no_triangle) continue;
    const double off = 255 * (double{a[i]} - double{b[i]});
    d.rms_255 += off * off, d.bias_255 += off, d.most_255 = std::max(d.most_255, std::abs(off));
    ++count;
  }
  d.rms_255 = std::sqrt(d.rms_255 / std::max(count, 1.0));
  d.bias_255 /= std::max(count, 1.0);
  return d;
}

}  // namespace tenebra::testing
