#include "ao/shade/occluders.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "ao/surface/surface_rays.h"
#include "base/fail.h"
#include "base/sort_unique.h"

namespace tenebra::ao {
namespace {

using glm::dvec3;
using glm::vec3;

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
trees::RayBatch moved(const trees::RayBatch& rays, const glm::mat4x3& to_object) {
  trees::RayBatch out;
  for (int i = 0; i < trees::batch_size; ++i) {
    out.set(i, to_object * glm::vec4(rays.origin(i), 1.0f), to_object * glm::vec4(rays.direction(i), 0.0f));
  }
  return out;
}

/// The same for rays from one point, which is given in the space of the object.
trees::RayBatch turned(const trees::RayBatch& rays, const vec3& start, const glm::mat4x3& to_object) {
  trees::RayBatch out;
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

void Occluders::reset(const SceneObjects& objects) {
  std::unordered_map<std::uint64_t, Shape> old;
  for (Shape& shape : shapes_) old.emplace(shape.hash, std::move(shape));
  shapes_.clear();
  for (const ObjectShape& shape : objects.shapes) {
    const auto kept = old.find(shape.hash);
    if (kept != old.end()) {
      shapes_.push_back(std::move(kept->second));
    } else {
      shapes_.emplace_back().hash = shape.hash;
    }
  }
  standing_.reset();
  fields_.reset(objects.shapes);
}

void Occluders::begin_frame(const SceneObjects& objects, const FrameGeometry& geometry,
                            const AoConfig& config, double reach, std::uint64_t frame, const StopFlag* stop) {
  objects_ = &objects;
  geometry_ = &geometry;
  stop_ = stop;
  const FieldSettings settings{config.layout, config.positions, config.directions, config.bits};
  if (settings != settings_)
    for (Shape& shape : shapes_) shape.by_rays = false;
  settings_ = settings;
  trees_.folder = config.cache;
  fields_.begin_frame(objects.shapes, settings, config.cache, frame);
  kernels_ = ao_kernels(config.simd);
  reach_ = reach;
  standing_sphere_ = {dvec3(objects.standing.center), objects.standing.radius};
  deforming_.reset();
  moving_.reset();
  deforming_sphere_ = {};
  if (config.deforming && !objects.deforming.empty())
    deforming_sphere_ = sphere_around(geometry.positions, deforming_triangles(objects, geometry));
  placed_.assign(objects.objects.size(), {});
  by_x_.clear();
  largest_radius_ = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) place(i);
  std::sort(by_x_.begin(), by_x_.end(), [&](std::size_t a, std::size_t b) {
    const double x = placed_[a].sphere.centre.x, y = placed_[b].sphere.centre.x;
    return x != y ? x < y : a < b;
  });
}

void Occluders::place(std::size_t index) {
  const MovingObject& object = objects_->objects[index];
  const ObjectShape& shape = objects_->shapes[static_cast<std::size_t>(object.shape)];
  Placed& placed = placed_[index];
  placed.shape = object.shape;
  placed.visible = object.visible && shape.radius > 0;
  if (!placed.visible) return;
  placed.sphere = {dvec3(object.to_world * glm::dvec4(dvec3(shape.center), 1.0)),
                   shape.radius * object.largest_scale};
  placed.to_object = glm::mat4x3(object.to_object);
  if (const DisplacementField* field = fields_.find(object.shape))
    placed.instance = place_field(*field, casters(object.shape), object.to_world);
  by_x_.push_back(index);
  largest_radius_ = std::max(largest_radius_, placed.sphere.radius);
}

void Occluders::near(const math::Box<double>& box, std::vector<int>& out) const {
  out.clear();
  const auto first = std::partition_point(by_x_.begin(), by_x_.end(), [&](std::size_t i) {
    return placed_[i].sphere.centre.x < box.low.x - reach_ - largest_radius_;
  });
  for (auto at = first; at != by_x_.end(); ++at) {
    const Sphere& sphere = placed_[*at].sphere;
    if (sphere.centre.x > box.high.x + reach_ + largest_radius_) break;
    if (box.distance_to(sphere.centre) < sphere.radius + reach_) out.push_back(static_cast<int>(*at));
  }
  std::sort(out.begin(), out.end());
  const auto add = [&](const Sphere& sphere, int occluder) {
    if (sphere.radius > 0 && box.distance_to(sphere.centre) < sphere.radius + reach_) out.push_back(occluder);
  };
  add(standing_sphere_, standing);
  add(deforming_sphere_, deforming);
}

const Sphere& Occluders::sphere(int occluder) const {
  if (occluder == standing) return standing_sphere_;
  if (occluder == deforming) return deforming_sphere_;
  if (occluder == moving) return moving_sphere_;
  return placed_[static_cast<std::size_t>(occluder)].sphere;
}

bool Occluders::reaches(int occluder, std::span<const Receiver> receivers, std::uint8_t* out,
                        Itself itself) const {
  const bool hides_itself = itself == Itself::counts || occluder == deforming || occluder == moving ||
                            (occluder >= 0 && !objects_->objects[static_cast<std::size_t>(occluder)].rigid);
  const Sphere around = sphere(occluder);
  const double farthest = around.radius + reach_;
  bool any = false;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    const Receiver& receiver = receivers[i];
    const dvec3 away = around.centre - receiver.position;
    const bool reached = (hides_itself || occluder != receiver.owner.object) &&
                         glm::dot(away, away) < farthest * farthest &&
                         glm::dot(away, dvec3(receiver.normal)) > -around.radius &&
                         glm::dot(away, dvec3(receiver.face)) > -around.radius;
    out[i] = reached ? 1 : 0;
    any |= reached;
  }
  return any;
}

bool Occluders::ready(int occluder) const {
  if (occluder == standing) return standing_.has_value();
  if (occluder == deforming) return deforming_.has_value();
  const Placed& placed = placed_[static_cast<std::size_t>(occluder)];
  return placed.instance || shapes_[static_cast<std::size_t>(placed.shape)].by_rays ||
         fields_.refused(placed.shape);
}

Expected<void> Occluders::build(std::span<const int> missing, const AoProgress& progress) {
  load_fields(missing);
  for (const int occluder : missing) {
    if (occluder == standing) {
      casters(standing);
    } else if (occluder == deforming) {
      deforming_ = tree_of_deforming();
    } else if (auto built = build_object(static_cast<std::size_t>(occluder), progress); !built) {
      return built;
    }
    if (stop_requested(stop_)) return base::fail("stopped");
  }
  return {};
}

std::optional<trees::TriangleBvh> Occluders::tree_of_deforming() const {
  return trees::build_triangle_bvh(geometry_->positions, deforming_triangles(*objects_, *geometry_), stop_);
}

const trees::TriangleBvh* Occluders::casters(int index) {
  auto& tree = index < 0 ? standing_ : shapes_[static_cast<std::size_t>(index)].casters;
  const ObjectShape& shape =
      index < 0 ? objects_->standing : objects_->shapes[static_cast<std::size_t>(index)];
  if (tree) return &*tree;
  const std::vector<glm::uvec3> triangles = casting_triangles(shape, stop_);
  if (!stop_requested(stop_)) tree = trees_.make(shape.positions, triangles, stop_);
  return tree ? &*tree : nullptr;
}

std::vector<std::string> Occluders::take_notes() {
  std::vector<std::string> notes = fields_.take_notes();
  for (std::string& note : std::exchange(trees_.notes, {})) notes.push_back(std::move(note));
  return notes;
}

/// Not where triangles are few, or where the shape was found to be placed flat.
bool Occluders::wants_field(int number, const trees::TriangleBvh& casters) {
  Shape& shape = shapes_[static_cast<std::size_t>(number)];
  shape.by_rays |= casters.triangles <= few_triangles;
  return !shape.by_rays;
}

void Occluders::load_fields(std::span<const int> occluders) {
  std::vector<int> shapes;
  for (const int occluder : occluders) {
    if (occluder < 0) continue;
    const int shape = placed_[static_cast<std::size_t>(occluder)].shape;
    const trees::TriangleBvh* tree = casters(shape);
    if (tree == nullptr) return;
    if (wants_field(shape, *tree)) shapes.push_back(shape);
  }
  base::sort_unique(shapes);
  fields_.load(shapes);
}

Expected<void> Occluders::build_object(std::size_t index, const AoProgress& progress) {
  Placed& placed = placed_[index];
  const trees::TriangleBvh* tree = casters(placed.shape);
  if (tree == nullptr) return base::fail("stopped");
  if (!wants_field(placed.shape, *tree)) return {};
  const FieldProgress report = [&](double done) {
    if (progress) progress("displacement fields", done);
  };
  const auto field = fields_.make(placed.shape, *tree, report, stop_);
  if (!field) return tl::unexpected(field.error());
  if (*field == nullptr) return {};  // no room: by rays
  placed.instance = place_field(**field, tree, objects_->objects[index].to_world);
  if (!placed.instance) shapes_[static_cast<std::size_t>(placed.shape)].by_rays = true;
  return {};
}

void Occluders::use(int occluder) {
  if (occluder >= 0) fields_.use(placed_[static_cast<std::size_t>(occluder)].shape);
}

void Occluders::drop_field(int shape) {
  fields_.drop(shape);
  for (Placed& placed : placed_)
    if (placed.shape == shape) placed.instance.reset();
}

void Occluders::meet(int occluder, std::int32_t owner, std::span<const trees::RayBatch> rays,
                     float* distances, OccluderCounts& counts) const {
  const auto each = [&](const auto& hit) {
    for (std::size_t b = 0; b < rays.size(); ++b) hit(rays[b], distances + b * trees::batch_size);
  };
  const std::uint64_t all = rays.size() * trees::batch_size;
  if (occluder < 0) {
    const trees::TriangleBvh& tree = occluder == standing ? *standing_ : *deforming_;
    counts.rays_cast += all;
    return each([&](const trees::RayBatch& batch, float* out) {
      kernels_.cast(tree, {&batch, 1}, out, nullptr);
    });
  }
  const Placed& placed = placed_[static_cast<std::size_t>(occluder)];
  if (placed.instance && occluder != owner) {
    counts.lookups += all;
    counts.rays_cast +=
        static_cast<std::uint64_t>(kernels_.field.nearest_hits(*placed.instance, rays, distances));
    return;
  }
  const trees::TriangleBvh& tree = *shapes_[static_cast<std::size_t>(placed.shape)].casters;
  counts.rays_cast += all;
  each([&](const trees::RayBatch& batch, float* out) {
    const trees::RayBatch there = moved(batch, placed.to_object);
    kernels_.cast(tree, {&there, 1}, out, nullptr);
  });
}

bool Occluders::gather_moving(std::span<const int> occluders) {
  std::vector<bool> chosen(objects_->objects.size());
  bool deforms = false;
  for (const int occluder : occluders) {
    if (occluder >= 0) chosen[static_cast<std::size_t>(occluder)] = true;
    deforms |= occluder == deforming;
  }
  std::vector<glm::uvec3> triangles;
  for (std::size_t id = 0; id < objects_->owners.size() && triangles.size() <= most_gathered; ++id) {
    const std::int32_t object = objects_->owners[id].object;
    const bool wanted = object >= 0 ? chosen[static_cast<std::size_t>(object)]
                                    : object == TriangleOwner::deforming && deforms;
    const glm::uvec3 t = geometry_->triangles[id];
    if (wanted && geometry_->casts_shadow[id] && !(t.x == t.y && t.y == t.z)) triangles.push_back(t);
  }
  if (triangles.empty() || triangles.size() > most_gathered) return false;
  moving_ = trees::build_triangle_bvh(geometry_->positions, triangles, stop_);
  moving_sphere_ = sphere_around(geometry_->positions, triangles);
  return moving_.has_value();
}

const trees::TriangleBvh& Occluders::world_tree(int occluder) const {
  return occluder == standing ? *standing_ : occluder == deforming ? *deforming_ : *moving_;
}

void Occluders::build_trees(std::span<const int> occluders) {
  for (const int occluder : occluders) {
    if (stop_requested(stop_)) return;
    if (occluder == deforming) {
      if (!deforming_) deforming_ = tree_of_deforming();
    } else {
      const int shape = occluder == standing ? -1 : placed_[static_cast<std::size_t>(occluder)].shape;
      const trees::TriangleBvh* tree = casters(shape);
      if (shape < 0 || tree == nullptr) continue;
      Shape& kept = shapes_[static_cast<std::size_t>(shape)];
      kept.lift = surface_lift(largest_coordinate(objects_->shapes[static_cast<std::size_t>(shape)]));
      kept.box = tree->box();
    }
  }
}

void Occluders::meet_triangles(int occluder, const Receiver& receiver, const dvec3& origin,
                               std::span<const trees::RayBatch> rays, float* distances,
                               OccluderCounts& counts) const {
  if (occluder < 0) {
    counts.rays_cast += rays.size() * trees::batch_size;
    return kernels_.cast(world_tree(occluder), rays, distances, nullptr);
  }
  const MovingObject& object = objects_->objects[static_cast<std::size_t>(occluder)];
  const Placed& placed = placed_[static_cast<std::size_t>(occluder)];
  const Shape& shape = shapes_[static_cast<std::size_t>(placed.shape)];
  // Which of two triangles in one plane is seen was decided in the world, with its rounding.
  const auto in_world = static_cast<float>(glm::length(origin - receiver.position) / object.scale);
  const vec3 start = occluder == receiver.owner.object
                         ? start_on(objects_->shapes[static_cast<std::size_t>(placed.shape)],
                                    std::max(shape.lift, in_world), receiver)
                         : vec3(object.to_object * glm::dvec4(origin, 1.0));
  const double away = double{shape.box.distance_to(start)} * object.largest_scale;
  if (away > reach_ * (1 + 0x1p-18)) return;
  counts.rays_cast += rays.size() * trees::batch_size;
  trees::RayBatch there[trees::fans_at_once];
  for (std::size_t first = 0; first < rays.size(); first += trees::fans_at_once) {
    const std::size_t count = std::min(trees::fans_at_once, rays.size() - first);
    for (std::size_t b = 0; b < count; ++b) there[b] = turned(rays[first + b], start, placed.to_object);
    kernels_.cast(*shape.casters, {there, count}, distances + first * trees::batch_size, nullptr);
  }
}

}  // namespace tenebra::ao
