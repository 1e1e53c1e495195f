// Where every node is at one instant.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace tenebra {

struct Scene;

struct NodePose {
  glm::dvec3 translation{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
  glm::dvec3 scale{1.0};
  glm::dmat4 to_world{1.0};
  bool visible = true;           ///< its own flag and those of its ancestors
  std::size_t first_weight = 0;  ///< in Pose::weights: one a morph target of the node's mesh
};

struct Pose {
  std::vector<NodePose> nodes;
  std::vector<double> weights;
  std::vector<double> track_values;  ///< scratch
};

/// Nodes of `scene` in clip `clip` (-1 or out of range: the rest pose) at `time_s`, in linear time and
/// without recursion. `out` keeps its capacity.
void evaluate_pose(const Scene& scene, int clip, double time_s, Pose& out);

}  // namespace tenebra
