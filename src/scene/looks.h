// What is taken from the looks of a scene's surfaces before it is drawn.
#pragma once

#include <tenebra/scene.h>

namespace tenebra::scene {

/// Takes pictures, gloss and colours of vertices from all surfaces: they are diffuse in their factors, and
/// those whose emission had a picture shine no more. See-through surfaces keep what light passes through them
/// by, so that every shadow stays what it was; alpha masks must have been cut out before.
void make_plain(Scene& scene);

/// Where every triangle shines by an emissive factor of exactly 1, 1, 1 and no picture, that factor is what
/// is left of a lost picture, and all would be drawn pure white: takes it away, and says so in
/// scene.warnings.
void leave_out_blank_emission(Scene& scene);

}  // namespace tenebra::scene
