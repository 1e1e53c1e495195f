// Mora et al. 2012 on their own method: one lazily grown BSP for each visible triangle, occluders merged in a
// random order (Algorithms 1 and 2). What Figures 7 to 11 are made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/paper/paper_claims.h"
#include "bench/soft/soft_contest.h"
#include "bench/soft/soft_trees.h"

namespace tenebra::bench {

/// The paper's trees have no bound; these have one that a test machine can bear, far above the program's own.
inline constexpr std::size_t tree_bound_mib = 256;
/// Whether a mask's largest tree came to its bound. Its lists double, so that one that cannot grow has more
/// than half of the bound (tests/soft/tree_bound_test.cpp); points that are clipped are no sign, lit ones
/// count as such.
inline bool came_to_bound(double bytes) {
  return bytes >= 0.5 * static_cast<double>(tree_bound_mib << 20);
}

/// Solver bsp, points grouped by triangle, random choice of occluders, trees of at most tree_bound_mib.
SoftShadowConfig mora_config();

/// Figure 8 and what the text says beside it, of one view.
struct TreeView {
  std::string view;
  double triangles = 0;
  double points_a_triangle = 0;  ///< half of the points lie on triangles that have at most this many
  TreeCost paper;                ///< the paper's method on all points
  TreeCost kept, anew;           ///< on some points: as it is, and each query starting with an empty tree
  TreeCost largest;              ///< on all: the largest occluder is merged first
  TreeCost neighbourhood;        ///< on all: points grouped by 8x8 pixels (section 5.5)
  std::optional<Contest> race;   ///< Figure 7: the paper's method against rays
};
/// `kept` and `anew` on one of `every` 8x8 tiles of the picture.
TreeView measure_trees(const SoftView& view, std::size_t every);
/// `paper` and `neighbourhood` alone.
TreeView measure_grouping(const SoftView& view);

/// Figure 9: squares of 1 % of the diagonal and more; Figure 10: a number of these in a grid.
struct GrowthRow {
  double count = 1;  ///< of the light's area, or of lights
  TreeCost cost;     ///< of lights: summed, the largest of bytes
};
std::vector<GrowthRow> grow_light(const SoftView& view, const std::vector<double>& factors);
std::vector<GrowthRow> add_lights(const SoftView& view, const std::vector<std::size_t>& counts);

/// A light of four quarters in the place of a whole one (section 5.3).
struct SplitLight {
  double difference_255 = 0;  ///< of the irradiance, at most, in 1/255 of the largest
  double whole_bytes = 0, part_bytes = 0;
};
SplitLight split_light(const SoftView& view);

/// Figure 11: one tree's life, asked in scanline order on one thread.
struct LifeRow {
  double queries = 0;     ///< so far
  double us_a_query = 0;  ///< since the row before
  double bytes = 0, nodes = 0;
};
struct TreeLife {
  double occluders = 0;
  double dropped_at = 0;  ///< queries, at about which the tree came to its bound; 0: it did not
  std::vector<LifeRow> rows;
};
/// Of the visible triangle with most queries, among those whose tree stays within bounds if there are any.
TreeLife measure_life(const SoftView& view, std::size_t rows);

struct SoftFindings {
  std::vector<TreeView> views;
  std::vector<TreeView> small;  ///< of a full run, groupings in small pictures: few points on each triangle
  std::string growth_view, life_view;
  std::vector<GrowthRow> areas, lights;
  SplitLight split;
  TreeLife life;
};

std::vector<Claim> soft_claims(const SoftFindings& found);

}  // namespace tenebra::bench
