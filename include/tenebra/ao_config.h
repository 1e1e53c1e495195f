// What ambient occlusion is asked for, and the work that it reports.
#pragma once

#include <tenebra/simd_level.h>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace tenebra {

enum class AoMode { none, field, rays };
enum class AoPlace { pixels, vertices };
enum class FieldLayout {
  positions_directions,  ///< the paper's: positions on the sphere x inward directions
  chords,                ///< entry x exit points
};

struct AoConfig {
  AoMode mode = AoMode::none;
  AoPlace place = AoPlace::pixels;
  FieldLayout layout = FieldLayout::chords;
  int rays = 64;  ///< a point, cosine-weighted
  int downscale =
      1;  ///< pixels: computed at one of so many squared, the rest blurred from those that resemble it
  double distance_m =
      0;  ///< where occlusion has fallen off to nothing; 0: a twentieth of the scene's diagonal
  int positions = 4225;   ///< samples on the bounding sphere, rounded to what the map offers
  int directions = 1024;  ///< inward directions a position, rounded to a square
  int bits = 8;           ///< of a stored distance: 1, 8 or 32
  bool deforming =
      true;  ///< objects that deform have no field: true: rays meet them as they are; false: left out
  std::filesystem::path cache;  ///< folder of built fields; empty: none is kept
  SimdLevel simd = SimdLevel::automatic;
};

/// Called now and then with 0..1 while something long is built.
using AoProgress = std::function<void(std::string_view what, double done)>;

/// Work of ambient occlusion.
struct AoStats {
  std::uint64_t points = 0;        ///< points or vertices computed
  std::uint64_t objects = 0;       ///< rigid objects in reach of a visible point
  std::uint64_t fields_built = 0;  ///< in this frame
  std::uint64_t field_bytes = 0;   ///< all tables in memory
  std::uint64_t lookups = 0;       ///< rays answered by a field
  std::uint64_t rays_cast = 0;     ///< rays answered by casting
  std::uint64_t cache_cells = 0;   ///< cells of the cache of static surroundings
};

}  // namespace tenebra
