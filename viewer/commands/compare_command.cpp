// tenebra compare: are two pictures the same?
#include <memory>

#include "base/fail.h"
#include "base/image.h"
#include "commands/command.h"
#include "options/option_values.h"
#include "shared/files_apart.h"
#include "shared/picture_difference.h"
#include "shell/console.h"
#include "shell/stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr const char* compare_examples =
    "Examples:\n"
    "  tenebra compare a.png b.png\n"
    "  tenebra compare a.png b.png --threshold 2 -o diff.png\n"
    "      differences of up to 2 of 255 in each channel do not count; the others are red in diff.png\n"
    "\n"
    "Grey counts as equal red, green and blue; a picture without alpha counts as opaque.\n"
    "Exit code: 0 same, 1 different, 2 failed (one sentence says why).";

constexpr int same = 0;
constexpr int different = 1;
constexpr int largest_value = 255;

struct CompareOptions {
  std::string a;
  std::string b;
  std::string output;
  int threshold = 0;
};

Expected<int> compare(const CompareOptions& options) {
  if (!options.output.empty()) {
    if (auto apart = check_files_apart({options.a, options.b}, OutputName{"-o", options.output}); !apart)
      return tl::unexpected(apart.error());
  }
  const auto a = base::read_png(options.a);
  if (!a) return tl::unexpected(a.error());
  const auto b = base::read_png(options.b);
  if (!b) return tl::unexpected(b.error());
  if (a->width != b->width || a->height != b->height) {
    print_out("different: sizes {}x{} and {}x{}{}\n", a->width, a->height, b->width, b->height,
              options.output.empty() ? "" : ", no picture of the difference");
    return different;
  }
  base::Image8 marked;
  const PictureDifference result =
      compare_pictures(*a, *b, options.threshold, options.output.empty() ? nullptr : &marked);
  if (!options.output.empty()) {
    const StopSignals stop;
    if (auto written = base::write_png(options.output, marked); !written)
      return tl::unexpected(written.error());
  }
  print_out("{}: {} of {} pixels differ by more than {}, largest difference {} of 255\n",
            result.differing == 0 ? "same" : "different", result.differing, result.pixels, options.threshold,
            result.largest);
  return result.differing == 0 ? same : different;
}

Expected<int> parse_threshold(const std::string& text) {
  const auto threshold = parse_count(text);
  if (!threshold || *threshold > largest_value) return base::fail("found {}, expected 0 to 255", text);
  return threshold;
}

}  // namespace

void add_compare_command(CLI::App& program, Run& run) {
  CLI::App& command = add_command(program, "compare", "Say whether two pictures are the same");
  const auto options = std::make_shared<CompareOptions>();
  set_examples(command, compare_examples);
  add_text(command, "A", options->a, "A PNG picture").required();
  add_text(command, "B", options->b, "Another of the same size").required();
  add_text(command, "-o,--output", options->output, "Picture of the differences to write")
      .type_name("FILE.png");
  add_value(command, "--threshold", options->threshold, parse_threshold,
            "Largest difference in a channel that does not count, 0 to\n255 [0]")
      .type_name("T");
  when_chosen(command, [options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace tenebra::viewer
