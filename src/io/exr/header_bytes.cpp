#include "io/exr/header_bytes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "base/fail.h"

namespace tenebra::io::exr {
namespace {

constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
constexpr std::uint32_t several_parts = 0x1000;  // of the version's flags
constexpr std::size_t longest_name = 255;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (int i = 3; i >= 0; --i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return number;
}

/// Takes a text that ends in a zero off `bytes`; false: there is none.
bool take_name(std::string_view& bytes, std::string_view& name) {
  const std::size_t end = bytes.substr(0, longest_name + 1).find('\0');
  if (end == std::string_view::npos) return false;
  name = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  return true;
}

tl::unexpected<Error> cut_short() {
  return base::fail("found a damaged OpenEXR picture (its header ends too soon)");
}

struct TypeSize {
  std::string_view type;
  std::uint32_t bytes;
};
/// Types of attributes whose values have one size, of which the library reads as much, whatever size is
/// stated.
constexpr std::array<TypeSize, 24> type_sizes{{{"box2f", 16},
                                               {"box2i", 16},
                                               {"chromaticities", 32},
                                               {"compression", 1},
                                               {"double", 8},
                                               {"envmap", 1},
                                               {"deepImageState", 1},
                                               {"float", 4},
                                               {"int", 4},
                                               {"keycode", 28},
                                               {"lineOrder", 1},
                                               {"m33f", 36},
                                               {"m33d", 72},
                                               {"m44f", 64},
                                               {"m44d", 128},
                                               {"rational", 8},
                                               {"tiledesc", 9},
                                               {"timecode", 8},
                                               {"v2f", 8},
                                               {"v2i", 8},
                                               {"v2d", 16},
                                               {"v3f", 12},
                                               {"v3d", 24},
                                               {"v3i", 12}}};

/// Whether channels, up to an empty name, are all of `value`.
bool holds_channels(std::string_view value) {
  constexpr std::size_t channel_bytes = 16;  // after its name
  for (std::string_view name; take_name(value, name);) {
    if (name.empty()) return value.empty();
    if (value.size() < channel_bytes) return false;
    value.remove_prefix(channel_bytes);
  }
  return false;
}

/// Whether texts, each with its size before it, are all of `value`.
bool holds_texts(std::string_view value) {
  while (value.size() >= 4) {
    const std::uint32_t size = number_at(value, 0);
    value.remove_prefix(4);
    if (size > value.size()) return false;
    value.remove_prefix(size);
  }
  return value.empty();
}

/// Width, height and four bytes for each of its pixels.
bool holds_preview(std::string_view value) {
  if (value.size() < 8) return false;
  const std::uint64_t width = number_at(value, 0), height = number_at(value, 4),
                      pixels = (value.size() - 8) / 4;
  return (value.size() - 8) % 4 == 0 && width <= pixels && height <= pixels && width * height == pixels;
}

/// Whether the library reads just `value`: after more or less of it, it would take what follows for
/// attributes that nobody has checked.
bool is_whole(std::string_view type, std::string_view value) {
  if (type == "chlist") return holds_channels(value);
  if (type == "stringvector") return holds_texts(value);
  if (type == "preview") return holds_preview(value);
  if (type == "floatvector") return value.size() % 4 == 0;
  const auto* const known = std::find_if(type_sizes.begin(), type_sizes.end(),
                                         [&](const TypeSize& size) { return size.type == type; });
  return known == type_sizes.end() || value.size() == known->bytes;
}

/// Takes the attributes of one part off `bytes`; their number.
Expected<std::size_t> take_attributes(std::string_view& bytes) {
  for (std::size_t count = 0;; ++count) {
    std::string_view name, type;
    if (!take_name(bytes, name)) return cut_short();
    if (name.empty()) return count;
    if (!take_name(bytes, type) || bytes.size() < 4) return cut_short();
    const std::uint32_t size = number_at(bytes, 0);
    bytes.remove_prefix(4);
    if (size > bytes.size())
      return base::fail("found a damaged OpenEXR picture (an attribute of {} bytes, where {} follow)", size,
                        bytes.size());
    if (!is_whole(type, bytes.substr(0, size)))
      return base::fail("found a damaged OpenEXR picture (an attribute whose {} bytes are no {})", size,
                        type);
    bytes.remove_prefix(size);
  }
}

}  // namespace

Expected<void> check_header_bytes(std::string_view bytes) {
  if (!bytes.starts_with(magic) || bytes.size() < 8)
    return base::fail("found no OpenEXR picture, expected one that starts with the bytes 76 2f 31 01");
  const bool parts = (number_at(bytes, 4) & several_parts) != 0;
  bytes.remove_prefix(8);
  for (;;) {  // a header without attributes ends the list of parts
    const auto count = take_attributes(bytes);
    if (!count) return tl::unexpected(count.error());
    if (!parts || *count == 0) return {};
  }
}

}  // namespace tenebra::io::exr
