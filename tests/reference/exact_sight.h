// What the ray through a pixel's centre meets, in rational numbers: the oracle of visibility.
#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <optional>

#include <tenebra/frame_geometry.h>

namespace tenebra::test {

/// Rays of a view, as ViewRays defines them.
class ExactSight {
public:
  explicit ExactSight(const ViewRays& view) : view_(view) {}

  /// Ray parameter t where the ray through the centre of pixel (x, y) meets the closed triangle, before the
  /// eye in perspective views; nothing: nowhere, or the ray runs within its plane.
  std::optional<mpq_class> meeting(const glm::vec3 corners[3], int x, int y) const;
  /// t of the near plane.
  double near_t() const;

private:
  const ViewRays& view_;
};

}  // namespace tenebra::test
