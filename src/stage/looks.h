// Changes that simplify the looks of a scene's surfaces before it is drawn.
#pragma once

#include <tenebra/scene.h>

namespace tenebra::stage {

/// Removes pictures, gloss and vertex colours from all surfaces: they become diffuse with their factors, and
/// those whose emission had a picture emit nothing. See-through surfaces keep their transmittance, so that
/// every shadow stays the same; alpha masks must have been cut out before.
void make_plain(Scene& scene);

/// Where every triangle shines by an emissive factor of exactly 1, 1, 1 and no picture, that factor remains
/// from a lost picture, and everything would be drawn pure white: removes it, and says so in scene.warnings.
void leave_out_blank_emission(Scene& scene);

}  // namespace tenebra::stage
