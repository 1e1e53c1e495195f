// Buffers of a visibility pass, kept from drawing to drawing. Internal to visibility.
#pragma once

#include <vector>

#include "visibility/bins.h"
#include "visibility/place_kernels.h"
#include "visibility/visibility.h"

namespace tenebra::visibility {

constexpr std::size_t most_records = std::size_t{1} << 21;  // at a time: 128 MiB

/// The lists that a drawing fills.
struct Planes {
  std::int32_t* ids = nullptr;
  float* depth = nullptr;  ///< null: not wanted
};

/// Scratch of a thread that draws several places of a tile.
struct PlaceScratch {
  std::vector<const TileRecord*> records, layer_records;
  Covers covers;
  BlockLists lists, layer_lists;
  PlaceBlock block;
};

/// The parts of a drawing that refer to each other.
struct DrawingParts {
  DrawingParts(const FrameGeometry& geometry, const ViewRays& view, const ClipTransform& transform, int width,
               int height, SimdLevel simd, const WindowVertices& vertices);
  DrawingParts(const DrawingParts&) = delete;
  DrawingParts& operator=(const DrawingParts&) = delete;

  Window window;
  ExactCoverage coverage;
  CloseCalls close;
  Drawing drawing;
};

struct VisibilityPass::Buffers {
  WindowVertices vertices;
  std::vector<Bin> bins, layer_bins;
  std::vector<Tile> scratch;  // of each thread
  std::vector<Tile> tiles;    // of the picture, where one drawing after another goes into them
  std::vector<PlaceScratch> place_scratch;

  void place(const Drawing& drawing);
  static void begin_bins(std::size_t triangles, std::vector<Bin>& bins);
  /// Returns whether no bin has more.
  static bool fill_bins(const Drawing& drawing, std::vector<Bin>& bins);
  void draw_all(const Drawing& drawing, const TileKernels& kernels, bool keeps_tiles, const Planes& out);
  void draw_places(const Drawing& drawing, const PlaceKernels& kernels, std::span<const glm::vec2> places,
                   PlaceIds& out);
};

/// Fails as VisibilityPass::draw says.
Expected<ClipTransform> checked_transform(const FrameGeometry& geometry, const ViewRays& view, int width,
                                          int height);

}  // namespace tenebra::visibility
