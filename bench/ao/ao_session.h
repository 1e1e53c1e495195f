// One run of `tenebra-bench ao`: what its parts share and what they add to the last lines.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ao/field/displacement_field.h"
#include "bench/common/bench_parts.h"
#include "io/image.h"

namespace tenebra::bench {

/// The last lines; parts that were left out leave theirs empty.
struct AoHeadline {
  std::optional<double> outside_rms_255, paper_rms_255, inside_rms_255, surface_rms_255;
  std::optional<double> lookup_speedup, frame_speedup, frame_speedup_half, growth_1k_to_1m;
  std::optional<double> bytes;
  std::optional<double> scene_rms_worst, scene_p99_worst, scene_max_worst;
  std::optional<double> exact_rms_worst, exact_max_worst;
  std::optional<double> scene_speedup_geomean, scene_speedup_worst, exact_speedup_geomean;
  std::optional<double> first_frame_warm;
  std::optional<double> flicker_mean_255;
  std::optional<double> estimate_worst;  ///< only where the library gives an estimate
};

/// What only the part "scenes" reads.
struct AoSceneOptions {
  std::vector<std::string> views;      ///< parts of names; empty: all
  std::vector<int> sizes;              ///< pixels each way; empty: by effort
  std::filesystem::path truth_folder;  ///< where truths are kept; empty: nowhere
  std::filesystem::path pictures;      ///< folder; empty: none are written
  bool only_ours = false;              ///< no opponent
  int truth_step = 0;                  ///< of the truth's lattice; 0: by effort
};

struct AoSession {
  BenchOptions options;
  Effort effort = Effort::full;
  Report report;
  AoSceneOptions scenes{};
  AoHeadline headline{};
  std::vector<double> scene_speedups{}, exact_speedups{};  ///< one for each view and size
  std::vector<std::string> notes{};  ///< sentences: what was missing, replaced or out of bounds
  std::vector<std::pair<std::string, io::Image8>>
      pictures{};  ///< to be written as STEM_name.png beside the CSV

  /// Tables of the default size, or small ones where figures mean nothing.
  ao::FieldSettings table(FieldLayout layout = FieldLayout::chords) const {
    if (effort == Effort::tiny) return {layout, 64, 64, 8};
    return {.layout = layout};
  }
  AoConfig field_config(int rays, double reach_m) const {
    return {.mode = AoMode::field,
            .rays = rays,
            .distance_m = reach_m,
            .positions = table().positions,
            .directions = table().directions};
  }

  /// The value for this run's effort.
  template <class T>
  T by_effort(T tiny, T quick, T full) const {
    return effort == Effort::tiny ? tiny : effort == Effort::quick ? quick : full;
  }
};

/// The larger of what was found so far and `value`.
inline void keep_largest(std::optional<double>& kept, double value) {
  if (!kept || !(value <= *kept)) kept = value;
}
/// The smaller of what was found so far and `value`.
inline void keep_least(std::optional<double>& kept, double value) {
  if (!kept || !(value >= *kept)) kept = value;
}

// The parts.
Expected<void> measure_errors(AoSession& session);   ///< Figure 6 and the memory table
Expected<void> measure_surface(AoSession& session);  ///< on the object
Expected<void> measure_growth(AoSession& session);   ///< Figure 8: triangles
Expected<void> measure_many(AoSession& session);     ///< Figure 8: objects
Expected<void> measure_lookups(AoSession& session);  ///< against Embree's nearest hits
Expected<void> measure_frames(AoSession& session);   ///< whole frames against Embree
Expected<void> measure_flicker(AoSession& session);  ///< animated scenes
Expected<void> measure_scenes(AoSession& session);   ///< whole scenes against truth and filtered rays

}  // namespace tenebra::bench
