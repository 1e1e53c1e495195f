// What one frame cost: stage times and counts. One row of the log, one set of slices of the trace; the same
// names in the CSV, the user interface and the documentation.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tenebra {

/// Wall-clock milliseconds a stage (steady clock, GL finished before and after), summed over the lights.
struct FrameTimings {
  double evaluate_ms = 0;  ///< Scene -> FrameGeometry
  double raster_ms = 0;    ///< G-buffer and light buffers
  double readback_ms = 0;  ///< triangle ids (or depth) to the CPU
  double points_ms = 0;    ///< visible points from triangle ids, and the tiles that variant Tiles reads
  double rays_ms = 0;      ///< rays of the pixels that the light reaches, triangle planes; Tiles: their trees
  double sort_ms = 0;      ///< keys and sort (0 for unsorted variants and Tiles)
  double build_ms = 0;     ///< the cone tree; Tiles: the clusters of triangles
  double traverse_ms = 0;  ///< triangles through the tree of rays, decisions included
  double writeback_ms = 0;   ///< mask to the pixel grid and to OpenGL
  double composite_ms = 0;   ///< final picture and its read-back
  double shaft_ms = 0;       ///< soft: groups of points and the occluders in their shafts
  double init_ms = 0;        ///< soft: occluders made ready for the solvers (*)
  double query_ms = 0;       ///< soft: visible part of the light from each point (*)
  double irradiance_ms = 0;  ///< soft: integrals over the visible parts (*)
                             ///< (*) groups run in parallel: the threads' times, summed, over their number
  double ao_build_ms = 0;    ///< ao: fields, bakes and caches built in this frame
  double ao_ms = 0;          ///< ao: look-ups (or rays), all points
  double total_ms = 0;       ///< the whole frame
};

/// Adds the stages of one light's shadows, or of a part of them; the frame's other stages are left alone.
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
  std::uint64_t degenerate_triangles = 0;  ///< zero area or edge-on to the light: they block nothing. Variant
                                           ///< Tiles: of those that came near rays, or have equal corners
  std::uint64_t tree_bytes = 0;  ///< memory of the cone tree (Tiles: of both trees), largest of the lights
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

/// Work of the exact soft shadows, summed over the lights.
struct SoftStats {
  std::uint64_t groups = 0;           ///< groups of points
  std::uint64_t points_lit = 0;       ///< points that see all of the light's part above their horizon
  std::uint64_t points_dark = 0;      ///< points that see none of it
  std::uint64_t points_penumbra = 0;  ///< points that see a part
  std::uint64_t candidates = 0;       ///< occluders left by the shafts, summed over the groups
  std::uint64_t points_bsp = 0;       ///< points answered by a BSP
  std::uint64_t points_clip = 0;      ///< points answered by clipping alone
  std::uint64_t points_outline = 0;   ///< points answered by outlines of meshes, and clipping
  std::uint64_t fragments = 0;        ///< convex parts of the light handed to the integrals
  std::uint64_t tree_nodes = 0;       ///< BSP nodes made
  std::uint64_t peak_tree_bytes = 0;  ///< most memory of all BSPs alive at one time, all threads together
};
inline SoftStats& operator+=(SoftStats& to, const SoftStats& from) {
  to.groups += from.groups;
  to.points_lit += from.points_lit;
  to.points_dark += from.points_dark;
  to.points_penumbra += from.points_penumbra;
  to.candidates += from.candidates;
  to.points_bsp += from.points_bsp;
  to.points_clip += from.points_clip;
  to.points_outline += from.points_outline;
  to.fragments += from.fragments;
  to.tree_nodes += from.tree_nodes;
  to.peak_tree_bytes = std::max(to.peak_tree_bytes, from.peak_tree_bytes);
  return to;
}

/// Work of ambient occlusion.
struct AoStats {
  std::uint64_t points = 0;        ///< points or vertices computed
  std::uint64_t objects = 0;       ///< rigid objects in reach of a visible point
  std::uint64_t fields_built = 0;  ///< in this frame
  std::uint64_t field_bytes = 0;   ///< all tables in memory
  std::uint64_t lookups = 0;       ///< rays answered by a field
  std::uint64_t rays_cast = 0;     ///< rays answered by casting
  std::uint64_t cache_cells = 0;   ///< cells of the cache of static surroundings
};

}  // namespace tenebra
