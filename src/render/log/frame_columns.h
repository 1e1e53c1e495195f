// The columns of the frame log: name and place of every stage time and count, and the lists of stages. The
// log, the trace and the summary read from this one table.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string_view>

#include <tenebra/ao_config.h>
#include <tenebra/frame_timings.h>
#include <tenebra/hard_config.h>
#include <tenebra/soft_config.h>
#include "render/antialias/antialias_stats.h"

namespace tenebra::render {

struct TimingColumn {
  std::string_view name;
  double FrameTimings::*value;
};

/// The stages in the order in which a frame runs them; their names are those of FrameTimings without the
/// unit.
inline constexpr std::array frame_stages{
    TimingColumn{"evaluate", &FrameTimings::evaluate_ms},
    TimingColumn{"raster", &FrameTimings::raster_ms},
    TimingColumn{"readback", &FrameTimings::readback_ms},
    TimingColumn{"points", &FrameTimings::points_ms},
    TimingColumn{"ao_build", &FrameTimings::ao_build_ms},
    TimingColumn{"ao", &FrameTimings::ao_ms},
    TimingColumn{"rays", &FrameTimings::rays_ms},
    TimingColumn{"sort", &FrameTimings::sort_ms},
    TimingColumn{"build", &FrameTimings::build_ms},
    TimingColumn{"traverse", &FrameTimings::traverse_ms},
    TimingColumn{"shaft", &FrameTimings::shaft_ms},
    TimingColumn{"init", &FrameTimings::init_ms},
    TimingColumn{"query", &FrameTimings::query_ms},
    TimingColumn{"irradiance", &FrameTimings::irradiance_ms},
    TimingColumn{"tint", &FrameTimings::tint_ms},
    TimingColumn{"writeback", &FrameTimings::writeback_ms},
    TimingColumn{"composite", &FrameTimings::composite_ms},
    TimingColumn{"layer", &FrameTimings::layer_ms},
    TimingColumn{"antialias", &FrameTimings::antialias_ms},
};

/// Some of frame_stages, by their places.
using StageSet = std::bitset<frame_stages.size()>;

/// One rendered frame as it is logged.
struct FrameRecord {
  int frame = 0;      ///< number within the clip, from 0
  double time_s = 0;  ///< time within the clip
  FrameTimings timings;
  TraceStats stats;
  SoftStats soft;
  AoStats ao;
  AntialiasStats antialias;
  double soft_error = 0;    ///< that was asked for: RenderSettings::soft.error_255; 0: exact
  double ao_error = 0;      ///< likewise, with --ao adaptive; 0: without
  std::uint64_t tries = 1;  ///< draws of this frame, the one that was kept among them
  StageSet asked;           ///< stages that the settings ask for: stage_sets.h
};

/// A count of one of the methods.
struct CountColumn {
  std::string_view name;
  std::uint64_t (*value)(const FrameRecord& record);
};

/// An error that was asked for, or the estimate of the one that was reached.
struct EstimateColumn {
  std::string_view name;
  double (*value)(const FrameRecord& record);
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
    CountColumn{"rays", [](const FrameRecord& r) { return r.stats.rays; }},
    CountColumn{"triangles", [](const FrameRecord& r) { return r.stats.triangles; }},
    CountColumn{"nodes", [](const FrameRecord& r) { return r.stats.nodes; }},
    CountColumn{"leaf_tests", [](const FrameRecord& r) { return r.stats.leaf_tests; }},
    CountColumn{"shadowed_pixels", [](const FrameRecord& r) { return r.stats.shadowed_pixels; }},
    CountColumn{"lit_pixels", [](const FrameRecord& r) { return r.stats.lit_pixels; }},
    CountColumn{"early_accepts", [](const FrameRecord& r) { return r.stats.early_accepts; }},
    CountColumn{"float_unknown", [](const FrameRecord& r) { return r.stats.float_unknown; }},
    CountColumn{"double_unknown", [](const FrameRecord& r) { return r.stats.double_unknown; }},
    CountColumn{"degenerate_triangles", [](const FrameRecord& r) { return r.stats.degenerate_triangles; }},
    CountColumn{"tree_bytes", [](const FrameRecord& r) { return r.stats.tree_bytes; }},
    CountColumn{"lights_tiles", [](const FrameRecord& r) { return r.stats.lights_tiles; }},
    CountColumn{"lights_cones", [](const FrameRecord& r) { return r.stats.lights_cones; }},
};

/// Counts of the other methods, after all times.
inline constexpr std::array method_columns{
    CountColumn{"soft_groups", [](const FrameRecord& r) { return r.soft.groups; }},
    CountColumn{"soft_points_lit", [](const FrameRecord& r) { return r.soft.points_lit; }},
    CountColumn{"soft_points_dark", [](const FrameRecord& r) { return r.soft.points_dark; }},
    CountColumn{"soft_points_penumbra", [](const FrameRecord& r) { return r.soft.points_penumbra; }},
    CountColumn{"soft_candidates", [](const FrameRecord& r) { return r.soft.candidates; }},
    CountColumn{"soft_points_bsp", [](const FrameRecord& r) { return r.soft.points_bsp; }},
    CountColumn{"soft_points_clip", [](const FrameRecord& r) { return r.soft.points_clip; }},
    CountColumn{"soft_points_silhouette", [](const FrameRecord& r) { return r.soft.points_silhouette; }},
    CountColumn{"soft_fragments", [](const FrameRecord& r) { return r.soft.fragments; }},
    CountColumn{"soft_tree_nodes", [](const FrameRecord& r) { return r.soft.tree_nodes; }},
    CountColumn{"soft_peak_tree_bytes", [](const FrameRecord& r) { return r.soft.peak_tree_bytes; }},
    CountColumn{"ao_points", [](const FrameRecord& r) { return r.ao.points; }},
    CountColumn{"ao_objects", [](const FrameRecord& r) { return r.ao.objects; }},
    CountColumn{"ao_fields_built", [](const FrameRecord& r) { return r.ao.fields_built; }},
    CountColumn{"ao_field_bytes", [](const FrameRecord& r) { return r.ao.field_bytes; }},
    CountColumn{"ao_sample_bytes", [](const FrameRecord& r) { return r.ao.sample_bytes; }},
    CountColumn{"ao_peak_bytes", [](const FrameRecord& r) { return r.ao.peak_bytes; }},
    CountColumn{"ao_lookups", [](const FrameRecord& r) { return r.ao.lookups; }},
    CountColumn{"ao_rays_cast", [](const FrameRecord& r) { return r.ao.rays_cast; }},
    CountColumn{"ao_cache_cells", [](const FrameRecord& r) { return r.ao.cache_cells; }},
    CountColumn{"antialias_pixels", [](const FrameRecord& r) { return r.antialias.pixels; }},
    CountColumn{"antialias_samples", [](const FrameRecord& r) { return r.antialias.samples; }},
    CountColumn{"soft_points_sampled", [](const FrameRecord& r) { return r.soft.points_sampled; }},
    CountColumn{"soft_sampled_rays", [](const FrameRecord& r) { return r.soft.sampled_rays; }},
    CountColumn{"soft_groups_changed", [](const FrameRecord& r) { return r.soft.groups_changed; }},
    CountColumn{"tries", [](const FrameRecord& r) { return r.tries; }},
};

/// Errors, after the counts of the methods: estimates, then those that were asked for. 0 where the method has
/// none.
inline constexpr std::array estimate_columns{
    EstimateColumn{"ao_error_255", [](const FrameRecord& r) { return r.ao.error_255; }},
    EstimateColumn{"soft_error_255", [](const FrameRecord& r) { return r.soft.error_255; }},
    EstimateColumn{"ao_error", [](const FrameRecord& r) { return r.ao_error; }},
    EstimateColumn{"soft_error", [](const FrameRecord& r) { return r.soft_error; }},
};

/// Times that close a row of the log, after the counts.
inline constexpr std::array closing_timings{
    TimingColumn{"evaluate_ms", &FrameTimings::evaluate_ms},
    TimingColumn{"points_ms", &FrameTimings::points_ms},
    TimingColumn{"shaft_ms", &FrameTimings::shaft_ms},
    TimingColumn{"init_ms", &FrameTimings::init_ms},
    TimingColumn{"query_ms", &FrameTimings::query_ms},
    TimingColumn{"irradiance_ms", &FrameTimings::irradiance_ms},
    TimingColumn{"ao_build_ms", &FrameTimings::ao_build_ms},
    TimingColumn{"ao_ms", &FrameTimings::ao_ms},
    TimingColumn{"tint_ms", &FrameTimings::tint_ms},
    TimingColumn{"layer_ms", &FrameTimings::layer_ms},
    TimingColumn{"antialias_ms", &FrameTimings::antialias_ms},
};

/// Lists of stages by name, with blanks between them, at the end of a row: those that the settings ask for
/// and that the frame had no work for, and those that ran. The only columns that are not numbers.
inline constexpr std::array list_columns{std::string_view("not_needed"), std::string_view("ran")};

}  // namespace tenebra::render
