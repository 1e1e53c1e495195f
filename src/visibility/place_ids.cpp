#include "visibility/place_ids.h"

#include "parallel/parallel.h"

namespace tenebra::visibility {

void PlaceIds::begin(int width, int height, std::size_t places, bool has_layer) {
  width_ = width, height_ = height, places_ = places, has_layer_ = has_layer;
  tiles_x_ = (width + tile_side - 1) / tile_side;
  tiles_y_ = (height + tile_side - 1) / tile_side;
  tiles_.resize(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_));
  for (TilePlaces& tile : tiles_) tile.opened = 0;
}

std::int32_t* PlaceIds::open(std::size_t tile, int block) {
  TilePlaces& of = tiles_[tile];
  const std::size_t from = static_cast<std::size_t>(of.opened) * block_size();
  if (of.ids.size() < from + block_size()) of.ids.resize(from + block_size());
  of.open[block] = of.opened++;
  return &of.ids[from];
}

void PlaceIds::open_all() {
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
    for (int block = 0; block < tile_blocks; ++block) open(tile, block);
}

void PlaceIds::set_place(std::size_t place, const std::vector<std::uint32_t>& ids,
                         const std::vector<std::uint32_t>& layer) {
  const auto height = static_cast<std::size_t>(height_);
  parallel::parallel_ranges(height, tile_side, [&](std::size_t first, std::size_t last) {
    for (int y = static_cast<int>(first); y < static_cast<int>(last); ++y) {
      for (int x = 0; x < width_; ++x) {
        TilePlaces& tile = tiles_[tile_of(x, y)];
        const auto number = static_cast<std::size_t>(tile.open[block_of(x, y)]);
        std::int32_t* const to = &tile.ids[number * block_size() + 16 * place + lane_of(x, y)];
        const std::size_t pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        to[0] = static_cast<std::int32_t>(ids[pixel]);
        if (has_layer_) to[16 * places_] = static_cast<std::int32_t>(layer[pixel]);
      }
    }
  });
}

}  // namespace tenebra::visibility
