#include "ao/receivers/receivers.h"

#include <cmath>

namespace tenebra::ao {

using glm::dvec3;
using glm::vec3;

void ReceiverMaker::fetch(std::span<const std::uint32_t> triangles) {
  fetched_count_ = next_ = 0;
  std::uint32_t last = triangle_;
  for (const std::uint32_t id : triangles) {
    if (id == last || id >= objects_.owners.size()) continue;
    last = id;
    fetched_[fetched_count_++].id = id;
  }
  // One loop for each step of indirection: no load waits for that of another triangle.
  for (Fetched& f : fetched()) f.owner = objects_.owners[f.id];
  for (Fetched& f : fetched()) look_up(f);
  for (Fetched& f : fetched())
    for (int k = 0; k < 3; ++k) f.at[k] = (*f.positions)[f.corners[k]];
}

void ReceiverMaker::look_up(Fetched& f) const {
  if (f.owner.object == TriangleOwner::deforming) {
    f.positions = &geometry_.positions;
    f.corners = geometry_.triangles[f.id];
    return;
  }
  const ObjectShape* shape = &objects_.standing;
  if (f.owner.object >= 0) {
    const int number = objects_.objects[static_cast<std::size_t>(f.owner.object)].shape;
    shape = &objects_.shapes[static_cast<std::size_t>(number)];
  }
  f.positions = &shape->positions;
  f.corners = shape->triangles[f.owner.triangle];
}

void ReceiverMaker::take(const Fetched& triangle) {
  triangle_ = triangle.id;
  owner_ = triangle.owner;
  to_object_ =
      owner_.object < 0 ? nullptr : &objects_.objects[static_cast<std::size_t>(owner_.object)].to_object;
  a_ = triangle.at[0];
  const dvec3 e1 = dvec3(triangle.at[1]) - a_, e2 = dvec3(triangle.at[2]) - a_, n = glm::cross(e1, e2);
  const double area2 = glm::dot(n, n);
  face_ = vec3(0.0f);
  if (!(area2 > 0) || !std::isfinite(area2)) return;
  const double scale = 1 / area2;
  du_ = scale * glm::cross(e2, n);
  dv_ = scale * glm::cross(n, e1);
  dvec3 world = n;
  if (to_object_ != nullptr)  // the transpose of the inverse: right for any transform
    world = glm::transpose(glm::dmat3(*to_object_)) * n;
  face_ = vec3(glm::normalize(world));
}

bool ReceiverMaker::make_free(const dvec3& position, const vec3& normal, Receiver& out) {
  const float square = glm::dot(normal, normal);
  if (!(square > 0.25f && square < 4.0f) || !std::isfinite(position.x + position.y + position.z))
    return false;
  out.position = out.local = position;
  out.normal = normal;
  out.face = glm::normalize(normal);
  out.owner = {TriangleOwner::deforming, 0};
  out.v = out.w = 0;
  out.front = true;
  return true;
}

bool ReceiverMaker::make(std::uint32_t triangle, const dvec3& position, const vec3& normal, Receiver& out) {
  if (triangle == free_point) return make_free(position, normal, out);
  if (triangle >= objects_.owners.size()) return false;
  if (triangle != triangle_) {
    if (next_ == fetched_count_ || fetched_[next_].id != triangle) fetch({&triangle, 1});
    take(fetched_[next_++]);
  }
  const float square = glm::dot(normal, normal);
  if (face_ == vec3(0.0f) || !(square > 0.25f && square < 4.0f)) return false;
  if (!std::isfinite(position.x + position.y + position.z)) return false;
  out.position = position;
  out.local = to_object_ != nullptr ? dvec3(*to_object_ * glm::dvec4(position, 1.0)) : position;
  if (!std::isfinite(out.local.x + out.local.y + out.local.z)) return false;
  out.normal = normal;
  out.front = glm::dot(face_, normal) >= 0;
  out.face = out.front ? face_ : -face_;
  out.owner = owner_;
  out.v = static_cast<float>(glm::dot(du_, out.local - a_));
  out.w = static_cast<float>(glm::dot(dv_, out.local - a_));
  return true;
}

}  // namespace tenebra::ao
