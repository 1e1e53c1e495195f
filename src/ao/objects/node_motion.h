// Which nodes a scene's clips move, and how.
#pragma once

#include <vector>

#include <tenebra/scene.h>

namespace tenebra::ao {

struct NodeMotion {
  std::vector<int> mover;     ///< deepest ancestor (or the node itself) that a clip moves; -1: it stands
  std::vector<bool> resized;  ///< a clip changes the node's own scale
};

/// A channel counts if its values differ from key to key.
NodeMotion find_motion(const Scene& scene);

}  // namespace tenebra::ao
