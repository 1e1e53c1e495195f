// tenebra-bench viewer: what a person at the window sees, while a hand holds keys and drags.
#include <array>

#include "bench/common/bench_program.h"
#include "bench/viewer/viewer_session.h"

namespace tenebra::bench {
namespace {

constexpr std::array parts{
    BenchPart<ViewerSession>{"hands", measure_hands}, BenchPart<ViewerSession>{"starts", measure_starts},
    BenchPart<ViewerSession>{"opens", measure_opens}, BenchPart<ViewerSession>{"whole", measure_whole},
    BenchPart<ViewerSession>{"explain", measure_explain}};
const std::span<const BenchPart<ViewerSession>> all_parts(parts);

void print_viewer_end(const ViewerHeadline& h, const std::vector<std::string>& skipped) {
  print_end("viewer", skipped,
            {{"key_to_picture", h.key_to_picture, 2},
             {"pictures_per_second_worst", h.pictures_per_second_worst, 1},
             {"black_ms_worst", h.black_ms_worst, 0},
             {"explain_ms", h.explain_ms, 0},
             {"over_render", h.over_render, 3}});
}

Expected<void> measure(const PartsArguments& arguments) {
  const auto program = program_file();
  if (program.empty()) {
    print_viewer_end({}, {"viewer: skipped, found no program tenebra beside this one"});
    return {};
  }
  const auto screen = WatchedScreen::start();
  if (!screen) {
    print_viewer_end({}, {"viewer: skipped, " + screen.error().message});
    return {};
  }
  ViewerSession session(arguments, program.string(), **screen);
  if (auto done = measure_and_write(arguments, all_parts, session); !done) return done;
  print_viewer_end(session.headline, session.skipped);
  return {};
}

constexpr const char* footer =
    "The program beside this one, on a virtual display (Xvfb) of its own, with keys that repeat 30 times\n"
    "a second; the display's pixels are read while it draws. pictures_per_second_worst: how often the\n"
    "middle of the view changes while a key is held or the mouse drags, at 1024x1024. black_ms_worst:\n"
    "longest time without a picture, from the window's first sign on, and while a file is opened in it.\n"
    "explain_ms: from a click to its\n"
    "answer. over_render: a whole frame while a key is held, over one of tenebra render; key_to_picture:\n"
    "from a single press to its whole picture on the screen, in such frames; these two with --antialias 1\n"
    "--terminator flat --tone none.";

}  // namespace

void add_viewer_command(CLI::App& program, Run& run) {
  add_parts_command(program, run,
                    {"viewer", "What the window shows while keys are held and the mouse drags", footer},
                    part_names(all_parts), measure);
}

}  // namespace tenebra::bench
