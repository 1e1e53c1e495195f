// The true ambient light of a view: thousands of rays per point, kept on disk from run to run.
//
// Openness of a point: the mean over directions, cosine-weighted about the shading normal, of
// min(1, distance of the nearest hit / reach), that is one less the mean of max(0, 1 - distance / reach).
// Directions below the triangle's plane are mirrored at it. All triangles that cast shadows hide, both sides.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <tenebra/visible_points.h>

namespace tenebra::bench {

/// Pixels at which it is known. Lattice: every step-th pixel of every step-th row, the first at step / 2. A
/// step that shares no factor with 2 and 4 meets all phases of patterns that repeat every four pixels.
struct AoSceneTruth {
  int step = 1;
  std::vector<std::size_t> pixels;  ///< ascending; those with a triangle, an area and a normal
  std::vector<float> open;          ///< one for each pixel, 0 closed .. 1 open
};

struct TruthQuestion {
  TriangleView triangles;
  const VisiblePoints& points;         ///< with positions
  std::span<const glm::vec3> normals;  ///< one for each pixel
  float reach_m;
  int rays = 4096;  ///< a multiple of 16
  int step = 1;
};

/// Asked of Embree, on all threads; the same bits for any number.
AoSceneTruth cast_truth(const TruthQuestion& question);

/// The same, but what `folder` already holds of the same question is taken from there, and what is found is
/// kept: one file with one float for each pixel, "ao_NAME_WxH_KEY.truth", where KEY is a hash of the
/// triangles, the points, the normals, the reach, the rays and the definition. So a file is never used for
/// another question, and runs with different steps share one. An empty folder: nothing is kept. What cannot
/// be read or written is made anew.
AoSceneTruth find_truth(const TruthQuestion& question, const std::string& name,
                        const std::filesystem::path& folder);

/// $XDG_CACHE_HOME/tenebra/bench, else ~/.cache/tenebra/bench, else a folder for temporary files.
std::filesystem::path default_truth_folder();

/// A unit normal of the triangle on the side of `normal`; zero where it has no area.
glm::vec3 face_on_side(const TriangleView& triangles, std::uint32_t triangle, const glm::vec3& normal);

/// How far off its plane a ray has to start so that it does not meet what only rounding makes it touch.
float start_lift(const glm::dvec3& position, float largest_coordinate);
/// Of the vertices that triangles have.
float largest_coordinate(const TriangleView& triangles);

}  // namespace tenebra::bench
