#include "ao/casters/casters.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace tenebra::ao {
namespace {

using glm::dvec3;
using glm::vec3;
using trees::RayBatch;
using trees::TriangleBvh;

std::vector<glm::uvec3> deforming_triangles(const SceneObjects& objects, const FrameGeometry& geometry) {
  std::vector<glm::uvec3> triangles;
  for (const std::uint32_t id : objects.deforming) {
    const glm::uvec3 t = geometry.triangles[id];
    if (geometry.casts_shadow[id] && !(t.x == t.y && t.y == t.z)) triangles.push_back(t);
  }
  return triangles;
}

/// About the middle of their box.
Sphere sphere_around(std::span<const vec3> positions, std::span<const glm::uvec3> triangles) {
  math::Box<double> box;
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) box.add(dvec3(positions[t[k]]));
  return {box.centre(), 0.5 * box.diagonal()};
}

/// Sixteen rays moved into the space of an object; distances along them stay the same.
RayBatch moved(const RayBatch& rays, const glm::mat4x3& to_object) {
  RayBatch out;
  for (int i = 0; i < trees::batch_size; ++i) {
    out.set(i, to_object * glm::vec4(rays.origin(i), 1.0f), to_object * glm::vec4(rays.direction(i), 0.0f));
  }
  return out;
}

/// The same for rays from one point, which is given in the space of the object.
RayBatch turned(const RayBatch& rays, const vec3& start, const glm::mat4x3& to_object) {
  RayBatch out;
  for (int i = 0; i < trees::batch_size; ++i)
    out.set(i, start, to_object * glm::vec4(rays.direction(i), 0.0f));
  return out;
}

/// The receiver's place on its triangle in the space of its object, lifted as samples of surfaces are: not
/// rounded to the world and back.
vec3 start_on(const ObjectShape& shape, float lift, const Receiver& receiver) {
  const glm::uvec3 t = shape.triangles[receiver.owner.triangle];
  const double v = receiver.v, w = receiver.w;
  const dvec3 p = (1 - v - w) * dvec3(shape.positions[t.x]) + v * dvec3(shape.positions[t.y]) +
                  w * dvec3(shape.positions[t.z]);
  const vec3 face = face_normal(shape, receiver.owner.triangle);
  return vec3(p + double{receiver.front ? lift : -lift} * dvec3(face));
}

}  // namespace

void Casters::reset(const SceneObjects& objects) {
  std::unordered_map<std::uint64_t, ShapeTree> old;
  for (ShapeTree& kept : shapes_) old.emplace(kept.hash, std::move(kept));
  shapes_.clear();
  for (const ObjectShape& shape : objects.shapes) {
    const auto found = old.find(shape.hash);
    ShapeTree& kept = shapes_.emplace_back(found != old.end() ? std::move(found->second) : ShapeTree{});
    kept.hash = shape.hash;
  }
  standing_ = {};
  standing_lift_ = surface_lift(largest_coordinate(objects.standing));
}

void Casters::begin_frame(const SceneObjects& objects, const FrameGeometry& geometry,
                          const CasterSettings& settings, const RayKernels& kernels, const StopFlag* stop) {
  objects_ = &objects;
  geometry_ = &geometry;
  stop_ = stop;
  kernels_ = kernels;
  reach_ = settings.reach;
  files_.folder = settings.folder;
  deforming_.reset();
  gathered_.reset();
  placed_.assign(index(gathered()) + 1, {});
  by_x_.clear();
  largest_radius_ = 0;
  for (std::size_t i = 0; i < objects.objects.size(); ++i) place_object(i);
  std::sort(by_x_.begin(), by_x_.end(), [&](std::size_t a, std::size_t b) {
    const double x = placed_[a].sphere.centre.x, y = placed_[b].sphere.centre.x;
    return x != y ? x < y : a < b;
  });
  placed_[index(standing())].sphere = {dvec3(objects.standing.center), objects.standing.radius};
  if (settings.deforming && !objects.deforming.empty())
    placed_[index(deforming())].sphere =
        sphere_around(geometry.positions, deforming_triangles(objects, geometry));
}

void Casters::place_object(std::size_t number) {
  const MovingObject& object = objects_->objects[number];
  const ObjectShape& shape = objects_->shapes[index(object.shape)];
  Placed& placed = placed_[number];
  placed.shape = object.shape;
  if (!object.visible || !(shape.radius > 0)) return;
  placed.sphere = {dvec3(object.to_world * glm::dvec4(dvec3(shape.center), 1.0)),
                   shape.radius * object.largest_scale};
  placed.to_object = glm::mat4x3(object.to_object);
  by_x_.push_back(number);
  largest_radius_ = std::max(largest_radius_, placed.sphere.radius);
}

void Casters::near(const math::Box<double>& box, std::vector<int>& out) const {
  out.clear();
  const auto first = std::partition_point(by_x_.begin(), by_x_.end(), [&](std::size_t i) {
    return placed_[i].sphere.centre.x < box.low.x - reach_ - largest_radius_;
  });
  const auto in_reach = [&](const Sphere& sphere) {
    return box.distance_to(sphere.centre) < sphere.radius + reach_;
  };
  for (auto at = first; at != by_x_.end(); ++at) {
    const Sphere& sphere = placed_[*at].sphere;
    if (sphere.centre.x > box.high.x + reach_ + largest_radius_) break;
    if (in_reach(sphere)) out.push_back(static_cast<int>(*at));
  }
  std::sort(out.begin(), out.end());
  for (const int caster : {standing(), deforming()}) {
    const Sphere& sphere = placed_[index(caster)].sphere;
    if (sphere.radius > 0 && in_reach(sphere)) out.push_back(caster);
  }
}

bool Casters::reaches(int caster, std::span<const Receiver> receivers, Itself itself,
                      std::uint8_t* out) const {
  const Sphere around = placed_[index(caster)].sphere;
  const double farthest = around.radius + reach_;
  bool any = false;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Receiver& receiver = receivers[i];
    const dvec3 away = around.centre - receiver.position;
    const bool reached = (itself == Itself::counts || caster != of(receiver.owner)) &&
                         glm::dot(away, away) < farthest * farthest &&
                         glm::dot(away, dvec3(receiver.normal)) > -around.radius &&
                         glm::dot(away, dvec3(receiver.face)) > -around.radius;
    out[i] = reached ? 1 : 0;
    any |= reached;
  }
  return any;
}

bool Casters::gather(std::span<const int> casters) {
  std::vector<bool> chosen(index(gathered()));
  for (const int caster : casters) chosen[index(caster)] = caster != standing();
  std::vector<glm::uvec3> triangles;
  for (std::size_t id = 0; id < objects_->owners.size() && triangles.size() <= most_gathered; ++id) {
    const glm::uvec3 t = geometry_->triangles[id];
    if (chosen[index(of(objects_->owners[id]))] && geometry_->casts_shadow[id] && !(t.x == t.y && t.y == t.z))
      triangles.push_back(t);
  }
  if (triangles.empty() || triangles.size() > most_gathered) return false;
  gathered_ = trees::build_triangle_bvh(geometry_->positions, triangles, stop_);
  placed_[index(gathered())].sphere = sphere_around(geometry_->positions, triangles);
  return gathered_.has_value();
}

void Casters::build(std::span<const int> casters) {
  for (const int caster : casters) {
    if (stop_requested(stop_)) return;
    if (is_object(caster)) {
      shape_tree(placed_[index(caster)].shape);
    } else if (caster == standing()) {
      standing_tree();
    } else if (caster == deforming() && !deforming_) {
      deforming_ =
          trees::build_triangle_bvh(geometry_->positions, deforming_triangles(*objects_, *geometry_), stop_);
    }
  }
}

const TriangleBvh* Casters::tree(int caster) const {
  const auto& tree = is_object(caster)       ? shape_of(caster).tree
                     : caster == standing()  ? standing_.tree
                     : caster == deforming() ? deforming_
                                             : gathered_;
  return tree ? &*tree : nullptr;
}

const TriangleBvh* Casters::shape_tree(int shape) {
  return tree_of(shapes_[index(shape)], objects_->shapes[index(shape)]);
}

const TriangleBvh* Casters::standing_tree() {
  return tree_of(standing_, objects_->standing);
}

const TriangleBvh* Casters::tree_of(ShapeTree& kept, const ObjectShape& shape) {
  if (kept.tree) return &*kept.tree;
  const std::vector<glm::uvec3> triangles = casting_triangles(shape, stop_);
  if (!stop_requested(stop_)) kept.tree = files_.make(shape.positions, triangles, stop_);
  if (!kept.tree) return nullptr;
  kept.lift = surface_lift(largest_coordinate(shape));
  kept.box = kept.tree->box();
  return &*kept.tree;
}

dvec3 Casters::start_of(const Receiver& receiver) const {
  const dvec3 size = glm::abs(receiver.position);
  const double lift = std::max(standing_lift_, surface_lift(std::max({size.x, size.y, size.z})));
  return receiver.position + lift * dvec3(receiver.face);
}

void Casters::meet(int caster, const Receiver& receiver, const dvec3& origin, std::span<const RayBatch> rays,
                   float* distances, std::uint64_t& rays_cast) const {
  if (!is_object(caster)) {
    rays_cast += rays.size() * trees::batch_size;
    return kernels_.cast(*tree(caster), rays, distances, nullptr);
  }
  const MovingObject& object = objects_->objects[index(caster)];
  const Placed& placed = placed_[index(caster)];
  const ShapeTree& shape = shape_of(caster);
  // Which of two triangles in one plane is seen was decided in the world, with its rounding.
  const auto in_world = static_cast<float>(glm::length(origin - receiver.position) / object.scale);
  const vec3 start = caster == receiver.owner.object ? start_on(objects_->shapes[index(placed.shape)],
                                                                std::max(shape.lift, in_world), receiver)
                                                     : vec3(object.to_object * glm::dvec4(origin, 1.0));
  const double away = double{shape.box.distance_to(start)} * object.largest_scale;
  if (away > reach_ * (1 + 0x1p-18)) return;
  rays_cast += rays.size() * trees::batch_size;
  RayBatch there[trees::fans_at_once];
  for (std::size_t first = 0; first < rays.size(); first += trees::fans_at_once) {
    const std::size_t count = std::min(trees::fans_at_once, rays.size() - first);
    for (std::size_t b = 0; b < count; ++b) there[b] = turned(rays[first + b], start, placed.to_object);
    kernels_.cast(*shape.tree, {there, count}, distances + first * trees::batch_size, nullptr);
  }
}

void Casters::meet_each(int caster, std::span<const RayBatch> rays, float* distances,
                        std::uint64_t& rays_cast) const {
  const TriangleBvh& met = *tree(caster);
  rays_cast += rays.size() * trees::batch_size;
  for (std::size_t b = 0; b < rays.size(); ++b) {
    RayBatch there;
    if (is_object(caster)) there = moved(rays[b], placed_[index(caster)].to_object);
    kernels_.cast(met, {is_object(caster) ? &there : &rays[b], 1}, distances + b * trees::batch_size,
                  nullptr);
  }
}

}  // namespace tenebra::ao
