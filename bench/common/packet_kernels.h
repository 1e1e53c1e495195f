// The sampling contestants' arithmetic, sixteen rays at a time: directions and weights before Embree is
// asked, sums afterwards. In vector code, so that their time is Embree's own.
#pragma once

#include "ao/reference/embree.h"

namespace tenebra::bench {

/// Where sixteen rays start. World space.
struct alignas(64) ReceiverPacket {
  float x[16], y[16], z[16];     ///< lifted off the surface
  float nx[16], ny[16], nz[16];  ///< shading normals, unit; zero: no ray
  float gx[16], gy[16], gz[16];  ///< normals of the triangles, on the side that is seen
};

struct alignas(64) RayPacket16 {
  RTCRay16 rays;
  int valid[16];     ///< -1: to be traced
  float weight[16];  ///< cos cos / r^2; 0 where not valid
};

struct PacketKernels {
  /// Rays from the receivers to sixteen points of a light that shines along (lx, ly, lz). False: none to
  /// trace. Origins, tnear and times of `rays` are left alone.
  bool (*aim)(const ReceiverPacket& from, const float* x, const float* y, const float* z, float lx, float ly,
              float lz, RayPacket16& out);
  /// sums[i] += weight[i] where ray i met nothing.
  void (*gather)(const RayPacket16& traced, float* sums);
};

/// For the best instructions of this machine.
PacketKernels packet_kernels();

}  // namespace tenebra::bench
