// The triangles of a geometry as a scene of one mesh, which ambient occlusion asks for.
#pragma once

#include <cstdint>
#include <memory>

#include <tenebra/frame_geometry.h>
#include <tenebra/scene.h>
#include <tenebra/stop_flag.h>
#include "query/geometry_data.h"

namespace tenebra::query {

class GeometryScene {
public:
  /// Follows the geometry. False: `stop` was requested.
  bool follow(const std::shared_ptr<const GeometryData>& data, const StopFlag* stop);

  const Scene& scene() const { return scene_; }
  const FrameGeometry& geometry() const { return geometry_; }

private:
  bool rebuild(const StopFlag* stop);

  std::shared_ptr<const GeometryData> data_;
  std::uint64_t revision_ = 0;
  bool whole_ = false;  ///< what follows is made from the above
  Scene scene_;
  FrameGeometry geometry_;
};

}  // namespace tenebra::query
