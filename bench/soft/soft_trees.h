// What the BSPs of Mora et al. 2012 cost.
#pragma once

#include <tenebra/soft_config.h>
#include "bench/soft/soft_views.h"

namespace tenebra::bench {

/// One mask of one light by solver bsp.
struct TreeCost {
  double ms = 0;
  double nodes = 0;    ///< made in all trees
  double bytes = 0;    ///< of all trees alive at one time, at most
  double by_tree = 0;  ///< points answered by trees
  double clipped = 0;  ///< points answered by clipping, their tree having come to its bound
  double shaft_ms = 0, init_ms = 0, query_ms = 0;
  bool finite = true;  ///< all values are numbers, 0 or more
};
TreeCost tree_cost(const SoftView& view, const VisiblePoints& points, const SoftShadowConfig& config);

}  // namespace tenebra::bench
