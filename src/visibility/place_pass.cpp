// Several places of all pixels at once: triangles are set up and sorted into tiles once, and blocks of pixels
// that one triangle covers are finished with that triangle.
#include <algorithm>
#include <cmath>

#include "parallel/parallel.h"
#include "visibility/pass_buffers.h"

namespace tenebra::visibility {
namespace {

float farthest(std::span<const glm::vec2> places) {
  float most = 0;
  for (const glm::vec2 place : places) most = std::max({most, std::abs(place.x), std::abs(place.y)});
  return most;
}

void collect(const std::vector<Bin>& bins, std::size_t tile, std::vector<const TileRecord*>& out) {
  out.clear();
  for (const Bin& bin : bins)
    for (const std::uint32_t i : bin.of_tile(tile)) out.push_back(bin.records() + i);
}

/// One tile's blocks.
class TileOfPlaces {
public:
  TileOfPlaces(const PlaceKernels& kernels, const PlaceTask& task, const PlaceTask& layer_task,
               PlaceScratch& scratch, std::size_t tile, PlaceIds& out)
      : kernels_(kernels), task_(task), layer_task_(layer_task), s_(scratch), tile_(tile), out_(out) {}

  void draw(int columns, int rows) {
    kernels_.cover(task_, s_.covers);
    kernels_.list(task_, s_.covers, s_.lists);
    kernels_.list(layer_task_, s_.covers, s_.layer_lists);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) draw_block(x, y);
  }

private:
  /// Whether the pixels of a block surely see the same at all places.
  bool is_settled(int block) const {
    if (s_.layer_lists.first[block] != no_record) return false;
    const std::uint32_t first = s_.lists.first[block];
    if (first == no_record) return true;
    const BlockLists::Entry entry = s_.lists.entries[first];
    return entry.next == no_record && entry.record == s_.covers.record[block];
  }

  void draw_block(int x, int y) {
    const int block = block_index(x, y);
    if (is_settled(block)) {
      const std::uint32_t first = s_.lists.first[block];
      const std::uint32_t id = first == no_record
                                   ? 0xffffffffu
                                   : task_.records[s_.lists.entries[first].record]->id & ~doubtful_bit;
      return out_.set_one(tile_, block, id);
    }
    const std::size_t count = 16 * task_.places.size();
    std::fill_n(s_.block.depth[0], count, 0.0f);
    std::fill_n(s_.block.ids[0], count, -1);
    kernels_.draw(task_, s_.lists, x, y, s_.block);
    const std::int32_t* const ids = s_.block.ids[0];
    const bool all_one = std::all_of(ids, ids + count, [&](std::int32_t id) { return id == ids[0]; });
    if (all_one && s_.layer_lists.first[block] == no_record)
      return out_.set_one(tile_, block, static_cast<std::uint32_t>(ids[0]));
    std::int32_t* const to = out_.open(tile_, block);
    std::copy_n(ids, count, to);
    if (!out_.has_layer()) return;
    std::fill_n(s_.block.ids[0], count, -1);  // the depths stay
    kernels_.draw(layer_task_, s_.layer_lists, x, y, s_.block);
    std::copy_n(ids, count, to + count);
  }

  const PlaceKernels& kernels_;
  const PlaceTask& task_;
  const PlaceTask& layer_task_;
  PlaceScratch& s_;
  std::size_t tile_;
  PlaceIds& out_;
};

}  // namespace

void VisibilityPass::Buffers::draw_places(const Drawing& drawing, const PlaceKernels& kernels,
                                          std::span<const glm::vec2> places, PlaceIds& out) {
  const auto around = static_cast<float>(drawing.around_px);
  place_scratch.resize(static_cast<std::size_t>(thread_count()));
  parallel::parallel_in_order(static_cast<int>(drawing.tiles()), [&](int number) {
    const auto tile = static_cast<std::size_t>(number);
    PlaceScratch& s = place_scratch[static_cast<std::size_t>(parallel::thread_index())];
    const int left = number % drawing.tiles_x * tile_side, top = number / drawing.tiles_x * tile_side;
    collect(bins, tile, s.records);
    s.layer_records.clear();
    if (out.has_layer()) collect(layer_bins, tile, s.layer_records);
    const PlaceTask task{s.records, left, top, drawing.close, places, around},
        layer_task{s.layer_records, left, top, drawing.close, places, around};
    const int columns = std::min(tile_side, drawing.window.width - left),
              rows = std::min(tile_side, drawing.window.height - top);
    TileOfPlaces(kernels, task, layer_task, s, tile, out)
        .draw((columns + block_side - 1) / block_side, (rows + block_side - 1) / block_side);
  });
}

Expected<bool> VisibilityPass::draw_places(const FrameGeometry& geometry, const ViewRays& view, int width,
                                           int height, std::span<const glm::vec2> places, SimdLevel simd,
                                           PlaceIds& out) {
  const parallel::FloatEnvironment ieee;
  const auto transform = checked_transform(geometry, view, width, height);
  if (!transform) return tl::unexpected(transform.error());
  if (places.size() > most_places) return false;
  Buffers& buffers = *buffers_;
  DrawingParts parts(geometry, view, *transform, width, height, simd, buffers.vertices);
  Drawing& drawing = parts.drawing;
  const float around = farthest(places);
  drawing.around_px = around;
  parts.window.margin += around;
  buffers.place(drawing);
  const bool has_layer = has_see_through(geometry);
  Buffers::begin_bins(geometry.triangles.size(), buffers.bins);
  if (!Buffers::fill_bins(drawing, buffers.bins)) return false;
  if (has_layer) {
    drawing.draws_see_through = true;
    Buffers::begin_bins(geometry.triangles.size(), buffers.layer_bins);
    if (!Buffers::fill_bins(drawing, buffers.layer_bins)) return false;
  }
  out.begin(width, height, places.size(), has_layer);
  buffers.draw_places(drawing, place_kernels(simd), places, out);
  return true;
}

}  // namespace tenebra::visibility
