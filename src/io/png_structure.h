// The outer structure of a PNG file, checked before any of it is decoded: chunks, checksums, sizes.
#pragma once

#include <cstdint>
#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::io {

struct PngHeader {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int bit_depth = 0;
  int color_type = 0;
  bool interlaced = false;
};

/// Header of a PNG file whose chunks are whole, in order (IHDR first, IEND last) and match their checksums,
/// and whose compressed bytes can hold the pixels that the header claims. Fails with a phrase that names what
/// was found
/// ("found ... where ..."), without the file's name.
Expected<PngHeader> check_png_structure(std::string_view bytes);

/// Checks a PNG whose structure is right: fails with a phrase if its compressed bytes are damaged or inflate
/// to more than the rows of its header (and 64 KiB): a decoder that does not ask first would take memory
/// without end. Takes no more memory than these rows and the file.
Expected<void> check_png_pixels(std::string_view bytes);

}  // namespace tenebra::io
