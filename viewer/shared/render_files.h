// The files that a render writes, known before it begins.
#pragma once

#include <vector>

#include "shared/files_apart.h"
#include "shared/render_plan.h"

namespace tenebra::viewer {

/// The pictures and masks of one frame. Masks of emissive meshes, whose number is not known yet, are left
/// out.
std::vector<OutputName> files_of_frame(const RenderPlan& plan, const RenderOptions& options, int frame);

/// Those of all frames, the log and the trace. Refers to the plan and the options.
OutputNames files_of_render(const RenderPlan& plan, const RenderOptions& options);

}  // namespace tenebra::viewer
