#include "formats/gltf/container.h"

#include <cstdint>
#include <cstring>

#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

constexpr std::uint32_t glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

// The parsers' memory and stack: a parsed value costs up to 120 bytes, an object of a typed table 700.
constexpr int max_json_depth = 64;
constexpr std::size_t max_json_values = 2'000'000;
constexpr std::size_t max_json_objects = 200'000;

std::uint32_t word(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

void take_chunk(GltfContainer& result, std::uint32_t type, std::string_view body, int index) {
  if (index == 0) {
    if (type != json_chunk) refuse("GLB chunk 0: found type {:#010x}, expected JSON", type);
    if (body.empty()) refuse("GLB chunk 0: found no bytes, expected JSON");
    result.json = body;
  } else if (type == json_chunk) {
    refuse("GLB chunk {}: found a second JSON chunk, expected one", index);
  } else if (type == bin_chunk) {
    if (index != 1) refuse("GLB chunk {}: found BIN, expected it right after JSON", index);
    result.binary = body;
  }  // other types are to be skipped
}

GltfContainer split_glb(std::string_view bytes) {
  if (bytes.size() < 12) refuse("GLB header: found {} bytes, expected at least 12", bytes.size());
  if (word(bytes, 0) != glb_magic) refuse("GLB header: found magic {:#010x}, expected glTF", word(bytes, 0));
  if (word(bytes, 4) != 2) refuse("GLB header: found version {}, expected 2", word(bytes, 4));
  if (word(bytes, 8) > bytes.size() || word(bytes, 8) < 12)
    refuse("GLB header: found a stated length of {}, expected the file's {} bytes", word(bytes, 8),
           bytes.size());
  GltfContainer result;
  result.bytes_behind = bytes.size() - word(bytes, 8);
  bytes = bytes.substr(0, word(bytes, 8));
  result.is_glb = true;
  std::size_t offset = 12;
  for (int index = 0; offset < bytes.size(); ++index) {
    if (bytes.size() - offset < 8)
      refuse("GLB chunk {}: found {} bytes of header, expected 8", index, bytes.size() - offset);
    const std::size_t length = word(bytes, offset);
    if (length % 4 != 0) refuse("GLB chunk {}: found length {}, expected a multiple of 4", index, length);
    if (length > bytes.size() - offset - 8)
      refuse("GLB chunk {}: found length {}, expected at most {}", index, length, bytes.size() - offset - 8);
    take_chunk(result, word(bytes, offset + 4), bytes.substr(offset + 8, length), index);
    offset += 8 + length;
  }
  if (result.json.empty()) refuse("GLB: found no chunk, expected JSON");
  return result;
}

}  // namespace

GltfContainer split_gltf(std::string_view bytes, bool expect_glb) {
  if (expect_glb || (bytes.size() >= 4 && word(bytes, 0) == glb_magic)) return split_glb(bytes);
  if (bytes.substr(0, 3) == "\xEF\xBB\xBF") refuse("JSON: found a byte order mark, expected {{");
  return {bytes, std::nullopt, false};
}

void check_json_size(std::string_view json) {
  int depth = 0;
  std::size_t values = 1, objects = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
      continue;
    }
    if (c == '"') in_string = true;
    if (c == '{') ++objects;
    if (c == '{' || c == '[' || c == ',') ++values;
    if ((c == '{' || c == '[') && ++depth > max_json_depth)
      refuse("JSON offset {}: found nesting deeper than {}, expected less", i, max_json_depth);
    if (c == '}' || c == ']') --depth;
  }
  if (values > max_json_values) refuse("JSON: found {} values, expected at most {}", values, max_json_values);
  if (objects > max_json_objects)
    refuse("JSON: found {} objects, expected at most {}", objects, max_json_objects);
}

}  // namespace tenebra::formats
