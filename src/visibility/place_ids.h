// The ids that the pixels of a picture see at several places within them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "visibility/records.h"

namespace tenebra::visibility {

/// What one pixel sees at the places.
struct PixelPlaces {
  const std::int32_t* ids = nullptr;  ///< [16 place]; null: all places see the same
  std::uint32_t one = 0;              ///< what they see then
  const std::int32_t* layer_ids = nullptr;

  /// An opaque triangle, or 0xffffffff.
  std::uint32_t id(std::size_t place) const {
    return ids == nullptr ? one : static_cast<std::uint32_t>(ids[16 * place]);
  }
  /// The nearest see-through triangle before it, or 0xffffffff.
  std::uint32_t layer(std::size_t place) const {
    return layer_ids == nullptr ? 0xffffffffu : static_cast<std::uint32_t>(layer_ids[16 * place]);
  }
};

/// The ids that all pixels see at several places. Most blocks of sixteen pixels see one triangle, and are
/// kept as that.
class PlaceIds {
public:
  /// Keeps its memory. Every block then has to be set, those of one tile by one thread.
  void begin(int width, int height, std::size_t places, bool has_layer);
  /// All pixels of a block see `id`, and nothing before it.
  void set_one(std::size_t tile, int block, std::uint32_t id) {
    tiles_[tile].open[block] = -1;
    tiles_[tile].one[block] = id;
  }
  /// Room for the ids of a block: [place][16], and as much again for the layer's, if there is one. Valid
  /// until the tile's next block.
  std::int32_t* open(std::size_t tile, int block);

  /// Gives every block room; then place after place can be set from pictures of ids.
  void open_all();
  void set_place(std::size_t place, const std::vector<std::uint32_t>& ids,
                 const std::vector<std::uint32_t>& layer);

  std::size_t places() const { return places_; }
  bool has_layer() const { return has_layer_; }
  /// The three pixels to the right of one whose x is a multiple of four follow it in the lists.
  PixelPlaces of_pixel(int x, int y) const {
    const TilePlaces& tile = tiles_[tile_of(x, y)];
    const int block = block_of(x, y), number = tile.open[block];
    if (number < 0) return {nullptr, tile.one[block], nullptr};
    const std::int32_t* ids = &tile.ids[static_cast<std::size_t>(number) * block_size() + lane_of(x, y)];
    return {ids, 0, has_layer_ ? ids + 16 * places_ : nullptr};
  }

private:
  struct TilePlaces {
    std::int32_t open[tile_blocks];  // number in ids, or -1
    std::uint32_t one[tile_blocks];
    std::vector<std::int32_t> ids;
    std::int32_t opened = 0;
  };
  std::size_t block_size() const { return 16 * places_ * (has_layer_ ? 2 : 1); }
  std::size_t tile_of(int x, int y) const {
    return static_cast<std::size_t>(y / tile_side * tiles_x_ + x / tile_side);
  }
  static int block_of(int x, int y) {
    return block_index(x % tile_side / block_side, y % tile_side / block_side);
  }
  static std::size_t lane_of(int x, int y) {
    return static_cast<std::size_t>(y % block_side * block_side + x % block_side);
  }

  int width_ = 0, height_ = 0, tiles_x_ = 0, tiles_y_ = 0;
  std::size_t places_ = 0;
  bool has_layer_ = false;
  std::vector<TilePlaces> tiles_;
};

}  // namespace tenebra::visibility
