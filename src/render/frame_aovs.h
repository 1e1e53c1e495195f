// Data about the visible surfaces of a frame: what RenderSettings::aovs asks for.
#pragma once

#include "render/aovs.h"
#include "render/centres.h"

namespace tenebra::render {

/// Made from the samples at the pixels' centres and their light. The picture is made without it. `surfaces`:
/// the scene's; they have other colours for a while.
Aovs find_aovs(const Frame& frame, const Centres& centres, shade::SurfaceTable& surfaces);

}  // namespace tenebra::render
