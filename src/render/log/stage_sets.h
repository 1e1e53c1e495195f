// Which stages of a frame its settings ask for, which ran, and which the scene turned out not to need.
#pragma once

#include <string>

#include "render/log/frame_columns.h"
#include "render/renderer.h"

namespace tenebra::render {

/// The stages that a frame of some scene may run with these settings. `by_gl`: FrameRaster::is_gl().
StageSet asked_stages(const RenderSettings& settings, bool by_gl);

/// The stages that took time.
StageSet stages_run(const FrameTimings& timings);

/// Their names in the order of frame_stages, with a blank between two; "" for none.
std::string stage_names(StageSet stages);

}  // namespace tenebra::render
