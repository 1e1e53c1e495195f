#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "gltf_writer.h"

namespace tenebra::converter {
namespace {

constexpr int float_component = 5126, short_component = 5123;

std::size_t components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "MAT4") return 16;
  return static_cast<std::size_t>(type.back() - '0');
}

/// glTF asks for bounds of positions and times.
void add_bounds(const float* values, std::size_t count, std::size_t components, Json& accessor) {
  for (std::size_t k = 0; k < components; ++k) {
    float low = INFINITY, high = -INFINITY;
    for (std::size_t i = 0; i < count; ++i) {
      low = std::min(low, values[components * i + k]);
      high = std::max(high, values[components * i + k]);
    }
    accessor["min"].push_back(low);
    accessor["max"].push_back(high);
  }
}

void put_word(std::uint32_t word, std::FILE* file) {
  for (int i = 0; i < 4; ++i) std::fputc(static_cast<int>(word >> 8 * i & 255), file);
}

}  // namespace

std::size_t Glb::add(const char* name, Json entry) {
  Json& list = json[name];
  list.push_back(std::move(entry));
  return list.size() - 1;
}

std::size_t Glb::add_view(const void* bytes, std::size_t size) {
  const std::size_t offset = bytes_.size();
  bytes_.append(static_cast<const char*>(bytes), size);
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
}

std::size_t Glb::add_accessor(const void* values, std::size_t count, int component, const char* type) {
  const std::size_t components = components_of(type), size = component == short_component ? 2 : 4;
  Json accessor{{"bufferView", add_view(values, count * components * size)},
                {"componentType", component},
                {"count", count},
                {"type", type}};
  if (component == float_component && components <= 3)
    add_bounds(static_cast<const float*>(values), count, components, accessor);
  return add("accessors", std::move(accessor));
}

void Glb::write(std::FILE* file) {
  if (!bytes_.empty()) json["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;
  const std::size_t whole = 12 + 8 + text.size() + (bytes_.empty() ? 0 : 8 + bytes_.size());
  if (whole > ~std::uint32_t{0}) throw std::runtime_error("found more than 4 GiB, expected a smaller scene");
  for (const std::uint32_t word :
       {magic, 2u, static_cast<std::uint32_t>(whole), static_cast<std::uint32_t>(text.size()), json_chunk})
    put_word(word, file);
  std::fwrite(text.data(), 1, text.size(), file);
  if (bytes_.empty()) return;
  put_word(static_cast<std::uint32_t>(bytes_.size()), file);
  put_word(bin_chunk, file);
  std::fwrite(bytes_.data(), 1, bytes_.size(), file);
}

std::string picture_uri(const std::filesystem::path& folder, std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  std::error_code error;
  const bool elsewhere = name.find(':') != std::string::npos || name.starts_with('/');
  if (elsewhere || !std::filesystem::is_regular_file(folder / name, error))
    name = name.substr(name.find_last_of("/:") + 1);
  std::string uri;
  for (const char c : name) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::strchr("-._~/", c) != nullptr;
    uri += plain && c != '\0' ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

}  // namespace tenebra::converter
