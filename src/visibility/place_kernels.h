// Triangles at several places within the pixels of a tile. Internal to visibility.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/simd_level.h>
#include "visibility/records.h"
#include "visibility/tile_kernels.h"

namespace tenebra::visibility {

constexpr std::uint32_t no_record = 0xffffffffu;
constexpr std::size_t most_places = 16;  ///< at once

/// Which of a tile's records may be seen in which of its blocks, anywhere within `around_px` of a pixel's
/// centre, each way. Blocks by block_index.
struct BlockLists {
  struct Entry {
    std::uint32_t record;
    std::uint32_t next;  ///< in `entries`; no_record: the last
  };
  std::vector<Entry> entries;
  std::uint32_t first[tile_blocks];  ///< in `entries`

  void clear() {
    entries.clear();
    for (std::uint32_t& entry : first) entry = no_record;
  }
  void add(int block, std::size_t record) {
    entries.push_back({static_cast<std::uint32_t>(record), first[block]});
    first[block] = static_cast<std::uint32_t>(entries.size() - 1);
  }
};

/// Blocks that a single opaque record covers, at every place of every pixel.
struct Covers {
  float far_depth[tile_blocks];       ///< what is seen there is at least as near; 0: nothing covers it
  std::uint32_t record[tile_blocks];  ///< the record that covers it
};

struct PlaceTask {
  std::span<const TileRecord* const> records;
  int left, top;  ///< first pixel of the tile
  const CloseCalls& close;
  std::span<const glm::vec2> places;  ///< from pixels' centres, most_places at most
  float around_px;                    ///< the farthest of their coordinates
};

/// The sixteen pixels of a block at each place, row after row.
struct PlaceBlock {
  alignas(64) float depth[most_places][16];
  alignas(64) std::int32_t ids[most_places][16];
};

/// Code for one instruction set; all give the same bits.
struct PlaceKernels {
  void (*cover)(const PlaceTask& task, Covers& out) = nullptr;
  void (*list)(const PlaceTask& task, const Covers& covers, BlockLists& out) = nullptr;
  /// Draws the records of a block's list, as TileKernels::draw does.
  void (*draw)(const PlaceTask& task, const BlockLists& lists, int block_x, int block_y,
               PlaceBlock& out) = nullptr;
};
PlaceKernels place_kernels(SimdLevel level);

}  // namespace tenebra::visibility
