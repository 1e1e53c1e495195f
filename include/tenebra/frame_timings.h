// The time of one frame, stage by stage: a row of the log, a set of slices of the trace. The names are the
// same in the CSV, the window and the documentation.
#pragma once

namespace tenebra {

/// Wall-clock milliseconds of each stage, summed over the lights. OpenGL has finished before and after each.
struct FrameTimings {
  double evaluate_ms = 0;    ///< Scene -> FrameGeometry
  double raster_ms = 0;      ///< triangles to OpenGL, and the G-buffer
  double readback_ms = 0;    ///< triangle ids (or depth) to the CPU
  double points_ms = 0;      ///< visible points from triangle ids, and their tiles for variant Tiles
  double rays_ms = 0;        ///< shadow rays and the planes of triangles; Tiles: the trees over rays
  double sort_ms = 0;        ///< keys and sort (0 for unsorted variants and Tiles)
  double build_ms = 0;       ///< the cone tree; Tiles: the clusters of triangles
  double traverse_ms = 0;    ///< triangles through the tree of rays, decisions included
  double writeback_ms = 0;   ///< masks to the pixel grid and into the result
  double composite_ms = 0;   ///< shading: all lights, ambient light and encoding, one pass
  double shaft_ms = 0;       ///< soft: groups of points and the occluders in their shafts
  double init_ms = 0;        ///< soft: preparing occluders for the solvers (*)
  double query_ms = 0;       ///< soft: visible part of the light from each point (*)
  double irradiance_ms = 0;  ///< soft: integrals over the visible parts (*)
                             ///< (*) groups run in parallel: the mean of the threads' times
  double ao_build_ms = 0;    ///< ao: fields, bakes and caches built in this frame
  double ao_ms = 0;          ///< ao: look-ups (or rays), all points
  double tint_ms = 0;        ///< how much of the lights see-through surfaces let pass
  double layer_ms = 0;  ///< the nearest see-through surfaces: their shadows and their share of the picture
  double antialias_ms = 0;  ///< all work on further samples of pixels that need them
  double total_ms = 0;      ///< the whole frame
};

/// Adds the stages of one light's shadows, or of a part of them. Leaves the frame's other stages alone.
inline void add_shadow_stages(FrameTimings& to, const FrameTimings& from) {
  to.rays_ms += from.rays_ms;
  to.sort_ms += from.sort_ms;
  to.build_ms += from.build_ms;
  to.traverse_ms += from.traverse_ms;
  to.writeback_ms += from.writeback_ms;
  to.shaft_ms += from.shaft_ms;
  to.init_ms += from.init_ms;
  to.query_ms += from.query_ms;
  to.irradiance_ms += from.irradiance_ms;
}

}  // namespace tenebra
