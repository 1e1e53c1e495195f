// tenebra-bench picture: how far anti-aliased pictures are from 256 samples per pixel, what they cost, and
// whether they flicker.
#include <array>

#include "bench/picture/picture_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{BenchPart<PictureSession>{"views", measure_picture_views},
                           BenchPart<PictureSession>{"flicker", measure_picture_flicker}};

std::vector<LastLine> last_lines(const PictureSession& session) {
  const PictureHeadline& h = session.headline;
  return {{"rms_4", h.rms_4, 3},
          {"rms_16", h.rms_16, 3},
          {"cost_4", h.cost_4, 3},
          {"cost_16", h.cost_16, 3},
          {"missed_percent", h.missed_percent, 4},
          {"flicker_16", h.flicker_16, 3}};
}

constexpr const char* footer =
    "rms_N: root mean square in levels of 255 between the picture of N samples where a pixel requires\n"
    "them and that of 256 samples of every pixel, of the worst view. missed_percent: pixels that are off\n"
    "by more than 16/255 in a channel at 16 samples, of the worst view. cost_N: the whole frame over that\n"
    "of one sample, geometric mean over the views of medians taken in turns. flicker_16: root mean square\n"
    "over 30 consecutive frames of the change from the frame before at 16 samples minus that at 256,\n"
    "pixel by pixel; the worse of gallery and court, at 512x512 (256x256 with --quick). Hard shadows of\n"
    "all lights, 1024x1024 except for flicker.";

}  // namespace

void add_picture_command(CLI::App& program, Run& run) {
  add_session_command<PictureSession>(
      program, run,
      {"picture", "Anti-aliased pictures compared with 256 samples per pixel: errors, costs, flicker",
       footer},
      parts, last_lines);
}

}  // namespace tenebra::bench
