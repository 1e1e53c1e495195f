// tenebra compare: are two pictures the same?
#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <memory>

#include "base/fail.h"
#include "commands/command.h"
#include "io/image.h"
#include "options/settings_names.h"
#include "shared/files_apart.h"
#include "shared/flip.h"
#include "shared/loaded_picture.h"
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
    "Two PNG are compared in levels of 255; all other pairs by linear values. RMS and PSNR (of 255, or of 1) "
    "cover\n"
    "red, green and blue. FLIP is how different they look, 0 to 1, the mean over the pixels (Andersson et "
    "al. 2020),\n"
    "at 67 pixels per degree; values below 0 count as 0 and values beyond 1 as 1.\n"
    "Grey counts as equal red, green and blue; a picture without alpha counts as opaque.\n"
    "Exit code: 0 same, 1 different, 2 failed (one sentence says why).";

constexpr int same = 0;
constexpr int different = 1;
constexpr int largest_value = 255;
constexpr std::size_t most_looked_at = std::size_t{1} << 26;  // pixels; FLIP of more takes minutes

struct CompareOptions {
  std::string a;
  std::string b;
  std::string output;
  std::string layer;  ///< of OpenEXR pictures; empty: their colours
  int threshold = 0;
};

double decibels(double peak, double rms) {
  return rms > 0 ? 20 * std::log10(peak / rms) : std::numeric_limits<double>::infinity();
}

/// What is printed of two pictures, and written.
struct Comparison {
  std::string text;
  bool is_same = false;
  io::Image8 marked;  ///< the picture of the differences
};

Comparison compare_levels(const io::Image8& a, const io::Image8& b, int threshold) {
  Comparison out;
  const PictureDifference found = compare_pictures(a, b, threshold, &out.marked);
  const double rms = rms_difference(a, b);
  out.is_same = found.differing == 0;
  out.text = fmt::format(
      "{}: {} of {} pixels differ by more than {}, largest difference {} of 255\nRMS {:.6g} of 255, PSNR "
      "{:.6g} dB",
      out.is_same ? "same" : "different", found.differing, found.pixels, threshold, found.largest, rms,
      decibels(largest_value, rms));
  return out;
}

Comparison compare_floats(const io::ImageF& a, const io::ImageF& b, int threshold) {
  Comparison out;
  const ValueDifference found = compare_values(a, b, threshold / double{largest_value}, &out.marked);
  const double rms = rms_difference(a, b);
  out.is_same = found.differing == 0;
  out.text = fmt::format(
      "{}: {} of {} pixels differ by more than {}/255 of 1, largest difference {:.6g}\nRMS {:.6g}, PSNR "
      "{:.6g} dB",
      out.is_same ? "same" : "different", found.differing, found.pixels, threshold, found.largest, rms,
      decibels(1, rms));
  return out;
}

std::size_t pixels_of(const LoadedPicture& picture) {
  return std::visit(
      [](const auto& image) {
        return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
      },
      picture);
}

/// Levels where both are PNG, else linear values.
Comparison compare_loaded(const LoadedPicture& a, const LoadedPicture& b, const CompareOptions& options) {
  const auto* const a_levels = std::get_if<io::Image8>(&a);
  const auto* const b_levels = std::get_if<io::Image8>(&b);
  const bool of_levels = a_levels && b_levels,
             looks = options.layer.empty() && pixels_of(a) <= most_looked_at;
  io::ImageF a_linear, b_linear;
  if (looks || !of_levels) {
    a_linear = linear_colors(a);
    b_linear = linear_colors(b);
  }
  Comparison out = of_levels ? compare_levels(*a_levels, *b_levels, options.threshold)
                             : compare_floats(a_linear, b_linear, options.threshold);
  out.text += looks ? fmt::format(", FLIP {:.6g}\n", mean_flip(a_linear, b_linear)) : "\n";
  return out;
}

std::string size_text(const LoadedPicture& picture) {
  return std::visit([](const auto& image) { return fmt::format("{}x{}", image.width, image.height); },
                    picture);
}

Expected<int> compare(const CompareOptions& options) {
  if (!options.output.empty()) {
    if (auto apart = check_files_apart({options.a, options.b}, OutputName{"-o", options.output}); !apart)
      return tl::unexpected(apart.error());
  }
  const auto a = load_picture(options.a, options.layer);
  if (!a) return tl::unexpected(a.error());
  const auto b = load_picture(options.b, options.layer);
  if (!b) return tl::unexpected(b.error());
  if (size_text(*a) != size_text(*b)) {
    print_out("different: sizes {} and {}{}\n", size_text(*a), size_text(*b),
              options.output.empty() ? "" : ", no picture of the difference");
    return different;
  }
  const Comparison found = compare_loaded(*a, *b, options);
  if (!options.output.empty()) {
    const StopSignals stop;
    if (auto written = io::write_png(options.output, found.marked); !written)
      return tl::unexpected(written.error());
  }
  print_out("{}", found.text);
  return found.is_same ? same : different;
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
  add_text(command, "A", options->a, "A picture: PNG, OpenEXR (.exr) or PFM (.pfm)").required();
  add_text(command, "B", options->b, "Another of the same size").required();
  add_text(command, "-o,--output", options->output, "Picture of the differences to write")
      .type_name("FILE.png");
  add_value(command, "--threshold", options->threshold, parse_threshold,
            "Largest difference in a channel that is ignored, 0 to 255;\n"
            "for linear values in parts of 255 [0]")
      .type_name("T");
  add_text(command, "--layer", options->layer,
           "Layer or channel of OpenEXR pictures, like N, Z or\nvisibility.sun [the colours]")
      .type_name("NAME");
  when_chosen(command, [options, &run] { run = [options] { return compare(*options); }; });
}

}  // namespace tenebra::viewer
