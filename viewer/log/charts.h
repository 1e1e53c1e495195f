// Frame times over the animation, drawn as SVG for a page.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "log/log_file.h"

namespace tenebra::viewer {

/// A log as a line of a chart; `name` for the reader.
struct ChartedLog {
  std::string name;
  const LogFile* log = nullptr;
};

/// Milliseconds of whole frames over their numbers, a line for each log (classes "line0", "line1"). First
/// frames of chunks are rings; what is above the scale, which the other frames set, is a triangle at the top.
std::string total_chart(std::span<const ChartedLog> logs);

/// The stages that take most time in the logs, at most nine, in the order in which frames run them; the last
/// name is that of all others together.
std::vector<std::string> charted_stages(std::span<const ChartedLog> logs);

/// Milliseconds of these stages over the animation, stacked (classes "stage0", "stage1", ... and "stage9" for
/// the others). `worst_ms`: what the scale must hold.
std::string stage_chart(const LogFile& log, const std::vector<std::string>& stages, double worst_ms);

/// The largest total of frames that open no chunk; of all frames if there are no others. Milliseconds.
double usual_worst_ms(const LogFile& log);

}  // namespace tenebra::viewer
