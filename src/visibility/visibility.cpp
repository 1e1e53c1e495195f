#include "visibility/visibility.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

#include "base/fail.h"
#include "parallel/parallel.h"
#include "visibility/pass_buffers.h"

namespace tenebra::visibility {
namespace {

// A frame with a hard shadow needs about 60 bytes for each pixel: 4 GB at this many. Anti-aliasing needs 12
// more, and 4 (with see-through surfaces 8) for each further place within pixels: at 16 samples 9 GB (13).
constexpr std::int64_t max_pixels = std::int64_t{1} << 26;
constexpr int max_side = 1 << 15;                        // Window::margin
constexpr std::size_t max_items = std::size_t{1} << 29;  // of four bytes, by offsets of 32 bits
constexpr std::size_t most_bins = 64, least_bin = 1024;  // triangles
constexpr std::size_t vertices_at_once = 4096;

/// A tile's rows into the picture's.
template <class T>
void resolve(const T* tile, int left, int top, int width, int height, T* out) {
  const int columns = std::min(tile_side, width - left), rows = std::min(tile_side, height - top);
  for (int y = 0; y < rows; ++y) {
    T* const row = out + static_cast<std::size_t>(top + y) * static_cast<std::size_t>(width) + left;
    const T* const from = tile + y % block_side * block_side;
    int x = 0;
    for (; x + block_side <= columns; x += block_side)
      std::memcpy(row + x, from + 16 * block_index(x / block_side, y / block_side), block_side * sizeof(T));
    for (; x < columns; ++x) row[x] = from[16 * block_index(x / block_side, y / block_side) + x % block_side];
  }
}

void clear(Tile& tile, bool layer) {
  std::fill_n(tile.ids, tile_pixels, -1);
  if (layer) return;  // keeps the depths of what is opaque
  std::fill_n(tile.depth, tile_pixels, 0.0f);
  std::fill_n(tile.far_depth, tile_blocks, 0.0f);
}

}  // namespace

DrawingParts::DrawingParts(const FrameGeometry& geometry, const ViewRays& view,
                           const ClipTransform& transform, int width, int height, SimdLevel simd,
                           const WindowVertices& vertices)
    : window(view, transform, width, height),
      coverage(view, window),
      close{coverage, geometry.positions, geometry.triangles},
      drawing{window, close, vertices, geometry.see_through, false, setup_kernels(simd)} {
  drawing.tiles_x = (width + tile_side - 1) / tile_side;
  drawing.tiles_y = (height + tile_side - 1) / tile_side;
}

void VisibilityPass::Buffers::place(const Drawing& drawing) {
  const auto positions = drawing.close.positions;
  for (auto* list : {&vertices.x, &vertices.y, &vertices.depth}) list->resize(positions.size());
  parallel::parallel_ranges(positions.size(), vertices_at_once, [&](std::size_t first, std::size_t last) {
    drawing.kernels.place(drawing.window, positions, first, last, vertices);
  });
}

void VisibilityPass::Buffers::begin_bins(std::size_t triangles, std::vector<Bin>& bins) {
  const std::size_t count = std::clamp<std::size_t>(triangles / least_bin, 1, most_bins);
  bins.resize(count);
  for (std::size_t i = 0; i < count; ++i) bins[i].begin(triangles * i / count, triangles * (i + 1) / count);
}

bool VisibilityPass::Buffers::fill_bins(const Drawing& drawing, std::vector<Bin>& bins) {
  const std::size_t most = most_records / bins.size();
  parallel::parallel_in_order(static_cast<int>(bins.size()),
                              [&](int i) { bins[static_cast<std::size_t>(i)].fill(drawing, most); });
  return std::all_of(bins.begin(), bins.end(), [](const Bin& bin) { return bin.is_done(); });
}

/// In rounds, so that memory is bounded; nearly always in one.
void VisibilityPass::Buffers::draw_all(const Drawing& drawing, const TileKernels& kernels, bool keeps_tiles,
                                       const Planes& out) {
  begin_bins(drawing.close.triangles.size(), bins);
  bool kept = keeps_tiles;
  for (bool first = true, last = false; !last; first = false) {
    last = fill_bins(drawing, bins);
    kept = kept || !last;
    if (kept) tiles.resize(drawing.tiles());
    if (!kept) scratch.resize(static_cast<std::size_t>(thread_count()));
    parallel::parallel_in_order(static_cast<int>(drawing.tiles()), [&](int number) {
      const auto tile = static_cast<std::size_t>(number);
      Tile& into = kept ? tiles[tile] : scratch[static_cast<std::size_t>(parallel::thread_index())];
      const int left = number % drawing.tiles_x * tile_side, top = number / drawing.tiles_x * tile_side;
      if (first) clear(into, drawing.draws_see_through);
      for (const Bin& bin : bins) {
        const auto order = bin.of_tile(tile);
        kernels.draw(bin.records(), order.data(), order.size(), left, top, drawing.close, into);
      }
      if (!last) return;
      resolve(into.ids, left, top, drawing.window.width, drawing.window.height, out.ids);
      if (out.depth != nullptr)
        resolve(into.depth, left, top, drawing.window.width, drawing.window.height, out.depth);
    });
  }
}

Expected<void> check_picture_size(int width, int height) {
  if (width < 1 || height < 1)
    return base::fail("picture: found size {}x{}, expected at least 1x1", width, height);
  if (width > max_side || height > max_side)
    return base::fail("picture: found size {}x{}, expected at most {}x{}", width, height, max_side, max_side);
  if (std::int64_t{width} * height > max_pixels)
    return base::fail("picture: found size {}x{}, expected at most {} pixels", width, height, max_pixels);
  return {};
}

VisibilityPass::VisibilityPass() : buffers_(std::make_unique<Buffers>()) {}
VisibilityPass::VisibilityPass(VisibilityPass&&) noexcept = default;
VisibilityPass& VisibilityPass::operator=(VisibilityPass&&) noexcept = default;
VisibilityPass::~VisibilityPass() = default;

Expected<ClipTransform> checked_transform(const FrameGeometry& geometry, const ViewRays& view, int width,
                                          int height) {
  if (auto size = check_picture_size(width, height); !size) return tl::unexpected(size.error());
  if (std::max(geometry.triangles.size(), geometry.positions.size()) > max_items) {
    return base::fail("picture: found {} triangles and {} vertices, expected at most {}",
                      geometry.triangles.size(), geometry.positions.size(), max_items);
  }
  const math::Box<float> bounds = view.orthographic ? bounds_of(geometry.positions) : math::Box<float>{};
  return clip_transform(view, bounds, width, height);
}

bool has_see_through(const FrameGeometry& geometry) {
  return std::any_of(geometry.see_through.begin(), geometry.see_through.end(),
                     [](std::uint8_t through) { return through != 0; });
}

Expected<void> VisibilityPass::draw(const FrameGeometry& geometry, const ViewRays& view, int width,
                                    int height, bool with_depth, SimdLevel simd, VisibleIds& out) {
  const parallel::FloatEnvironment ieee;
  const auto transform = checked_transform(geometry, view, width, height);
  if (!transform) return tl::unexpected(transform.error());
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  out.width = width, out.height = height, out.transform = *transform;
  out.has_layer = has_see_through(geometry);
  out.ids.resize(pixels);
  out.depth.resize(with_depth ? pixels : 0);
  out.layer.resize(out.has_layer ? pixels : 0);

  DrawingParts parts(geometry, view, *transform, width, height, simd, buffers_->vertices);
  Drawing& drawing = parts.drawing;
  const TileKernels kernels = tile_kernels(simd);
  buffers_->place(drawing);
  const auto as_signed = [](std::vector<std::uint32_t>& ids) {
    return reinterpret_cast<std::int32_t*>(ids.data());
  };
  const Planes opaque{as_signed(out.ids), with_depth ? out.depth.data() : nullptr};
  buffers_->draw_all(drawing, kernels, out.has_layer, opaque);
  if (!out.has_layer) return {};
  drawing.draws_see_through = true;
  buffers_->draw_all(drawing, kernels, true, {as_signed(out.layer), nullptr});
  return {};
}

}  // namespace tenebra::visibility
