#include "ao/receivers.h"

#include <cmath>

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;

struct Triangle {
  dvec3 v[3];
};

Triangle corners(const std::vector<vec3>& positions, const glm::uvec3& t) {
  return {{dvec3(positions[t.x]), dvec3(positions[t.y]), dvec3(positions[t.z])}};
}

}  // namespace

void ReceiverMaker::take(std::uint32_t triangle) {
  triangle_ = triangle;
  owner_ = objects_.owners[triangle];
  to_object_ = nullptr;
  Triangle t;
  if (owner_.object == TriangleOwner::deforming) {
    t = corners(geometry_.positions, geometry_.triangles[triangle]);
  } else if (owner_.object == TriangleOwner::standing) {
    t = corners(objects_.standing.positions, objects_.standing.triangles[owner_.triangle]);
  } else {
    const MovingObject& object = objects_.objects[static_cast<std::size_t>(owner_.object)];
    const ObjectShape& shape = objects_.shapes[static_cast<std::size_t>(object.shape)];
    to_object_ = &object.to_object;
    t = corners(shape.positions, shape.triangles[owner_.triangle]);
  }
  a_ = t.v[0];
  const dvec3 e1 = t.v[1] - a_, e2 = t.v[2] - a_, n = glm::cross(e1, e2);
  const double area2 = glm::dot(n, n);
  face_ = vec3(0.0f);
  if (!(area2 > 0) || !std::isfinite(area2)) return;
  du_ = glm::cross(e2, n) / area2;
  dv_ = glm::cross(n, e1) / area2;
  dvec3 world = n;
  if (to_object_ != nullptr)  // the transpose of the inverse: right for any transform
    world = glm::transpose(glm::dmat3(*to_object_)) * n;
  face_ = vec3(glm::normalize(world));
}

bool ReceiverMaker::make(std::uint32_t triangle, const dvec3& position, const vec3& normal, Receiver& out) {
  if (triangle >= objects_.owners.size()) return false;
  if (triangle != triangle_) take(triangle);
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

}  // namespace tenebra
