// How ambient occlusion is computed, and the work that it reports.
#pragma once

#include <tenebra/simd_level.h>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>

namespace tenebra {

/// How ambient occlusion is found.
enum class AoMode {
  none,
  adaptive,  ///< rays through all triangles where the picture needs them, filtered, to AoConfig::error_255
  field,     ///< displacement fields and surface samples, with AoConfig::rays rays per point
  rays,      ///< the reference: the same rays through all triangles by another library's ray caster
};
/// Where it is computed: at each pixel's point, or at the vertices and interpolated between them.
enum class AoPlace { pixels, vertices };
/// What a displacement field stores a distance for.
enum class FieldLayout {
  positions_directions,  ///< the paper's: positions on the sphere x inward directions
  chords,                ///< entry x exit points
};

/// `adaptive` reads error, distance, `deforming`, `cache` and `simd`; the other modes read all but the error.
struct AoConfig {
  AoMode mode = AoMode::none;                ///< the method
  AoPlace place = AoPlace::pixels;           ///< where it is computed; `adaptive`: always pixels
  FieldLayout layout = FieldLayout::chords;  ///< of fields
  int rays = 64;                             ///< per point, cosine-weighted
  double error_255 = 2.5;  ///< adaptive: the RMS error over the picture to aim at, in 1/255; 0.1 to 255
  int downscale = 1;  ///< pixels: N computes one of N x N pixels; the others are blurred from similar ones
  double distance_m = 0;  ///< the distance at which occlusion has fallen off to nothing; 0: a twentieth of
                          ///< the scene's diagonal
  int positions = 4225;   ///< field entries on the bounding sphere, rounded to a number that the map offers
  int directions = 1024;  ///< inward, per position; rounded to a square number
  int bits = 8;           ///< per stored distance: 1, 8 or 32
  bool deforming =
      true;  ///< geometry that deforms has no field: cast rays at it (true), or leave it out (false)
  std::filesystem::path cache;  ///< folder where fields, surface samples and trees are kept; empty: nowhere
  int memory_mb = 512;  ///< of 2^20 bytes: fields and surface samples together, at most; 1 to 1,000,000
  SimdLevel simd = SimdLevel::automatic;  ///< the values do not depend on it
};

/// Called now and then while something long is built: what it is, and how much of it is done, 0..1.
using AoProgress = std::function<void(std::string_view what, double done)>;

/// The work that ambient occlusion did.
struct AoStats {
  std::uint64_t points = 0;        ///< points or vertices computed
  std::uint64_t objects = 0;       ///< rigid objects in reach of a visible point
  std::uint64_t fields_built = 0;  ///< in this frame
  std::uint64_t field_bytes = 0;   ///< memory of all fields, at the end
  std::uint64_t sample_bytes = 0;  ///< of all surface samples, at the end
  std::uint64_t peak_bytes = 0;    ///< the most that both took together, in any frame so far
  std::uint64_t lookups = 0;       ///< rays answered by a field
  std::uint64_t rays_cast = 0;     ///< rays answered by casting
  std::uint64_t cache_cells = 0;   ///< surface samples in memory
  double error_255 = 0;            ///< adaptive: estimate of the picture's RMS error, in 1/255
};

}  // namespace tenebra
