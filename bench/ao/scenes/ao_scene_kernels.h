// The opponent's arithmetic, sixteen pixels at a time, in vector code, so that the work besides Embree costs
// little.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ao/reference/embree.h"
#include "bench/ao/scenes/ao_scene_pattern.h"

namespace tenebra::bench {

/// Sixteen points that rays start from.
struct alignas(64) AoPointPacket {
  float x[16], y[16], z[16];     ///< on their triangles; lifted by `frame`
  float nx[16], ny[16], nz[16];  ///< shading normals, unit
  float ax[16], ay[16], az[16];  ///< edges of the triangles, corners 1 - 0 and 2 - 0; by `frame` the first
  float bx[16], by[16], bz[16];  ///< becomes the face's unit normal on the seen side
  float tx[16], ty[16], tz[16];  ///< unit tangents, by `frame`
  float ux[16], uy[16], uz[16];
  std::int32_t valid[16];  ///< -1: traced
};

template <class Hits>
struct AoRayCode {
  /// Rays of lanes first ... along the pattern: directions turned to the normals, mirrored at the faces, to
  /// be traced up to `reach`. Origins are those that `begin` wrote.
  void (*spread)(const PatternRow& row, const AoPointPacket& points, int first, float reach, Hits& rays);
  void (*begin)(const AoPointPacket& points, int first, Hits& rays);
  /// sums[i] += distance of what ray first + i met, or the reach.
  void (*gather)(const Hits& rays, int first, float* sums);
};

/// The weights of a 5x5 filter with holes (a-trous, Dammertz et al. 2010): how alike two pixels have to be.
struct AoFilterWeights {
  float tap[3];    ///< of the middle and one and two steps away, each way
  float plane;     ///< 1 / distance from the pixel's plane at which weights vanish
  float distance;  ///< 1 / squared distance in space at which they vanish
  float bend;      ///< 1 / (1 - cosine) between normals at which they vanish
};

/// Pixels of a picture coordinate by coordinate, with a border of pixels that are like none.
struct AoPixelPlanes {
  const float *x, *y, *z, *nx, *ny, *nz;
};

struct AoSceneKernels {
  /// Faces from edges, tangents from normals, and points lifted off their faces by `lift` x their largest
  /// coordinate or `least`, whichever is more.
  void (*frame)(AoPointPacket& points, float lift, float least);
  AoRayCode<RTCRayHit16> sixteen;
  AoRayCode<RTCRayHit8> eight;
  AoRayCode<RTCRayHit4> four;
  /// Sixteen pixels from `at` on: means of `from` over 5x5 pixels `step` apart, a row being `pitch` wide.
  void (*filter)(const AoPixelPlanes& pixels, const float* from, float* to, std::ptrdiff_t at,
                 std::ptrdiff_t pitch, int step, const AoFilterWeights& weights);
  /// Sixteen pixels from `at` on: means of `from` at `count` neighbours of theirs among other pixels, at +
  /// offset. Bits of those that have no neighbour like them.
  std::uint32_t (*join)(const AoPixelPlanes& pixels, const AoPixelPlanes& others, const float* from,
                        float* to, std::ptrdiff_t at, const std::ptrdiff_t* offsets, int count,
                        const AoFilterWeights& weights);
};
AoSceneKernels ao_scene_kernels();

}  // namespace tenebra::bench
