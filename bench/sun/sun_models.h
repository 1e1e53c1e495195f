// Models to count the sun on, and suns.
#pragma once

#include <string>

#include <tenebra/scene.h>
#include "sun/receivers.h"
#include "sun/suns.h"

namespace tenebra::bench {

/// A block of `rows` times `columns` houses with gable roofs, no two alike, on a floor: nodes "houses" and
/// "floor".
Scene houses_scene(int rows, int columns);
/// Hills of `quads` times `quads` squares of 10 m, two triangles each; those of the `middle` times `middle`
/// in the middle are a node of their own, "middle".
Scene terrain_scene(int quads, int middle);

/// In Munich, on one day or on each `every`th of the year 2026.
sun::Suns suns_of_day(double step_min);
sun::Suns suns_of_year(int every, double step_min);

}  // namespace tenebra::bench
