// Where every node is at one instant.
#pragma once

#include <tenebra/frame_geometry.h>

namespace tenebra::scene {

/// Nodes of `scene` in clip `clip` (-1 or out of range: the rest pose) at `time_s`, in linear time and
/// without recursion. `out` keeps its capacity.
void evaluate_pose(const Scene& scene, int clip, double time_s, Pose& out);

}  // namespace tenebra::scene
