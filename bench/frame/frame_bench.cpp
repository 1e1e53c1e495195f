// tenebra-bench frame: from a scene and a time to a picture, beside the renderer that one would write on
// Embree; and what writing the pictures adds.
#include <array>

#include "bench/frame/frame_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{BenchPart<FrameSession>{"scenes", measure_frames},
                           BenchPart<FrameSession>{"files", measure_frame_files}};

std::vector<LastLine> last_lines(const FrameSession& session) {
  const FrameHeadline& h = session.headline;
  return {{"unshaded_geomean", h.unshaded_geomean, 3}, {"unshaded_worst", h.unshaded_worst, 3},
          {"ratio_geomean", h.ratio_geomean, 3},       {"ratio_worst", h.ratio_worst, 3},
          {"city_per_second", h.city_per_second, 2},   {"render_over_frames", h.render_over_frames, 3}};
}

constexpr const char* footer =
    "ratio: Tenebra's time for a frame over the opponent's, from evaluating the scene to the picture in\n"
    "memory, as consecutive frames move, hard shadows of all lights, glass as opaque on both sides. The\n"
    "opponent traces packets of 4, 8 or 16 primary rays and, from each, shadow rays of all lights through\n"
    "one of Embree's trees, built anew, refitted or in two levels: whatever is fastest on the view. Both\n"
    "sides shade by the same code, which is counted on both; unshaded is the ratio without it. Pictures\n"
    "must agree in all but a small share of the pixels. city_per_second: Tenebra's frames per second of\n"
    "city at 1024x1024. render_over_frames: the time of `tenebra render scenes/city.glb --frames 0:60\n"
    "--size 1024x1024 --antialias 1 --terminator flat --tone none` with pictures over that without.";

}  // namespace

void add_frame_command(CLI::App& program, Run& run) {
  add_session_command<FrameSession>(
      program, run,
      {"frame", "Whole frames, from a time to a picture, compared with a renderer on Embree", footer}, parts,
      last_lines);
}

}  // namespace tenebra::bench
