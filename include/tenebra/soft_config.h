// How soft shadows are computed, their results, and the work that they report.
#pragma once

#include <tenebra/simd_level.h>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tenebra {

/// How the visible part of the light is found. All solvers give the same answer.
enum class SoftSolver {
  automatic,  ///< meshes by their silhouettes where enough edges cancel, the rest by clipping
  bsp,        ///< the paper's lazily grown BSP of line classes (Algorithm 1)
  clip,       ///< occluders subtracted from the light's polygon, point by point
};
std::string_view soft_solver_name(SoftSolver solver);  ///< "auto", "bsp", "clip"
/// The solver of that name; none if there is no such solver.
std::optional<SoftSolver> soft_solver_from_name(std::string_view name);

/// Which points form a group and so share occluders (and a BSP).
enum class SoftGrouping {
  neighbourhood,  ///< of 8x8 pixels, split where they do not lie together (section 5.5)
  triangle,       ///< all points of a visible triangle (Algorithm 2)
};

/// Which occluder the BSP merges next into an undefined leaf (Algorithm 1, line 31).
enum class OccluderChoice { largest, random };

/// How soft shadows are computed.
struct SoftShadowConfig {
  SoftSolver solver = SoftSolver::automatic;            ///< the method; all give the same answer
  SoftGrouping grouping = SoftGrouping::neighbourhood;  ///< of points that share occluders
  OccluderChoice choice = OccluderChoice::largest;      ///< of the BSP
  /// 1/255 of white, RMS over the penumbra, white being the 99.9th percentile of the light that the frame
  /// shows (SoftShadowTracer::trace, `shown`); 0: exact. Above 0, groups of points that many triangles may
  /// shadow are sampled at places on the light, by exact hard shadows: at as many as it takes until the
  /// estimated error (SoftStats::error_255) is no more than this. Points that are proved to see all or none
  /// of the light stay exact.
  double error_255 = 0;
  bool keep_trees = true;  ///< false: each point starts a new BSP (the paper's "modified version", Figure 8)
  SimdLevel simd = SimdLevel::automatic;  ///< which vectors; the bits are the same
  /// No BSP takes more bytes than this, nor more than 1 GiB or memory_bytes leaves: a point whose query would
  /// exceed it, and the group's points after it (with keep_trees), are clipped instead, with the same
  /// answers.
  std::size_t tree_bytes = std::size_t{4} << 20;
  /// Bytes for BSPs, candidates, and the lists of them that wait to be solved, of all threads together; none:
  /// as many as the system has. Points that are solved together need some by the number of their candidates:
  /// those that need much are solved one after the other, and those that need more than three quarters of it
  /// end the frame: SoftShadowTracer::refusal(). Of the BSP, what is found follows from this number and not
  /// from the threads; of the other solvers it has the same bits as without a bound.
  std::optional<std::size_t> memory_bytes;
};

/// One value per pixel, row 0 at the top; zero where no triangle is seen or the light is below the horizon.
struct SoftMask {
  std::vector<float> visible_fraction;  ///< 0..1: the light's visible area over its area
  std::vector<float> irradiance;        ///< 0..pi, W/m2 for a light of radiance 1: the cosine integrated over
                                        ///< the solid angle of the visible part
};

/// How a pixel's answer was found, for display.
enum class SoftClass : std::uint8_t { background, below_horizon, lit, dark, bsp, clip, silhouette, sampled };

/// The work that soft shadows did, summed over the lights.
struct SoftStats {
  std::uint64_t groups = 0;             ///< groups of points
  std::uint64_t points_lit = 0;         ///< points that see all of the light's part above their horizon
  std::uint64_t points_dark = 0;        ///< points that see none of it
  std::uint64_t points_penumbra = 0;    ///< points that see a part
  std::uint64_t candidates = 0;         ///< occluders left by the shafts, summed over the groups
  std::uint64_t points_bsp = 0;         ///< points solved by a BSP
  std::uint64_t points_clip = 0;        ///< points solved by clipping alone
  std::uint64_t points_silhouette = 0;  ///< points solved by silhouettes of meshes, and clipping
  std::uint64_t points_sampled = 0;     ///< points sampled at places on the light (error_255 > 0)
  std::uint64_t sampled_rays = 0;       ///< the rays from these points to places on the light
  double error_255 = 0;                 ///< estimate of what SoftShadowConfig::error_255 bounds; 0 (exact)
                                        ///< if no point was sampled; the largest of several lights
  std::uint64_t fragments = 0;          ///< convex parts of the light handed to the integrals
  std::uint64_t tree_nodes = 0;         ///< BSP nodes made
  std::uint64_t peak_tree_bytes = 0;    ///< the most memory that all BSPs alive at one time took
  std::uint64_t groups_changed = 0;     ///< groups with points clipped because a BSP came to its bound
};
/// Adds the work of another light, or of another part of one; for errors and bytes the larger counts.
inline SoftStats& operator+=(SoftStats& to, const SoftStats& from) {
  to.groups += from.groups;
  to.points_lit += from.points_lit;
  to.points_dark += from.points_dark;
  to.points_penumbra += from.points_penumbra;
  to.candidates += from.candidates;
  to.points_bsp += from.points_bsp;
  to.points_clip += from.points_clip;
  to.points_silhouette += from.points_silhouette;
  to.points_sampled += from.points_sampled;
  to.sampled_rays += from.sampled_rays;
  to.error_255 = std::max(to.error_255, from.error_255);
  to.fragments += from.fragments;
  to.tree_nodes += from.tree_nodes;
  to.peak_tree_bytes = std::max(to.peak_tree_bytes, from.peak_tree_bytes);
  to.groups_changed += from.groups_changed;
  return to;
}

}  // namespace tenebra
