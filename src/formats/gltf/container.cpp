#include "formats/gltf/container.h"

#include <algorithm>
#include <cstdint>

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
    if (result.binary) refuse("GLB chunk {}: found a second BIN chunk, expected one", index);
    if (index != 1)
      result.warnings.push_back(fmt::format("GLB chunk {}: found BIN, expected it right after JSON.", index));
    result.binary = body;
  }  // other types are to be skipped
}

void check_glb_header(std::string_view bytes) {
  if (bytes.size() < 12)
    refuse("GLB header: found {} bytes, expected at least 12: the file is cut off, copy it again",
           bytes.size());
  if (word(bytes, 0) != glb_magic) refuse("GLB header: found magic {:#010x}, expected glTF", word(bytes, 0));
  if (word(bytes, 4) == 1)
    refuse("GLB header: found version 1, expected 2: gltf-pipeline makes glTF 2.0 of it");
  if (word(bytes, 4) != 2) refuse("GLB header: found version {}, expected 2", word(bytes, 4));
}

/// Where the chunk after one of `length` bytes at `offset` begins: chunks whose length is no multiple of 4
/// may or may not be padded, which the next chunk's type tells.
std::size_t end_of_chunk(std::string_view bytes, std::size_t offset, std::size_t length) {
  const std::size_t plain = offset + 8 + length, padded = (plain + 3) / 4 * 4;
  const auto begins_binary = [&](std::size_t at) {
    return bytes.size() >= at + 8 && word(bytes, at + 4) == bin_chunk;
  };
  if (begins_binary(plain)) return plain;
  return begins_binary(padded) || padded == bytes.size() ? padded : plain;
}

GltfContainer split_glb(std::string_view bytes) {
  check_glb_header(bytes);
  GltfContainer result;
  result.is_glb = true;
  const std::size_t stated = word(bytes, 8);
  std::size_t offset = 12;
  constexpr std::size_t least = 20;  // header and one chunk's
  const std::size_t end = stated < least ? bytes.size() : std::min(bytes.size(), stated);
  for (int index = 0; offset < end; ++index) {
    if (bytes.size() - offset < 8) {
      if (result.json.empty())
        refuse("GLB chunk {}: found {} bytes of header, expected 8: the file is cut off, copy it again",
               index, bytes.size() - offset);
      result.warnings.push_back(fmt::format("GLB chunk {}: found {} bytes of header, expected 8; not read.",
                                            index, bytes.size() - offset));
      offset = bytes.size();
      break;
    }
    const std::size_t length = word(bytes, offset);
    if (length % 4 != 0)
      result.warnings.push_back(
          fmt::format("GLB chunk {}: found length {}, expected a multiple of 4.", index, length));
    if (length > bytes.size() - offset - 8)
      refuse(
          "GLB chunk {}: found length {}, expected at most {} (stated length of the file {}, found {} "
          "bytes): "
          "the file is cut off, copy it again",
          index, length, bytes.size() - offset - 8, stated, bytes.size());
    take_chunk(result, word(bytes, offset + 4), bytes.substr(offset + 8, length), index);
    offset = end_of_chunk(bytes, offset, length);
  }
  if (result.json.empty()) refuse("GLB: found no chunk, expected JSON");
  if (offset < bytes.size())
    result.warnings.push_back(fmt::format(
        "GLB: found {} bytes behind the end that its header states; not read.", bytes.size() - offset));
  if (stated > bytes.size() || offset > stated)
    result.warnings.push_back(
        fmt::format("GLB header: found a stated length of {}, expected the file's {} bytes; its "
                    "chunks are whole.",
                    stated, bytes.size()));
  return result;
}

/// Without a byte order mark, and without zeros behind it, with which some exporters pad a chunk.
void trim_json(GltfContainer& container) {
  std::string_view& json = container.json;
  if (json.starts_with("\xEF\xBB\xBF")) {
    json.remove_prefix(3);
    container.warnings.push_back("JSON: found a byte order mark, expected {.");
  }
  const std::size_t size = json.size();
  while (!json.empty() && json.back() == '\0') json.remove_suffix(1);
  if (json.size() < size) container.warnings.push_back("JSON: found zeros behind it, expected blanks.");
}

}  // namespace

GltfContainer split_gltf(std::string_view bytes, bool expect_glb) {
  const bool is_glb = expect_glb || (bytes.size() >= 4 && word(bytes, 0) == glb_magic);
  GltfContainer container = is_glb ? split_glb(bytes) : GltfContainer{bytes, std::nullopt, false, {}};
  trim_json(container);
  return container;
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
