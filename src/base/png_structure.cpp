#include "base/png_structure.h"

#include "base/fail.h"

#include <array>
#include <cstddef>

namespace tenebra::base {
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
    return fail("the file ends at byte {} without an IEND chunk", bytes.size());
  const std::size_t length = big_endian(bytes, at);
  const std::string_view type = bytes.substr(at + 4, 4);
  for (const char c : type) {
    if ((c < 'a' || c > 'z') && (c < 'A' || c > 'Z')) return fail("found no chunk name at byte {}", at + 4);
  }
  if (length > bytes.size() - at - chunk_overhead) {
    return fail("found the {} chunk of {} bytes at byte {} cut off by the file's end", type, length, at);
  }
  if (crc32(bytes.substr(at + 4, 4 + length)) != big_endian(bytes, at + 8 + length)) {
    return fail("found a wrong checksum in the {} chunk at byte {}", type, at);
  }
  return Chunk{type, bytes.substr(at + 8, length)};
}

Expected<PngHeader> read_header(std::string_view bytes) {
  if (!bytes.starts_with(signature)) return fail("found no PNG signature");
  const auto chunk = read_chunk(bytes, signature.size());
  if (!chunk) return tl::unexpected(chunk.error());
  if (chunk->type != "IHDR" || chunk->content.size() != header_size) {
    return fail("found {} of {} bytes as the first chunk, expected IHDR of {}", chunk->type,
                chunk->content.size(), header_size);
  }
  return PngHeader{big_endian(chunk->content, 0), big_endian(chunk->content, 4),
                   static_cast<unsigned char>(chunk->content[8])};
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
    return fail("found {} compressed bytes, too few for {} x {} pixels", compressed, header->width,
                header->height);
  }
  return header;
}

}  // namespace tenebra::base
