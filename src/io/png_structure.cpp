#include "io/png_structure.h"

#include <libdeflate.h>

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <string>

#include "base/fail.h"

namespace tenebra::io {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::size_t header_size = 13;
constexpr std::size_t chunk_overhead = 12;  // length, type, checksum
/// Deflate cannot expand more than this (RFC 1951: 258 bytes from 2 bits, and block headers).
constexpr std::uint64_t largest_expansion = 1032;

std::uint32_t big_endian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t remainder = n;
    for (int bit = 0; bit < 8; ++bit)
      remainder = (remainder & 1) != 0 ? 0xedb88320u ^ remainder >> 1 : remainder >> 1;
    table[n] = remainder;
  }
  return table;
}

/// CRC-32 of PNG's annex D.
std::uint32_t crc32(std::string_view bytes) {
  static constexpr auto table = make_crc_table();
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<unsigned char>(byte)) & 0xff] ^ crc >> 8;
  return ~crc;
}

struct Chunk {
  std::string_view type;
  std::string_view content;
};

Expected<Chunk> read_chunk(std::string_view bytes, std::size_t at) {
  if (bytes.size() - at < chunk_overhead)
    return base::fail("the file ends at byte {} without an IEND chunk", bytes.size());
  const std::size_t length = big_endian(bytes, at);
  const std::string_view type = bytes.substr(at + 4, 4);
  for (const char c : type) {
    if ((c < 'a' || c > 'z') && (c < 'A' || c > 'Z'))
      return base::fail("found no chunk name at byte {}", at + 4);
  }
  if (length > bytes.size() - at - chunk_overhead) {
    return base::fail("found the {} chunk of {} bytes at byte {} cut off by the file's end", type, length,
                      at);
  }
  if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian(bytes, at + 8 + length)) {
    return base::fail("found a wrong checksum in the {} chunk at byte {}", type, at);
  }
  return Chunk{type, bytes.substr(at + 8, length)};
}

Expected<PngHeader> read_header(std::string_view bytes) {
  if (!bytes.starts_with(signature)) return base::fail("found no PNG signature");
  const auto chunk = read_chunk(bytes, signature.size());
  if (!chunk) return tl::unexpected(chunk.error());
  if (chunk->type != "IHDR" || chunk->content.size() != header_size) {
    return base::fail("found {} of {} bytes as the first chunk, expected IHDR of {}", chunk->type,
                      chunk->content.size(), header_size);
  }
  const auto byte = [&](std::size_t i) -> int { return static_cast<unsigned char>(chunk->content[i]); };
  return PngHeader{big_endian(chunk->content, 0), big_endian(chunk->content, 4), byte(8), byte(9),
                   byte(12) != 0};
}

/// Bytes of rows of `width` pixels, with the byte that names each row's filter.
std::uint64_t bytes_of_rows(const PngHeader& header, std::uint64_t width, std::uint64_t height) {
  constexpr std::array<std::uint64_t, 7> channels_by_type{1, 1, 3, 1, 2, 1, 4};
  const auto type = static_cast<std::size_t>(header.color_type);
  const std::uint64_t channels = type < channels_by_type.size() ? channels_by_type[type] : 4;
  if (width == 0) return 0;
  return height * (1 + (width * channels * static_cast<std::uint64_t>(header.bit_depth) + 7) / 8);
}

/// What the compressed bytes must inflate to: all rows, or those of the seven passes of Adam7.
std::uint64_t inflated_size(const PngHeader& header) {
  if (!header.interlaced) return bytes_of_rows(header, header.width, header.height);
  struct Pass {
    std::uint32_t x, y, step_x, step_y;
  };
  constexpr std::array<Pass, 7> passes{Pass{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                       {0, 2, 2, 4},     {1, 0, 2, 2}, {0, 1, 1, 2}};
  const auto count = [](std::uint64_t size, std::uint64_t first, std::uint64_t step) {
    return size > first ? (size - first + step - 1) / step : 0;
  };
  std::uint64_t sum = 0;
  for (const Pass& pass : passes)
    sum += bytes_of_rows(header, count(header.width, pass.x, pass.step_x),
                         count(header.height, pass.y, pass.step_y));
  return sum;
}

/// All IDAT chunks together. The structure is right.
std::string compressed_bytes(std::string_view bytes) {
  std::string all;
  for (std::size_t at = signature.size();;) {
    const std::size_t length = big_endian(bytes, at);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (type == "IEND") return all;
    if (type == "IDAT") all += bytes.substr(at + 8, length);
    at += chunk_overhead + length;
  }
}

}  // namespace

Expected<PngHeader> check_png_structure(std::string_view bytes) {
  const auto header = read_header(bytes);
  if (!header) return header;
  std::uint64_t compressed = 0;
  std::size_t at = signature.size() + chunk_overhead + header_size;
  for (;;) {
    const auto chunk = read_chunk(bytes, at);
    if (!chunk) return tl::unexpected(chunk.error());
    if (chunk->type == "IEND") break;
    if (chunk->type == "IDAT") compressed += chunk->content.size();
    at += chunk_overhead + chunk->content.size();
  }
  // At least one bit per pixel and a filter byte per row must come out of the compressed bytes.
  const std::uint64_t least = (std::uint64_t{header->width} + 7) / 8 * header->height;
  if (least / largest_expansion > compressed) {
    return base::fail("found {} compressed bytes, too few for {} x {} pixels", compressed, header->width,
                      header->height);
  }
  return header;
}

Expected<void> check_png_pixels(std::string_view bytes) {
  constexpr std::uint64_t slack = 1 << 16;  // what some writers leave behind the last row
  constexpr std::size_t zlib_header = 2;    // the checksum at the end is left to the decoder
  const auto header = read_header(bytes);
  if (!header) return tl::unexpected(header.error());
  const std::uint64_t most = inflated_size(*header) + slack;
  const std::string compressed = compressed_bytes(bytes);
  if (compressed.size() < zlib_header) return base::fail("found {} compressed bytes", compressed.size());
  const std::unique_ptr<char[]> out(new (std::nothrow) char[most]);
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (out == nullptr || decompressor == nullptr) throw std::bad_alloc();
  std::size_t size = 0;
  switch (libdeflate_deflate_decompress(decompressor.get(), compressed.data() + zlib_header,
                                        compressed.size() - zlib_header, out.get(), most, &size)) {
    case LIBDEFLATE_SUCCESS:
      return {};
    case LIBDEFLATE_INSUFFICIENT_SPACE:
      return base::fail("found more compressed data than its {} x {} pixels take", header->width,
                        header->height);
    default:
      return base::fail("found damaged compressed data");
  }
}

}  // namespace tenebra::io
