// A frame as an OpenEXR picture: colours, layers and the header (docs/exr.md).
#pragma once

#include <span>
#include <string>

#include "render/log/frame_log.h"
#include "shared/render_plan.h"

namespace tenebra::viewer {

/// The bytes of the file. `settings`: those that pictures follow from (identity_of). Fails with a phrase.
Expected<std::string> exr_of_frame(const RenderPlan& plan, const RenderOptions& options,
                                   std::span<const render::LogSetting> settings, const PlannedFrame& frame,
                                   const render::FrameResult& result);

/// The camera as OpenEXR's header has it; `size` of the picture that the rays are of.
io::exr::CameraMatrices camera_matrices(const ViewRays& view, Size size);

}  // namespace tenebra::viewer
