// The triangles of a geometry, and after them stand-ins: small triangles that cast no shadow, one for each
// point that lies on none, so that it can be treated like any visible point. The same as a scene, for ambient
// occlusion, has the static triangles, and the stand-ins as a mesh that deforms, so that no tree holds them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include <tenebra/stop_flag.h>
#include "query/geometry_data.h"

namespace tenebra::query {

/// Where a stand-in lies: in the plane across a normal through its point, or a little behind, so that the
/// point is strictly before it.
enum class StandAt { point, behind };

class StandIns {
public:
  /// Follows the geometry, with room for `slots` stand-ins at least. False: `stop` was requested.
  bool follow(const std::shared_ptr<const GeometryData>& data, std::size_t slots, const StopFlag* stop);

  /// Slot `slot`'s triangle, counter-clockwise seen from where `normal` (not zero) points. Its size follows
  /// the point's coordinates, so that rounding its corners to float turns it by 2^-17 at most.
  void set(std::size_t slot, const glm::dvec3& point, const glm::dvec3& normal, StandAt at);
  std::uint32_t id(std::size_t slot) const {
    return static_cast<std::uint32_t>(data_->triangles.size() + slot);
  }

  const Scene& scene() const { return scene_; }
  const FrameGeometry& geometry() const { return geometry_; }

private:
  bool rebuild(const StopFlag* stop);

  std::shared_ptr<const GeometryData> data_;
  std::uint64_t revision_ = 0;
  std::size_t slots_ = 0;
  bool whole_ = false;  ///< what follows is made from the above
  Scene scene_;
  FrameGeometry geometry_;
};

}  // namespace tenebra::query
