// What one frame cost: stage times and counts. One row of the log, one set of slices of the trace; the same
// names in the CSV, the user interface and the documentation.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tenebra {

/// Wall-clock milliseconds a stage (steady clock, GL finished before and after), summed over the lights.
struct FrameTimings {
  double evaluate_ms = 0;   ///< Scene -> FrameGeometry
  double raster_ms = 0;     ///< G-buffer and light buffers
  double readback_ms = 0;   ///< triangle ids (or depth) to the CPU
  double points_ms = 0;     ///< visible points from triangle ids
  double rays_ms = 0;       ///< shadow rays of the pixels that the light reaches, triangle planes
  double sort_ms = 0;       ///< keys and sort (0 for unsorted variants)
  double build_ms = 0;      ///< the cone tree
  double traverse_ms = 0;   ///< triangles through the cone tree, decisions included
  double writeback_ms = 0;  ///< mask to the pixel grid and to OpenGL
  double composite_ms = 0;  ///< final picture and its read-back
  double total_ms = 0;      ///< the whole frame
};

/// Work counted by the tracer of shadow rays, summed over the lights. Counts do not jitter.
struct TraceStats {
  std::uint64_t rays = 0;            ///< shadow rays traced: visible points that the light can reach
  std::uint64_t triangles = 0;       ///< casting triangles of the frame (not summed over the lights)
  std::uint64_t nodes = 0;           ///< node/triangle tests
  std::uint64_t leaf_tests = 0;      ///< ray/triangle tests
  std::uint64_t early_accepts = 0;   ///< nodes found covered by one triangle
  std::uint64_t float_unknown = 0;   ///< ray/triangle pairs that the float filter left open and that mattered
  std::uint64_t double_unknown = 0;  ///< of these, pairs that double precision left open: decided exactly
  std::uint64_t shadowed_pixels = 0;       ///< rays found blocked
  std::uint64_t lit_pixels = 0;            ///< rays found free
  std::uint64_t degenerate_triangles = 0;  ///< zero area or edge-on to the light: they block nothing
  std::uint64_t tree_bytes = 0;            ///< memory of the cone tree, largest of the lights
};

/// Adds the work of another light, or of another part of one (triangles, tree_bytes: the larger).
inline TraceStats& operator+=(TraceStats& to, const TraceStats& from) {
  to.rays += from.rays;
  to.triangles = std::max(to.triangles, from.triangles);
  to.nodes += from.nodes;
  to.leaf_tests += from.leaf_tests;
  to.early_accepts += from.early_accepts;
  to.float_unknown += from.float_unknown;
  to.double_unknown += from.double_unknown;
  to.shadowed_pixels += from.shadowed_pixels;
  to.lit_pixels += from.lit_pixels;
  to.degenerate_triangles += from.degenerate_triangles;
  to.tree_bytes = std::max(to.tree_bytes, from.tree_bytes);
  return to;
}

}  // namespace tenebra
