// tenebra compare: are two pictures the same?
#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>

#include "base/image.h"
#include "command.h"
#include "console.h"
#include "option_values.h"
#include "stop_signals.h"

namespace tenebra::viewer {
namespace {

constexpr const char* examples =
    "Examples:\n"
    "  tenebra compare a.png b.png\n"
    "  tenebra compare a.png b.png --threshold 2 -o diff.png\n"
    "      differences of up to 2 of 255 a channel are no difference; the others are red in diff.png\n"
    "\n"
    "Grey counts as equal red, green and blue, and a picture without alpha as opaque.\n"
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

using Pixel = std::array<int, 4>;

/// Pixel `index` as red, green, blue, alpha.
Pixel pixel_of(const Image8& image, std::size_t index) {
  const std::uint8_t* values = image.pixels.data() + index * static_cast<std::size_t>(image.channels);
  switch (image.channels) {
    case 1:
      return {values[0], values[0], values[0], largest_value};
    case 2:
      return {values[0], values[0], values[0], values[1]};
    case 3:
      return {values[0], values[1], values[2], largest_value};
    default:
      return {values[0], values[1], values[2], values[3]};
  }
}

int largest_difference(const Pixel& a, const Pixel& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

struct Comparison {
  std::size_t pixels = 0;
  std::size_t differing = 0;  ///< by more than the threshold
  int largest = 0;
  Image8 picture;  ///< `a` dark and grey, differing pixels red
};

Comparison compare_pixels(const Image8& a, const Image8& b, int threshold) {
  Comparison result;
  result.pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  result.picture = {a.width, a.height, 3, std::vector<std::uint8_t>(result.pixels * 3)};
  for (std::size_t i = 0; i < result.pixels; ++i) {
    const Pixel in_a = pixel_of(a, i);
    const int difference = largest_difference(in_a, pixel_of(b, i));
    result.largest = std::max(result.largest, difference);
    const bool differs = difference > threshold;
    result.differing += differs ? 1 : 0;
    const auto grey = static_cast<std::uint8_t>((in_a[0] + in_a[1] + in_a[2]) / 12);
    std::uint8_t* out = result.picture.pixels.data() + i * 3;
    out[0] = differs ? largest_value : grey;
    out[1] = out[2] = differs ? 0 : grey;
  }
  return result;
}

Expected<int> compare(const CompareOptions& options) {
  const auto a = read_png(options.a);
  if (!a) return tl::unexpected(a.error());
  const auto b = read_png(options.b);
  if (!b) return tl::unexpected(b.error());
  if (a->width != b->width || a->height != b->height) {
    print_out("different: sizes {}x{} and {}x{}{}\n", a->width, a->height, b->width, b->height,
              options.output.empty() ? "" : ", no picture of the difference");
    return different;
  }
  const Comparison result = compare_pixels(*a, *b, options.threshold);
  if (!options.output.empty()) {
    const StopSignals stop;
    if (auto written = write_png(options.output, result.picture); !written)
      return tl::unexpected(written.error());
  }
  print_out("{}: {} of {} pixels differ by more than {}, largest difference {} of 255\n",
            result.differing == 0 ? "same" : "different", result.differing, result.pixels, options.threshold,
            result.largest);
  return result.differing == 0 ? same : different;
}

Expected<int> parse_threshold(const std::string& text) {
  const auto threshold = parse_count(text);
  if (!threshold || *threshold > largest_value) return fail("found {}, expected 0 to 255", text);
  return threshold;
}

}  // namespace

void add_compare_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("compare", "Whether two pictures are the same");
  const auto options = std::make_shared<CompareOptions>();
  command->footer(examples);
  command->add_option("A", options->a, "A picture, PNG")->required();
  command->add_option("B", options->b, "Another of the same size")->required();
  command->add_option("-o,--output", options->output, "Picture of the differences")->type_name("FILE.png");
  add_value(*command, "--threshold", options->threshold, parse_threshold,
            "Largest difference of a channel that counts as the same, 0 to 255 [0]")
      ->type_name("T");
  command->callback([options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace tenebra::viewer
