// What exact soft shadows are asked for, what they answer with, and the work that they report.
#pragma once

#include <tenebra/simd_level.h>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tenebra {

/// What finds the visible part of the light from the points of a group. All give the same answer.
enum class SoftSolver {
  automatic,  ///< meshes by their outline where enough of their edges cancel, the rest by clipping
  bsp,        ///< the paper's lazily grown BSP of line classes (Algorithm 1)
  clip,       ///< occluders subtracted from the light's polygon, point by point
};
std::string_view soft_solver_name(SoftSolver solver);  ///< "auto", "bsp", "clip"
std::optional<SoftSolver> soft_solver_from_name(std::string_view name);

/// Which points share a BSP.
enum class SoftGrouping {
  neighbourhood,  ///< 8x8 pixels, split where they do not lie together (section 5.5)
  triangle,       ///< all points of a visible triangle (Algorithm 2)
};

/// Which occluder of an undefined leaf is merged next (Algorithm 1, line 31).
enum class OccluderChoice { largest, random };

/// fast: the lines of occluders in double, the polygons that they cut in float, in units of the light.
/// reference: double throughout.
enum class SoftPrecision { fast, reference };

struct SoftShadowConfig {
  SoftSolver solver = SoftSolver::automatic;
  SoftGrouping grouping = SoftGrouping::neighbourhood;
  OccluderChoice choice = OccluderChoice::largest;
  SoftPrecision precision = SoftPrecision::fast;
  bool keep_trees = true;  ///< false: each query starts anew (the paper's "modified version", Figure 8)
  SimdLevel simd = SimdLevel::automatic;
};

/// One a pixel, row 0 at the top; zero where no triangle is seen or the light is below the horizon.
struct SoftMask {
  std::vector<float> visible_fraction;  ///< 0..1: visible area over area of the light
  std::vector<float> irradiance;        ///< 0..pi: for radiance 1, W/m2; the integral of cos over the visible
                                        ///< part's solid angle
};

/// How a pixel was answered, for display.
enum class SoftClass : std::uint8_t { background, below_horizon, lit, dark, bsp, clip, outline };

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

}  // namespace tenebra
