// Figure 11 of Mora et al. 2012: what a query costs, and what the tree holds, over one tree's life.
#pragma once

#include <cstdint>
#include <vector>

#include "bench/common/bench_report.h"
#include "bench/soft/soft_quality.h"
#include "bench/soft/soft_views.h"

namespace tenebra::bench {

/// After so many queries of one tree.
struct LifeRow {
  std::size_t queries = 0;
  double us_a_query = 0;  ///< of the queries since the row before
  double bytes = 0;       ///< of the tree
  double nodes = 0;
};

/// One tree for all points of one visible triangle (Algorithm 2), asked in scanline order, on one thread. The
/// triangle is the one in whose penumbra most points lie, among those seen at up to `most_points` pixels. The
/// costs are differences between runs that stop after more and more points, the least of three each. Empty:
/// no triangle has penumbra.
std::vector<LifeRow> measure_life(const SoftView& view, std::span<const std::uint8_t> penumbra,
                                  std::size_t most_points, Report& report);

}  // namespace tenebra::bench
