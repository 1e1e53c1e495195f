// Pixel grids on the CPU, row 0 at the top, and their files (PNG for 8 bits; PFM, and Radiance to read, for
// floats).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tenebra/expected.h>

namespace tenebra::io {

/// `channels` interleaved values per pixel; pixels.size() == width * height * channels.
template <class T>
struct Image {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<T> pixels;

  bool operator==(const Image&) const = default;
};
using Image8 = Image<std::uint8_t>;  ///< sRGB-encoded colour, or a mask (255 lit, 0 shadowed)
using ImageF = Image<float>;         ///< linear values

/// Writes an 8-bit PNG (1, 3 or 4 channels), whole or not at all (see write_file).
Expected<void> write_png(const std::filesystem::path& path, const Image8& image);
/// Writes a JPEG (1 or 3 channels) of a quality whose loss is hard to see, whole or not at all; at most
/// 65,535 pixels a side.
Expected<void> write_jpeg(const std::filesystem::path& path, const Image8& image);
/// Reads an 8-bit PNG as stored (1 to 4 channels). Refuses what is not a PNG and more than 2^28 pixels.
Expected<Image8> read_png(const std::filesystem::path& path);
/// Reads a Radiance picture (.hdr; RGBE or XYZE, pixels in any order, in runs or not): three linear channels,
/// with EXPOSURE and COLORCORR undone. Refuses what is none or damaged, and more than 2^26 pixels.
Expected<ImageF> read_hdr(const std::filesystem::path& path);
/// The bytes that write_png writes.
Expected<std::string> encode_png(const Image8& image);

struct ImageSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};
/// Whether `bytes` begin as a PNG or a JPEG does: what the two functions below read.
bool is_png_or_jpeg(std::string_view bytes);
/// The size that the header of a PNG or JPEG states; nothing is decoded. Fails with a phrase.
Expected<ImageSize> stated_size(std::string_view bytes);
/// A PNG or JPEG in four channels as stored, of 16 bits the upper eight; alpha 255 where it has none. Fails
/// with a phrase: refuse what stated_size finds too large first.
Expected<Image8> decode_rgba(std::string_view bytes);

/// Reads a PFM (1 or 3 channels, any byte order; the size of its scale counts for nothing). Refuses what is
/// none, what has not the bytes that its header states, and more than 2^26 pixels.
Expected<ImageF> read_pfm(const std::filesystem::path& path);
/// Writes a 32-bit little-endian PFM (1 or 3 channels), whole or not at all.
Expected<void> write_pfm(const std::filesystem::path& path, const ImageF& image);

}  // namespace tenebra::io
