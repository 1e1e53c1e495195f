#include "io/png_writer.h"

#include <libdeflate.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include "base/fail.h"

namespace tenebra::io {
namespace {

constexpr int fastest_level = 1;
constexpr std::uint8_t filter_sub = 1, filter_up = 2;
constexpr std::size_t chunk_extra = 12;  // length, type and checksum of a chunk

void append_number(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<char>(number >> shift & 0xff));
}

/// The chunk that starts at `start`, whose data are already there: its length and checksum.
void finish_chunk(std::string& bytes, std::size_t start) {
  const std::size_t length = bytes.size() - start - 8;
  for (std::size_t i = 0; i < 4; ++i) bytes[start + i] = static_cast<char>(length >> (24 - 8 * i) & 0xff);
  append_number(bytes, libdeflate_crc32(0, bytes.data() + start + 4, length + 4));
}

std::size_t begin_chunk(std::string& bytes, const char* type) {
  const std::size_t start = bytes.size();
  bytes.append(4, '\0').append(type, 4);
  return start;
}

/// The pixel to the left is `step` values before.
void subtract_left(const std::uint8_t* row, std::size_t length, std::size_t step, std::uint8_t* out) {
  std::memcpy(out, row, step);
  for (std::size_t i = step; i < length; ++i) out[i] = static_cast<std::uint8_t>(row[i] - row[i - step]);
}

void subtract_above(const std::uint8_t* row, const std::uint8_t* above, std::size_t length,
                    std::uint8_t* out) {
  for (std::size_t i = 0; i < length; ++i) out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
}

/// How far the differences are from 0, in sum: the usual guess at what they compress to.
std::uint32_t spread(const std::uint8_t* differences, std::size_t length) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < length; ++i)
    sum += static_cast<std::uint32_t>(std::abs(static_cast<int>(static_cast<std::int8_t>(differences[i]))));
  return sum;
}

/// A byte that names the filter and the filtered row, for each row.
std::vector<std::uint8_t> filtered_rows(const Image8& image) {
  const std::size_t step = static_cast<std::size_t>(image.channels),
                    length = static_cast<std::size_t>(image.width) * step,
                    height = static_cast<std::size_t>(image.height);
  std::vector<std::uint8_t> rows((length + 1) * height), other(length);
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* const row = image.pixels.data() + y * length;
    std::uint8_t* const out = rows.data() + y * (length + 1);
    out[0] = filter_sub;
    subtract_left(row, length, step, out + 1);
    if (y == 0) continue;
    subtract_above(row, row - length, length, other.data());
    if (spread(other.data(), length) > spread(out + 1, length)) continue;
    out[0] = filter_up;
    std::memcpy(out + 1, other.data(), length);
  }
  return rows;
}

void append_header(std::string& bytes, const Image8& image) {
  constexpr char bits_per_channel = 8, grey = 0, colour = 2, colour_and_alpha = 6;
  const std::size_t start = begin_chunk(bytes, "IHDR");
  append_number(bytes, static_cast<std::uint32_t>(image.width));
  append_number(bytes, static_cast<std::uint32_t>(image.height));
  bytes.push_back(bits_per_channel);
  bytes.push_back(image.channels == 1 ? grey : image.channels == 3 ? colour : colour_and_alpha);
  bytes.append(3, '\0');  // deflate, the five filters, no interlacing
  finish_chunk(bytes, start);
}

tl::unexpected<Error> no_memory(const Image8& image) {
  return base::fail("not enough memory to compress {} x {} pixels", image.width, image.height);
}

}  // namespace

Expected<std::string> png_of_pixels(const Image8& image) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(fastest_level), libdeflate_free_compressor);
  if (compressor == nullptr) return no_memory(image);
  try {
    const std::vector<std::uint8_t> rows = filtered_rows(image);
    const std::size_t most = libdeflate_zlib_compress_bound(compressor.get(), rows.size());
    std::string bytes("\x89PNG\r\n\x1a\n", 8);
    bytes.reserve(most + 8 + 3 * chunk_extra + 13);
    append_header(bytes, image);
    const std::size_t start = begin_chunk(bytes, "IDAT"), data = bytes.size();
    bytes.resize(data + most);
    bytes.resize(data +
                 libdeflate_zlib_compress(compressor.get(), rows.data(), rows.size(), &bytes[data], most));
    finish_chunk(bytes, start);
    finish_chunk(bytes, begin_chunk(bytes, "IEND"));
    return bytes;
  } catch (const std::bad_alloc&) {
    return no_memory(image);
  }
}

}  // namespace tenebra::io
