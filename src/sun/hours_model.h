// The hours as a model that other programs show: each face or cell in its colour, with its number.
#pragma once

#include "formats/glb_additions.h"
#include "sun/colour_scale.h"

namespace tenebra::sun {

struct HoursModel {
  Scene scene;                      ///< one unlit material; where the study's scene is
  formats::GlbAdditions additions;  ///< _SUN_HOURS or _SUN_SUM (-1: was not asked about), and the scale
};

/// A mesh for each node of the study's scene as it stands at the study's instant, three vertices to a
/// triangle, grey where nothing was asked; and of cells one more, "ground". Fails for points.
Expected<HoursModel> model_of(const Study& study, const ColourScale& scale);

}  // namespace tenebra::sun
