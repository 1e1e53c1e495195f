// The columns of the frame log: name and place of every stage time and count. The log, the trace and the
// summary read from this one table.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "base/frame_timings.h"

namespace tenebra {

/// One rendered frame as it is logged.
struct FrameRecord {
  int frame = 0;      ///< number within the clip, from 0
  double time_s = 0;  ///< time within the clip
  FrameTimings timings;
  TraceStats stats;
};

struct TimingColumn {
  std::string_view name;
  double FrameTimings::*value;
};

struct CountColumn {
  std::string_view name;
  std::uint64_t TraceStats::*value;
};

/// Times that open a row of the log, after frame and time_s.
inline constexpr std::array leading_timings{
    TimingColumn{"raster_ms", &FrameTimings::raster_ms},
    TimingColumn{"readback_ms", &FrameTimings::readback_ms},
    TimingColumn{"rays_ms", &FrameTimings::rays_ms},
    TimingColumn{"sort_ms", &FrameTimings::sort_ms},
    TimingColumn{"build_ms", &FrameTimings::build_ms},
    TimingColumn{"traverse_ms", &FrameTimings::traverse_ms},
    TimingColumn{"writeback_ms", &FrameTimings::writeback_ms},
    TimingColumn{"composite_ms", &FrameTimings::composite_ms},
    TimingColumn{"total_ms", &FrameTimings::total_ms},
};

inline constexpr std::array count_columns{
    CountColumn{"rays", &TraceStats::rays},
    CountColumn{"triangles", &TraceStats::triangles},
    CountColumn{"nodes", &TraceStats::nodes},
    CountColumn{"leaf_tests", &TraceStats::leaf_tests},
    CountColumn{"shadowed_pixels", &TraceStats::shadowed_pixels},
    CountColumn{"lit_pixels", &TraceStats::lit_pixels},
    CountColumn{"early_accepts", &TraceStats::early_accepts},
    CountColumn{"float_unknown", &TraceStats::float_unknown},
    CountColumn{"double_unknown", &TraceStats::double_unknown},
    CountColumn{"degenerate_triangles", &TraceStats::degenerate_triangles},
    CountColumn{"tree_bytes", &TraceStats::tree_bytes},
};

/// Times that close a row of the log, after the counts.
inline constexpr std::array closing_timings{
    TimingColumn{"evaluate_ms", &FrameTimings::evaluate_ms},
    TimingColumn{"points_ms", &FrameTimings::points_ms},
};

/// The stages in the order in which a frame runs them; their names are those of FrameTimings without the
/// unit.
inline constexpr std::array frame_stages{
    TimingColumn{"evaluate", &FrameTimings::evaluate_ms},
    TimingColumn{"raster", &FrameTimings::raster_ms},
    TimingColumn{"readback", &FrameTimings::readback_ms},
    TimingColumn{"points", &FrameTimings::points_ms},
    TimingColumn{"rays", &FrameTimings::rays_ms},
    TimingColumn{"sort", &FrameTimings::sort_ms},
    TimingColumn{"build", &FrameTimings::build_ms},
    TimingColumn{"traverse", &FrameTimings::traverse_ms},
    TimingColumn{"writeback", &FrameTimings::writeback_ms},
    TimingColumn{"composite", &FrameTimings::composite_ms},
};

}  // namespace tenebra
