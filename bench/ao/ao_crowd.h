// Frames full of rigid objects that move over a floor: a scene made for the measurements, seen by cameras.
#pragma once

#include <vector>

#include "bench/ao/ao_objects.h"
#include "bench/common/bench_frame.h"

namespace tenebra::bench {

/// `count` instances of the meshes in turn, `spacing_m` apart in rows of ten on a floor of 60 m, each walking
/// its round and turning about the vertical for ten seconds. Meshes have no normals: faces are flat.
Scene make_crowd(const std::vector<Object>& meshes, int count, double spacing_m);

struct CrowdView {
  const char* name;
  const char* plot;  ///< name of its file
  double spacing_m;
  glm::vec3 eye, target;
};
/// All of the crowd from afar, bodies apart; and from near, bounding spheres overlapping.
inline constexpr CrowdView far_view{"far view", "frames_far", 2.4, {0, 11, 19}, {0, 0, 0.5f}};
inline constexpr CrowdView near_view{"near view", "frames_near", 1.9, {0.3f, 2.2f, 6.2f}, {0, 0.5f, 0}};

/// The crowd at `time_s` as `view` sees it.
void see_crowd(const Scene& crowd, const CrowdView& view, double time_s, int size, BenchFrame& out);

}  // namespace tenebra::bench
