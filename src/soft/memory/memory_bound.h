// What soft shadows need of SoftShadowConfig::memory_bytes.
#pragma once

#include <cstddef>

#include <tenebra/soft_config.h>
#include "parallel/memory_bound.h"

namespace tenebra::soft {

using parallel::MemoryBound;

/// Lists of candidates that wait to be solved take one part in so many.
inline constexpr std::size_t share_of_lists = 8;

/// What so many candidates take at most, in all their forms together. tests/bench/soft/soft_memory_test.cpp
/// measures it.
inline std::size_t bytes_of_candidates(SoftSolver solver, std::size_t count) {
  constexpr std::size_t fixed = 1 << 17, clipped = 760, in_bsp = 1200;
  return fixed + count * (solver == SoftSolver::bsp ? in_bsp : clipped);
}

/// For each byte of a BSP: a vector that grows holds its old and its new memory.
inline constexpr std::size_t bytes_of_tree = 3;

/// What a BSP may use beside the candidates of its group.
inline std::size_t largest_tree(const MemoryBound& memory, std::size_t candidate_bytes) {
  const std::size_t most = memory.most_alone();
  return candidate_bytes < most ? (most - candidate_bytes) / bytes_of_tree : 0;
}

}  // namespace tenebra::soft
