// Steadiness of adaptive occlusion: changes of value at undisturbed pixels.
#pragma once

#include <string>
#include <vector>

#include <tenebra/expected.h>
#include <tenebra/scene.h>
#include "bench/ao/ao_session.h"

namespace tenebra::bench {

/// Frames from `first` on, seen by the camera of the first of them: by how much the default's values change
/// at pixels that see the same point, with nothing within the reach that moves. The truth does not change
/// there.
Expected<void> measure_held_view(AoSession& session, const std::string& name, const Scene& scene, int first,
                                 std::vector<std::vector<std::string>>& rows);

}  // namespace tenebra::bench
