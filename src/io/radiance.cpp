// Radiance pictures (RGBE and XYZE), as Ward's "Real Pixels" and the file formats of Radiance's manual
// describe them: flat rows, old runs and new runs, all eight orders of pixels, EXPOSURE and COLORCORR.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "base/fail.h"
#include "io/header_words.h"
#include "io/image.h"
#include "io/input_file.h"

namespace tenebra::io {
namespace {

constexpr std::uint64_t most_hdr_pixels = std::uint64_t{1} << 26;
constexpr std::size_t most_hdr_bytes = std::size_t{1} << 30;

using Colour = std::array<float, 3>;
using Pixel = std::array<std::uint8_t, 4>;  ///< three mantissas and the exponent that they share

/// What stands before the pixels.
struct Header {
  bool xyz = false;  ///< CIE XYZ in place of red, green, blue
  /// What the values were multiplied by: the product of all EXPOSUREs and COLORCORRs, normal numbers.
  std::array<double, 3> divisor{1, 1, 1};
  bool columns = false;  ///< a scanline is a column
  bool from_bottom = false, from_right = false;
  std::size_t lines = 0, length = 0;  ///< scanlines, and the pixels of one
};

/// The text up to the next line feed, which is taken too; none at the end.
std::optional<std::string_view> take_line(std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view take_word_of_line(std::string_view& line) {
  return take_header_word(line, " \t");
}

/// Multiplies the divisor by the factors of `line` behind its `=`: one for all channels, or one for each.
/// Fails with a phrase.
Expected<void> take_factors(std::string_view line, std::size_t count, Header& header) {
  std::string_view text = line.substr(line.find('=') + 1);
  std::array<double, 3> factors{};
  for (std::size_t i = 0; i < count; ++i) {
    const auto factor = number_in<double>(take_word_of_line(text));
    if (!factor || !(*factor > 0) || !std::isfinite(*factor))
      return base::fail("found {}, expected {} above 0", line.substr(0, 60),
                        count == 1 ? "a number" : "three numbers");
    factors[i] = *factor;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    header.divisor[i] *= factors[count == 1 ? 0 : i];
    if (!std::isnormal(header.divisor[i]))
      return base::fail(
          "found {} too large or too small as a product with those before it, expected a number "
          "that a double can hold",
          line.substr(0, 60));
  }
  return {};
}

/// "-Y 512 +X 1024". False: it is none.
bool take_order(std::string_view line, Header& header) {
  const std::string_view first = take_word_of_line(line);
  const auto lines = number_in<std::size_t>(take_word_of_line(line));
  const std::string_view second = take_word_of_line(line);
  const auto length = number_in<std::size_t>(take_word_of_line(line));
  const auto is_axis = [](std::string_view word, char axis) {
    return word.size() == 2 && (word[0] == '+' || word[0] == '-') && word[1] == axis;
  };
  header.columns = is_axis(first, 'X');
  const std::string_view y = header.columns ? second : first, x = header.columns ? first : second;
  if (!is_axis(y, 'Y') || !is_axis(x, 'X') || !lines || !length || !take_word_of_line(line).empty())
    return false;
  header.from_bottom = y[0] == '+';
  header.from_right = x[0] == '-';
  header.lines = *lines;
  header.length = *length;
  return true;
}

/// Takes the header off `bytes`. Fails with a phrase.
Expected<Header> take_header(std::string_view& bytes) {
  if (!bytes.starts_with("#?"))
    return base::fail("found no Radiance picture, expected one that starts with #?RADIANCE or #?RGBE");
  Header header;
  for (auto line = take_line(bytes);; line = take_line(bytes)) {
    if (!line) return base::fail("found the end of the file in its header");
    if (line->empty()) break;
    const std::string_view name = line->substr(0, line->find('='));
    if (name.size() == line->size()) continue;  // a command that the picture went through
    const std::string_view value = line->substr(name.size() + 1);
    if (name == "FORMAT") {
      if (value != "32-bit_rle_rgbe" && value != "32-bit_rle_xyze")
        return base::fail("found FORMAT={}, expected 32-bit_rle_rgbe or 32-bit_rle_xyze",
                          value.substr(0, 40));
      header.xyz = value == "32-bit_rle_xyze";
    }
    if (const std::size_t factors = name == "EXPOSURE" ? 1 : name == "COLORCORR" ? 3 : 0; factors > 0)
      if (const auto taken = take_factors(*line, factors, header); !taken)
        return tl::unexpected(taken.error());
  }
  const auto order = take_line(bytes);
  if (!order || !take_order(*order, header))
    return base::fail("found no size, expected a line like -Y 512 +X 1024");
  return header;
}

/// Fewer bytes cannot hold a scanline: a pixel and runs, each of which takes the run before it up to 256
/// times further; or, where new runs are allowed, four channels in runs of at most 127.
std::uint64_t least_bytes(std::uint64_t length) {
  std::uint64_t old_runs = 4;
  for (std::uint64_t left = length - 1; left > 0; left >>= 8) old_runs += 4;
  const bool has_new_runs = length >= 8 && length < 32768;
  return has_new_runs ? std::min(old_runs, 4 + 8 * ((length + 126) / 127)) : old_runs;
}

/// Four channels, one after another, each in runs and single values. False: they do not fit the scanline, or
/// the file ends.
bool take_new_runs(std::string_view& bytes, std::vector<Pixel>& line) {
  for (std::size_t channel = 0; channel < 4; ++channel) {
    for (std::size_t at = 0; at < line.size();) {
      if (bytes.size() < 2) return false;
      const auto code = static_cast<std::uint8_t>(bytes[0]);
      const bool run = code > 128;
      const std::size_t count = run ? code - 128u : code, stored = run ? 1 : count;
      if (count == 0 || count > line.size() - at || bytes.size() < 1 + stored) return false;
      for (std::size_t i = 0; i < count; ++i)
        line[at + i][channel] = static_cast<std::uint8_t>(bytes[1 + (run ? 0 : i)]);
      bytes.remove_prefix(1 + stored);
      at += count;
    }
  }
  return true;
}

/// Pixels of four bytes; 1, 1, 1, N repeats the one before N times, N << 8 times if it follows such a run,
/// and so on. False as above.
bool take_old_runs(std::string_view& bytes, std::vector<Pixel>& line) {
  int shift = 0;
  for (std::size_t at = 0; at < line.size();) {
    if (bytes.size() < 4) return false;
    Pixel pixel;
    std::copy_n(bytes.begin(), 4, pixel.begin());
    bytes.remove_prefix(4);
    const bool run = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
    if (!run) {
      line[at++] = pixel;
      shift = 0;
      continue;
    }
    const std::uint64_t count = shift < 32 ? std::uint64_t{pixel[3]} << shift : line.size();
    if (at == 0 || count > line.size() - at) return false;
    std::fill_n(line.begin() + static_cast<std::ptrdiff_t>(at), count, line[at - 1]);
    at += count;
    shift += 8;
  }
  return true;
}

bool take_scanline(std::string_view& bytes, std::vector<Pixel>& line) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  const bool may_be_new = line.size() >= 8 && line.size() < 32768 && bytes.size() >= 4;
  const bool is_new = may_be_new && byte(0) == 2 && byte(1) == 2 && byte(2) < 128;
  if (!is_new) return take_old_runs(bytes, line);
  if (((std::size_t{byte(2)} << 8) | byte(3)) != line.size()) return false;
  bytes.remove_prefix(4);
  return take_new_runs(bytes, line);
}

/// Radiance's own primaries (.64 .33, .29 .60, .15 .06) and its white, equal energy: neutral stays neutral.
Colour rgb_of_xyz(const Colour& xyz) {
  constexpr std::array<std::array<float, 3>, 3> rows{{{2.565312843f, -1.166849616f, -0.398463227f},
                                                      {-1.022108172f, 1.978286617f, 0.043821555f},
                                                      {0.074724377f, -0.251939567f, 1.17721519f}}};
  Colour rgb;
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = std::max(rows[i][0] * xyz[0] + rows[i][1] * xyz[1] + rows[i][2] * xyz[2], 0.0f);
  return rgb;
}

Colour colour_of(const Pixel& pixel, const Header& header) {
  const float unit = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, pixel[3] - (128 + 8));
  Colour colour;
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<float>(double{unit} * pixel[i] / header.divisor[i]);
  return header.xyz ? rgb_of_xyz(colour) : colour;
}

/// Puts scanline `i` where it belongs. False: a value is beyond the range of floats.
bool place(const std::vector<Pixel>& line, std::size_t i, const Header& header, ImageF& image) {
  for (std::size_t j = 0; j < line.size(); ++j) {
    std::size_t x = header.columns ? i : j, y = header.columns ? j : i;
    if (header.from_right) x = static_cast<std::size_t>(image.width) - 1 - x;
    if (header.from_bottom) y = static_cast<std::size_t>(image.height) - 1 - y;
    const Colour colour = colour_of(line[j], header);
    if (!std::all_of(colour.begin(), colour.end(), [](float value) { return std::isfinite(value); }))
      return false;
    std::copy_n(colour.begin(), 3,
                image.pixels.begin() +
                    static_cast<std::ptrdiff_t>(3 * (y * static_cast<std::size_t>(image.width) + x)));
  }
  return true;
}

Expected<ImageF> decode(std::string_view bytes) {
  const auto header = take_header(bytes);
  if (!header) return tl::unexpected(header.error());
  const std::uint64_t lines = header->lines, length = header->length;
  const std::uint64_t width = header->columns ? lines : length, height = header->columns ? length : lines;
  if (lines < 1 || length < 1 || lines > most_hdr_pixels || length > most_hdr_pixels ||
      lines * length > most_hdr_pixels)
    return base::fail("found {} x {} pixels, expected 1 to 2^26", width, height);
  if (const std::uint64_t least = lines * least_bytes(length); bytes.size() < least)
    return base::fail(
        "found {} bytes behind the header, expected at least {} for {} x {} pixels: the file is cut "
        "off, copy it again",
        bytes.size(), least, width, height);
  ImageF image{static_cast<int>(width), static_cast<int>(height), 3, std::vector<float>(3 * lines * length)};
  std::vector<Pixel> line(length);
  for (std::size_t i = 0; i < lines; ++i) {
    if (!take_scanline(bytes, line))
      return base::fail("scanline {} of {} is damaged or cut off: copy the file again", i + 1, lines);
    if (!place(line, i, *header, image))
      return base::fail(
          "scanline {} of {} holds light beyond the range of floats, expected less: check EXPOSURE and "
          "COLORCORR",
          i + 1, lines);
  }
  return image;
}

}  // namespace

Expected<ImageF> read_hdr(const std::filesystem::path& path) {
  const auto bytes = read_file(path, most_hdr_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  auto image = decode(*bytes);
  if (!image) return base::fail("{}: {}", path.string(), image.error().message);
  return image;
}

}  // namespace tenebra::io
