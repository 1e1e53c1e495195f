#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/fail.h"
#include "io/header_words.h"
#include "io/image.h"
#include "io/input_file.h"

namespace tenebra::io {
namespace {

constexpr std::uint64_t most_pfm_pixels = std::uint64_t{1} << 26;
constexpr std::size_t most_pfm_bytes = (std::size_t{1} << 30) + 4096;
constexpr std::string_view pfm_blanks = " \t\r\n";

/// The number that `text` begins with, which is taken off it; 0 for anything else.
template <class T>
T take_number(std::string_view& text) {
  return number_in<T>(take_header_word(text, pfm_blanks)).value_or(0);
}

void swap_bytes(std::vector<float>& values) {
  for (float& value : values)
    value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
}

}  // namespace

Expected<ImageF> read_pfm(const std::filesystem::path& path) {
  const auto bytes = read_file(path, most_pfm_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  std::string_view rest = *bytes;
  const std::string_view kind = take_header_word(rest, pfm_blanks);
  if (kind != "PF" && kind != "Pf")
    return base::fail("{}: found no PFM picture, expected one that starts with PF or Pf", path.string());
  const auto width = take_number<std::uint32_t>(rest), height = take_number<std::uint32_t>(rest);
  const auto scale = take_number<double>(rest);
  const std::uint64_t count = std::uint64_t{width} * height;
  if (width == 0 || height == 0 || count > most_pfm_pixels)
    return base::fail("{}: found {} x {} pixels, expected 1 to 2^26", path.string(), width, height);
  if (scale == 0 || !std::isfinite(scale))
    return base::fail("{}: found no scale, expected a number below 0 (little-endian) or above",
                      path.string());
  const std::uint64_t channels = kind == "PF" ? 3 : 1, size = sizeof(float) * channels * count;
  if (rest.size() != size)
    return base::fail("{}: found {} bytes of pixels, expected {} for {} x {}", path.string(), rest.size(),
                      size, width, height);
  ImageF image{static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels),
               std::vector<float>(channels * count)};
  const std::size_t row_bytes = size / height;
  for (std::uint32_t y = 0; y < height; ++y)  // the bottom row comes first
    std::memcpy(image.pixels.data() + (height - 1 - y) * channels * width, rest.data() + y * row_bytes,
                row_bytes);
  if (scale > 0) swap_bytes(image.pixels);
  return image;
}

}  // namespace tenebra::io
