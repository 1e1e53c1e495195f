// Everything that the bytes of a render's pictures depend on: scene, settings and program. `render --resume`
// continues only if they are the same.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/log/frame_log.h"
#include "shared/render_plan.h"

namespace tenebra::viewer {

/// What describe_render does not say: hashes of the program and of the files read, frames per second, the
/// names of the outputs. Fails where a file cannot be read.
Expected<std::vector<render::LogSetting>> describe_sources(const RenderPlan& plan,
                                                           const RenderOptions& options);

/// Those of a log's settings that pictures follow from: all but the machine, threads, paths and what the
/// chosen frames alone decide.
std::vector<render::LogSetting> identity_of(std::span<const render::LogSetting> settings);

/// "size 320x240, found 640x480" of the first that differs; none: they are the same.
std::optional<std::string> first_difference(std::span<const render::LogSetting> was,
                                            std::span<const render::LogSetting> is);

}  // namespace tenebra::viewer
