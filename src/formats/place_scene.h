// Places a scene that an importer has read in its file's own coordinates.
#pragma once

#include <tenebra/scene.h>
#include "formats/placement.h"

namespace tenebra::formats {

/// Subtracts the offset of `placement` from the scene's roots, keys of their animations included, which is
/// exact where they carry it; what the first clip shows at its start decides an automatic one. Another up
/// axis or unit than Y and metres becomes a node above the roots. With a unit go what no node scales: near
/// planes, heights of views, ranges of lights, and candela by its square, so that pictures stay the same.
void place_scene(const Placement& placement, Scene& scene);

/// Adds the warning of warn_of_floats for a scene that has been placed, whose vertices are floats in their
/// nodes; `of_places`: the nodes' places too.
void warn_of_stored_floats(bool of_places, Scene& scene);

/// Adds a warning where the contact tolerance of the scene's coordinates, as the first clip begins, is more
/// than a millimetre or a thousandth of the longest side.
void warn_of_tolerance(Scene& scene);

}  // namespace tenebra::formats
