// What the tree of nodes in the panel keeps from frame to frame of the window.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "session/staged_scene.h"

namespace tenebra::viewer {

struct TreeRow {
  int node = -1;
  int depth = 0;
};

struct SceneTree {
  std::shared_ptr<const session::StagedScene> scene;  ///< that the lists below are of
  std::vector<std::vector<int>> children;             ///< of node i at i + 1; the roots at 0
  std::vector<char> open;                             ///< one for each node
  std::array<char, 128> filter{};
  int shown_node = -1;  ///< the selected node that was scrolled to
};

}  // namespace tenebra::viewer
