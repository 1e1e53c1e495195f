// A frame being drawn: what all of its stages read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <tenebra/tint.h>
#include "render/frame_lights.h"
#include "render/renderer.h"
#include "shade/environment.h"
#include "shade/surfaces.h"

namespace tenebra::render {

/// What the frames of one scene share.
struct DrawnScene {
  Scene scene;  ///< its lights, materials and nodes; of meshes no more than their triangles
  shade::SurfaceTable surfaces;
  SurfaceCoordinates coordinates;  ///< of its vertices, if something is see-through
  std::optional<shade::Environment> environment{};
};

/// Refers to data that lives until the frame ends.
struct Frame {
  const DrawnScene& scene;
  const FrameInput& input;  ///< its see-through surfaces cast as the settings say
  const RenderSettings& settings;
  std::span<const DrawnLight> lights;
  std::uint64_t number = 1;  ///< which of the renderer's frames; not 0
  const StopFlag* stop = nullptr;

  bool has_shadows() const { return settings.shadows != ShadowMode::none && !lights.empty(); }
  bool has_occlusion() const { return settings.ao.mode != AoMode::none; }
  bool has_areas() const { return render::has_areas(lights); }
  bool has_glass() const { return !input.geometry.see_through.empty(); }
  bool lifts_points() const { return render::lifts_points(settings); }

  TriangleView triangles() const { return triangle_view(input.geometry); }
  /// With the normals that points are lifted by.
  TriangleView smooth_triangles() const {
    TriangleView triangles = triangle_view(input.geometry);
    triangles.normals = input.geometry.normals;
    return triangles;
  }
  SeeThroughSurfaces see_through() const {
    return see_through_surfaces(scene.scene, input.geometry, scene.coordinates);
  }
};

}  // namespace tenebra::render
