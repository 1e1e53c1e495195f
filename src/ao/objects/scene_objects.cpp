#include "ao/objects/scene_objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <unordered_map>

#include "ao/objects/node_motion.h"
#include "base/until_stopped.h"
#include "math/box.h"

namespace tenebra::ao {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

constexpr double most_shear = 1e-3;  // still rigid if this far off its size and right angles

class Hash {
public:
  void add(const void* bytes, std::size_t count) {
    const auto* from = static_cast<const unsigned char*>(bytes);
    for (; count >= 8; from += 8, count -= 8) {
      std::uint64_t word;
      std::memcpy(&word, from, 8);
      mix(word);
    }
    std::uint64_t word = count;
    if (count > 0) std::memcpy(&word, from, count);  // `from` may be null
    mix(word);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    mix(values.size());
    add(values.data(), values.size() * sizeof(T));
  }
  std::uint64_t value() const { return state_; }

private:
  void mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 29;
  }
  std::uint64_t state_ = 0x243f6a8885a308d3u;
};

/// A mesh at a node, and where its part of the frame's arrays begins.
struct Part {
  std::size_t node = 0;
  const Mesh* mesh = nullptr;
  std::size_t first_vertex = 0, first_triangle = 0;
};

std::vector<Part> parts_of(const Scene& scene) {
  std::vector<Part> parts;
  std::size_t vertex = 0, triangle = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {  // the order of evaluate_frame
    if (scene.nodes[i].mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
    parts.push_back({i, &mesh, vertex, triangle});
    vertex += mesh.positions.size();
    triangle += mesh.triangles.size();
  }
  return parts;
}

bool has_skin(const Scene& scene, const Node& node, const Mesh& mesh) {
  return node.skin >= 0 && !mesh.joints.empty() &&
         !scene.skins[static_cast<std::size_t>(node.skin)].joints.empty();
}
bool deforms(const Scene& scene, const Node& node, const Mesh& mesh) {
  return has_skin(scene, node, mesh) || !mesh.shapes.empty() || !mesh.morph_targets.empty();
}

dmat4 local_matrix(const Node& node) {
  if (node.matrix) return *node.matrix;
  const double length = glm::length(node.rotation);
  const glm::dmat3 turn = length > 0 ? glm::mat3_cast(node.rotation / length) : glm::dmat3(1.0);
  return {glm::dvec4(turn[0] * node.scale.x, 0), glm::dvec4(turn[1] * node.scale.y, 0),
          glm::dvec4(turn[2] * node.scale.z, 0), glm::dvec4(node.translation, 1)};
}

dmat4 scaling(const dvec3& s) {
  return {glm::dvec4(s.x, 0, 0, 0), glm::dvec4(0, s.y, 0, 0), glm::dvec4(0, 0, s.z, 0),
          glm::dvec4(0, 0, 0, 1)};
}

/// The scale of a moving node without its size, which instances that differ only in size have in common.
dvec3 proportions(const dvec3& scale) {
  const double largest = std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)});
  return largest > 0 && scale.x * scale.y * scale.z != 0 ? scale / largest : dvec3(1.0);
}

/// Places an object; whether it is rigid depends on its `scale`.
void place(const Pose& pose, MovingObject& object) {
  const NodePose& node = pose.nodes[static_cast<std::size_t>(object.node)];
  object.to_world = node.to_world;
  for (int k = 0; k < 3; ++k) object.to_world[k] = object.to_world[k] / object.own_scale[k];
  object.to_object = glm::inverse(object.to_world);
  object.visible = node.visible && std::isfinite(glm::dot(object.to_object[0], object.to_object[1]) +
                                                 glm::dot(object.to_object[2], object.to_object[3]));
  const glm::dmat3 square = glm::transpose(glm::dmat3(object.to_world)) * glm::dmat3(object.to_world);
  const double wanted = object.scale * object.scale;
  double largest = 0, off = 0;
  for (int k = 0; k < 3; ++k) {
    largest = std::max(largest, std::abs(square[k][0]) + std::abs(square[k][1]) + std::abs(square[k][2]));
    for (int m = 0; m < 3; ++m) off = std::max(off, std::abs(square[k][m] - (k == m ? wanted : 0)));
  }
  object.largest_scale = std::sqrt(largest);  // no eigenvalue exceeds the largest sum of a row
  object.rigid = wanted > 0 && off <= most_shear * wanted;
}

vec3 unit_or_zero(const dvec3& n) {
  const double square = glm::dot(n, n);
  return square > 0 && std::isfinite(square) ? vec3(n / std::sqrt(square)) : vec3(0.0f);
}

bool finite(const vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

bool is_point(const glm::uvec3& t) {
  return t.x == t.y && t.y == t.z;
}

/// Appends a part's mesh as it lies in the object's space; not all of it if `stop` is requested.
void append(const FrameGeometry& geometry, const Part& part, const dmat4& to_object, const StopFlag* stop,
            ObjectShape& shape) {
  const Mesh& mesh = *part.mesh;
  const auto first = static_cast<std::uint32_t>(shape.positions.size());
  const glm::dmat3 linear(to_object);
  const glm::dmat3 turn(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                        glm::cross(linear[0], linear[1]));
  base::each_until_stopped(0, mesh.positions.size(), stop, [&](std::size_t v) {
    const vec3 p(linear * dvec3(mesh.positions[v]) + dvec3(to_object[3]));
    shape.positions.push_back(finite(p) ? p : vec3(0.0f));
    shape.normals.push_back(mesh.normals.empty() ? vec3(0.0f) : unit_or_zero(turn * dvec3(mesh.normals[v])));
  });
  base::each_until_stopped(0, mesh.triangles.size(), stop, [&](std::size_t t) {
    shape.triangles.push_back(mesh.triangles[t] + first);
    shape.casts.push_back(geometry.casts_shadow[part.first_triangle + t]);
  });
}

/// Room for a part that is appended; for many of them in steps that double.
void make_room(const Part& part, ObjectShape& shape) {
  const auto grow = [](auto& list, std::size_t more) {
    if (list.size() + more > list.capacity()) list.reserve(std::max(2 * list.capacity(), list.size() + more));
  };
  grow(shape.positions, part.mesh->positions.size()), grow(shape.normals, part.mesh->positions.size());
  grow(shape.triangles, part.mesh->triangles.size()), grow(shape.casts, part.mesh->triangles.size());
}

/// Appends a part of the static geometry, in world space, as the frame has it; likewise.
void append(const FrameGeometry& geometry, const Part& part, const StopFlag* stop, ObjectShape& shape) {
  make_room(part, shape);
  const auto first = static_cast<std::uint32_t>(shape.positions.size());
  const auto of_frame = static_cast<std::uint32_t>(part.first_vertex);
  base::each_until_stopped(0, part.mesh->positions.size(), stop, [&](std::size_t v) {
    shape.positions.push_back(geometry.positions[part.first_vertex + v]);
    shape.normals.push_back(geometry.normals[part.first_vertex + v]);
  });
  base::each_until_stopped(0, part.mesh->triangles.size(), stop, [&](std::size_t t) {
    const glm::uvec3 triangle = geometry.triangles[part.first_triangle + t];
    shape.triangles.push_back(is_point(triangle) ? glm::uvec3(first) : triangle - of_frame + first);
    shape.casts.push_back(geometry.casts_shadow[part.first_triangle + t]);
  });
}

/// A sphere about the casting triangles, around the middle of their box; of any size if `stop` is requested.
void enclose(ObjectShape& shape, const StopFlag* stop) {
  const auto each_corner = [&](const auto& visit) {
    base::each_until_stopped(0, shape.triangles.size(), stop, [&](std::size_t t) {
      if (!shape.casts[t] || is_point(shape.triangles[t])) return;
      for (int k = 0; k < 3; ++k) visit(shape.positions[shape.triangles[t][k]]);
    });
  };
  math::Box<float> box;
  each_corner([&](const vec3& p) { box.add(p); });
  if (box.empty()) return;
  shape.center = 0.5f * box.low + 0.5f * box.high;
  double square = 0;
  each_corner([&](const vec3& p) {
    const dvec3 away = dvec3(p) - dvec3(shape.center);
    square = std::max(square, glm::dot(away, away));
  });
  shape.radius = std::nextafter(static_cast<float>(std::sqrt(square)), INFINITY);
}

void finish(ObjectShape& shape, const StopFlag* stop) {
  enclose(shape, stop);
  Hash hash;
  hash.add(shape.positions);
  hash.add(shape.normals);
  hash.add(shape.triangles);
  hash.add(shape.casts);
  shape.hash = hash.value();
}

std::uint64_t signature_of(const Scene& scene, const FrameGeometry& geometry, const NodeMotion& motion) {
  Hash hash;
  hash.add(motion.mover);
  for (const Part& part : parts_of(scene)) {
    const NodePose& pose = geometry.pose.nodes[part.node];
    const std::size_t sizes[] = {part.first_vertex, part.first_triangle,
                                 static_cast<std::size_t>(pose.visible)};
    if (motion.mover[part.node] >= 0) {
      hash.add(sizes, 2 * sizeof(std::size_t));
      continue;
    }
    hash.add(sizes, sizeof(sizes));
    hash.add(&pose.to_world, sizeof(pose.to_world));
  }
  hash.add(geometry.casts_shadow);
  return hash.value();
}

/// Makes the objects of a scene out of its parts.
class Finder {
public:
  Finder(const Scene& scene, const FrameGeometry& geometry, const NodeMotion& motion, const StopFlag* stop,
         SceneObjects& out)
      : scene_(scene), geometry_(geometry), motion_(motion), stop_(stop), out_(out) {}

  void run() {
    out_.owners.resize(geometry_.triangles.size());
    for (const Part& part : parts_of(scene_)) {
      if (stop_requested(stop_)) return;
      sort_in(part);
    }
    if (stop_requested(stop_)) return;
    finish(out_.standing, stop_);
    for (auto& [node, parts] : groups_) {
      if (stop_requested(stop_)) return;
      add_object(node, parts);
    }
  }

private:
  void sort_in(const Part& part) {
    const Node& node = scene_.nodes[part.node];
    const int mover = motion_.mover[part.node];
    if (deforms(scene_, node, *part.mesh)) return add_deforming(part);
    if (mover >= 0) {
      groups_[mover].push_back(part);
    } else {
      own(part, TriangleOwner::standing, out_.standing.triangles.size());
      append(geometry_, part, stop_, out_.standing);
    }
  }

  void own(const Part& part, std::int32_t object, std::size_t first) {
    for (std::size_t t = 0; t < part.mesh->triangles.size(); ++t)
      out_.owners[part.first_triangle + t] = {object, static_cast<std::uint32_t>(first + t)};
  }

  void add_deforming(const Part& part) {
    own(part, TriangleOwner::deforming, 0);
    for (std::size_t t = 0; t < part.mesh->triangles.size(); ++t)
      out_.deforming.push_back(static_cast<std::uint32_t>(part.first_triangle + t));
    const Node& node = scene_.nodes[part.node];
    const std::string& name = !part.mesh->name.empty() ? part.mesh->name : part.mesh->source;
    const std::string shown = !name.empty() ? name : fmt::format("node {} {}", part.node, node.name);
    auto& names = out_.deforming_names;
    if (std::find(names.begin(), names.end(), shown) == names.end()) names.push_back(shown);
  }

  /// From a node of the group to the object's space, by nodes that no clip moves: bits do not depend on the
  /// instant.
  dmat4 to_object(std::size_t node, const MovingObject& object) const {
    dmat4 matrix(1.0);
    for (; static_cast<int>(node) != object.node; node = static_cast<std::size_t>(scene_.nodes[node].parent))
      matrix = still_matrix(node) * matrix;
    return scaling(object.own_scale) * matrix;
  }
  /// Of a node that no clip moves; a channel may still hold it away from its rest.
  dmat4 still_matrix(std::size_t index) const {
    Node node = scene_.nodes[index];
    const NodePose& pose = geometry_.pose.nodes[index];
    node.translation = pose.translation, node.rotation = pose.rotation, node.scale = pose.scale;
    return local_matrix(node);
  }

  void add_object(int index, const std::vector<Part>& parts) {
    const auto node = static_cast<std::size_t>(index);
    const Node& at_rest = scene_.nodes[node];
    MovingObject object;
    object.node = index;
    object.name = at_rest.name;
    if (!at_rest.matrix)
      object.own_scale =
          proportions(motion_.resized[node] ? at_rest.scale : geometry_.pose.nodes[node].scale);
    place(geometry_.pose, object);
    object.scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(object.to_world))));
    place(geometry_.pose, object);
    std::size_t triangles = 0;
    std::vector<dmat4> to_objects;
    Hash source;  // equal ones give equal shapes
    for (const Part& part : parts) {
      own(part, static_cast<std::int32_t>(out_.objects.size()), triangles);
      triangles += part.mesh->triangles.size();
      to_objects.push_back(to_object(part.node, object));
      source.add(&scene_.nodes[part.node].mesh, sizeof(Node::mesh));
      source.add(&to_objects.back(), sizeof(dmat4));
      source.add(geometry_.casts_shadow.data() + part.first_triangle, part.mesh->triangles.size());
    }
    const auto [known, is_new] = by_source_.emplace(source.value(), 0);
    if (is_new) known->second = index_of(make_shape(parts, to_objects));
    object.shape = known->second;
    out_.objects.push_back(std::move(object));
  }

  ObjectShape make_shape(const std::vector<Part>& parts, const std::vector<dmat4>& to_objects) const {
    ObjectShape shape;
    for (std::size_t i = 0; i < parts.size(); ++i) append(geometry_, parts[i], to_objects[i], stop_, shape);
    finish(shape, stop_);
    return shape;
  }

  int index_of(ObjectShape shape) {
    const auto [found, is_new] = by_hash_.emplace(shape.hash, static_cast<int>(out_.shapes.size()));
    if (is_new) out_.shapes.push_back(std::move(shape));
    return found->second;
  }

  const Scene& scene_;
  const FrameGeometry& geometry_;
  const NodeMotion& motion_;
  const StopFlag* stop_;
  SceneObjects& out_;
  std::map<int, std::vector<Part>> groups_;
  std::unordered_map<std::uint64_t, int> by_source_, by_hash_;
};

}  // namespace

std::vector<glm::uvec3> casting_triangles(const ObjectShape& shape, const StopFlag* stop) {
  std::vector<glm::uvec3> triangles;
  triangles.reserve(shape.triangles.size());
  base::each_until_stopped(0, shape.triangles.size(), stop, [&](std::size_t t) {
    if (shape.casts[t]) triangles.push_back(shape.triangles[t]);
  });
  return triangles;
}

SceneObjects find_objects(const Scene& scene, const FrameGeometry& geometry, const StopFlag* stop) {
  SceneObjects objects;
  objects.motion = find_motion(scene);
  objects.signature = signature_of(scene, geometry, objects.motion);
  if (stop_requested(stop)) return objects;
  Finder(scene, geometry, objects.motion, stop, objects).run();
  return objects;
}

bool move_objects(const Scene& scene, const FrameGeometry& geometry, SceneObjects& objects) {
  if (objects.motion.mover.size() != scene.nodes.size()) return false;
  if (objects.owners.size() != geometry.triangles.size()) return false;
  if (signature_of(scene, geometry, objects.motion) != objects.signature) return false;
  for (MovingObject& object : objects.objects) place(geometry.pose, object);
  return true;
}

}  // namespace tenebra::ao
