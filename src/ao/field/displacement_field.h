// Displacement fields: the distance to a rigid object along every chord of its bounding sphere, sampled once.
// Gaitatzes, Chrysanthou and Papaioannou 2010, section 3 and Algorithm 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include <tenebra/ao_config.h>
#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>
#include "trees/triangle_bvh.h"

namespace tenebra::ao {

struct FieldSettings {
  FieldLayout layout = FieldLayout::chords;
  int positions = 4225;   ///< samples on the sphere; rounded down to a square number
  int directions = 1024;  ///< inward directions per position; rounded down to a square number
  int bits = 8;           ///< of a stored distance: 1, 8 or 32
  friend bool operator==(const FieldSettings&, const FieldSettings&) = default;
};

/// A table of the size that settings ask for. Chords have as many exits as entries: the largest square number
/// whose square is not above positions x directions (4,225 x 1,024: 45^2 x 45^2).
struct FieldShape {
  int position_side = 0;   ///< positions = side^2, cells of the octahedral map
  int direction_side = 0;  ///< directions = side^2; chords: cells of the exit
  std::size_t entries = 0;
  std::size_t bytes = 0;  ///< of the table

  std::size_t positions() const {
    return static_cast<std::size_t>(position_side) * static_cast<std::size_t>(position_side);
  }
  std::size_t directions() const {
    return static_cast<std::size_t>(direction_side) * static_cast<std::size_t>(direction_side);
  }
};
/// Fails, with one sentence, on settings out of range: fewer than 4 or more than 1,048,576 of either, bits
/// other than 1, 8 and 32, a table of more than 2^30 samples or bytes.
Expected<FieldShape> field_shape(const FieldSettings& settings);

/// What a field of this shape takes: its bytes().
std::size_t field_memory(const FieldSettings& settings, const FieldShape& shape);

/// Smallest useful table (0.33 MB): 24^2 x 24^2 chords.
inline constexpr FieldSettings sparse_field{FieldLayout::chords, 576, 576, 8};

/// What bounds a mesh in object space: a sphere (the paper's), or for chords one stretched along the axes
/// to fit long objects better. Unit space is the object space in which it is the unit sphere.
struct Ellipsoid {
  glm::dvec3 centre{0.0};
  glm::dvec3 axes{0.0};  ///< half of its extent along x, y, z
};
/// Measured within 2 % (the method assures 10 %) of the smallest sphere or, of those stretched with the
/// mesh's extents (at most 4 : 1), of the smallest ellipsoid; never too small. Zero axes if there are no
/// triangles.
Ellipsoid bounding_ellipsoid(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                             FieldLayout layout);

/// What one mesh looks like from everywhere outside. Entry (p, d) describes the ray that enters the unit
/// sphere at position p towards direction or exit d: how far beyond the middle of its chord it first meets
/// the object, -1 .. 1 in unit space.
struct DisplacementField {
  FieldLayout layout = FieldLayout::chords;
  int bits = 8;
  FieldShape shape;
  Ellipsoid bound;
  std::vector<std::uint8_t>
      table;                ///< entry (p, d) at p * directions + d; 1 bit: 1 a hit; 8 bits: 0..254 for
                            ///< -1..1, 255 no hit; 32: a float, 2 no hit. Three bytes more at the end.
  std::vector<float> mean;  ///< 1 bit: the mean of all hits from position p; else empty
  std::vector<std::uint32_t> close;  ///< one bit per cell of the cube around the unit sphere (near_cells.h):
                                     ///< set next to the object, at least within a quarter of `cell()`

  /// Width of a cell of the unit sphere, were all of the table's entries chords: what the field resolves.
  float cell() const;
  /// Of all of the above: the memory of a field.
  std::size_t bytes() const {
    return table.size() + mean.size() * sizeof(float) + close.size() * sizeof(std::uint32_t);
  }
};

/// Called by the caller's thread now and then with 0..1.
using FieldProgress = std::function<void(double done)>;

/// Algorithm 1, on all cores; the same bits for any thread count and instruction set. Fails with "stopped" if
/// `stop` was requested, on settings out of range, and on a mesh without a triangle of any area.
Expected<DisplacementField> build_field(std::span<const glm::vec3> positions,
                                        std::span<const glm::uvec3> triangles, const trees::TriangleBvh& bvh,
                                        const FieldSettings& settings, const FieldProgress& progress = {},
                                        const StopFlag* stop = nullptr);

}  // namespace tenebra::ao
