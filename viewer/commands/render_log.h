// What a render reports: the settings above the log, and the summary at the end.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "options/raster_options.h"
#include "render/log/frame_log.h"
#include "shared/render_plan.h"

namespace tenebra::viewer {

/// The settings of shadows and ambient occlusion, of the methods that are on; nothing is left open.
std::vector<render::LogSetting> describe_method(const MethodOptions& method);

/// Machine, OpenGL renderer, threads, vector instructions, scene and every setting, as the log's comment
/// lines. `first_frame`: geometry of the first frame, for its counts.
std::vector<render::LogSetting> describe_render(const RenderPlan& plan, const RenderOptions& options,
                                                const RasterNames& raster, const FrameGeometry& first_frame);

/// What is kept of a frame until the end: there may be a million of them.
struct TimedFrame {
  int frame = 0;
  FrameTimings timings;
};

/// Median, 95th and 99th percentile and worst frame of the stages that took time, as a table; "" without
/// frames.
std::string summary_table(std::span<const TimedFrame> frames);

}  // namespace tenebra::viewer
