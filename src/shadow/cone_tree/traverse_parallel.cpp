#include <algorithm>
#include <array>

#include "parallel/parallel.h"
#include "shadow/cone_tree/traverse.h"

namespace tenebra::shadow {

namespace {

constexpr std::size_t chunk_size = 1 << 16;
constexpr std::size_t split_levels = 3;  // 4^3 subtrees to share out

struct Job {
  const Traversal& traversal;
  const TraversalKernels& kernels;
  std::vector<TraversalScratch>& scratch;
  std::size_t serial_level;  // subtrees of this level and below run on one thread
};

// Tests one block's nodes and takes what passes further down; its four subtrees run side by side.
TraceStats descend_block(const Job& job, std::size_t level, std::size_t block,
                         std::span<const std::uint32_t> places) {
  if (stop_requested(job.traversal.stop)) return {};
  std::array<std::vector<std::uint32_t>, branching> lists;
  std::uint32_t* out[branching];
  std::size_t size[branching];
  for (int lane = 0; lane < branching; ++lane) {
    lists[lane].resize(places.size() + 1);
    out[lane] = lists[lane].data();
  }
  TraceStats stats;
  job.kernels.filter(job.traversal, level, block, {places.data(), places.size()}, out, size, stats);

  std::array<TraceStats, branching> below;
  parallel::parallel_tasks(branching, [&](int lane) {
    const std::size_t node = block * branching + static_cast<std::size_t>(lane);
    const TriangleList list{lists[lane].data(), size[lane]};
    if (list.size == 0) return;
    if (level > job.serial_level) {
      below[lane] = descend_block(job, level - 1, node, {list.places, list.size});
      return;
    }
    TraversalScratch& scratch = job.scratch[static_cast<std::size_t>(parallel::thread_index())];
    job.kernels.descend(job.traversal, level, node, list, scratch, below[lane]);
  });
  for (const TraceStats& part : below) stats += part;
  return stats;
}

}  // namespace

void traverse(const Traversal& traversal, const TraversalKernels& kernels,
              std::span<const std::uint32_t> places, std::vector<TraversalScratch>& scratch,
              TraceStats& stats) {
  const std::size_t top = traversal.tree->levels.size() - 1;
  scratch.resize(std::max(scratch.size(), static_cast<std::size_t>(thread_count())));
  for (TraversalScratch& s : scratch) s.lists.resize(std::max(s.lists.size(), branching * (top + 1)));
  const Job job{traversal, kernels, scratch, top > split_levels ? top - split_levels : 0};
  for (std::size_t first = 0; first < places.size(); first += chunk_size) {
    const std::size_t size = std::min(chunk_size, places.size() - first);
    stats += descend_block(job, top, 0, places.subspan(first, size));
  }
}

}  // namespace tenebra::shadow
