// EXT_meshopt_compression, and KHR_meshopt_compression, its later name: views of compressed data become
// buffers of their own.
#include <fmt/core.h>
#include <algorithm>

#include "formats/gltf/model.h"

#ifdef TENEBRA_MESHOPT
#include <meshoptimizer.h>
#endif

namespace tenebra::formats::gltf {

void set_view(Asset& asset, tinygltf::BufferView& view, std::string bytes) {
  view.buffer = static_cast<int>(asset.buffers.size());
  view.byteOffset = 0;
  view.byteLength = bytes.size();
  asset.buffers.push_back(std::move(bytes));
}

void pay_for_decoded(Asset& asset, std::uint64_t stored, std::uint64_t decoded, const std::string& place) {
  const std::uint64_t allowed = std::min({decoded, 16 * stored, asset.decoded_allowed});
  asset.decoded_allowed -= allowed;  // views may share stored bytes: together no more than the file allows
  asset.budget.give(8 * allowed);
  asset.budget.take(decoded, 1, place);
}

namespace {

constexpr const char* compression_names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

struct Compressed {
  std::string place;
  std::string_view bytes;
  std::uint64_t count = 0, stride = 0;
  std::string mode, filter;
};

std::uint64_t integer(const Value& value, const char* name) {
  return static_cast<std::uint64_t>(number_or(value, name, 0));
}

/// The stored bytes of view `index`, checked against their buffer; counts checked against each other.
Compressed read_header(const Asset& asset, std::size_t index, const char* name, const Value& value) {
  Compressed result;
  result.place = fmt::format("bufferViews[{}].extensions.{}", index, name);
  const std::string& buffer = asset.buffers[integer(value, "buffer")];
  const std::uint64_t offset = integer(value, "byteOffset"), length = integer(value, "byteLength");
  if (offset > buffer.size() || length > buffer.size() - offset)
    refuse("{}: found {} bytes from offset {}, expected them within the {} bytes of buffers[{}]",
           result.place, length, offset, buffer.size(), integer(value, "buffer"));
  result.bytes = std::string_view(buffer).substr(offset, length);
  result.count = integer(value, "count");
  result.stride = integer(value, "byteStride");
  result.mode = member(value, "mode")->Get<std::string>();
  const Value* filter = member(value, "filter");
  result.filter = filter ? filter->Get<std::string>() : "NONE";
  const auto& view = asset.model.bufferViews[index];
  if (result.stride == 0 || result.count == 0 || result.count > view.byteLength / result.stride ||
      result.count * result.stride != view.byteLength)
    refuse("{}: found {} elements of {} bytes, expected the {} bytes of the view", result.place, result.count,
           result.stride, view.byteLength);
  return result;
}

void check_mode(const Compressed& c) {
  const bool attributes = c.mode == "ATTRIBUTES", triangles = c.mode == "TRIANGLES";
  if (!attributes && !triangles && c.mode != "INDICES")
    refuse("{}.mode: found '{}', expected ATTRIBUTES, TRIANGLES or INDICES", c.place, c.mode);
  const bool fits = attributes ? c.stride % 4 == 0 && c.stride <= 256 : c.stride == 2 || c.stride == 4;
  if (!fits)
    refuse("{}.byteStride: found {}, expected {}", c.place, c.stride,
           attributes ? "a multiple of 4 up to 256" : "2 or 4");
  if (triangles && c.count % 3 != 0)
    refuse("{}.count: found {}, expected a multiple of 3 for TRIANGLES", c.place, c.count);
  if (c.filter == "NONE") return;
  if (!attributes) refuse("{}.filter: found '{}' on {}, expected NONE", c.place, c.filter, c.mode);
  const bool right_stride = c.filter == "OCTAHEDRAL"   ? c.stride == 4 || c.stride == 8
                            : c.filter == "QUATERNION" ? c.stride == 8
                                                       : c.filter == "EXPONENTIAL";
  if (!right_stride)
    refuse(
        "{}.filter: found '{}' with a stride of {}, expected NONE, OCTAHEDRAL (4 or 8), QUATERNION (8) or "
        "EXPONENTIAL",
        c.place, c.filter, c.stride);
}

#ifdef TENEBRA_MESHOPT
std::string decode(const Compressed& c) {
  std::string out(c.count * c.stride, '\0');
  const auto* bytes = reinterpret_cast<const unsigned char*>(c.bytes.data());
  int fault = 0;
  if (c.mode == "ATTRIBUTES")
    fault = meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, bytes, c.bytes.size());
  else if (c.mode == "TRIANGLES")
    fault = meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, bytes, c.bytes.size());
  else
    fault = meshopt_decodeIndexSequence(out.data(), c.count, c.stride, bytes, c.bytes.size());
  if (fault != 0)
    refuse("{}: found compressed bytes that do not decode (code {}), expected {} of meshoptimizer", c.place,
           fault, c.mode);
  if (c.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), c.count, c.stride);
  if (c.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), c.count, c.stride);
  if (c.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), c.count, c.stride);
  return out;
}
#else
std::string decode(const Compressed& c) {
  refuse("{}: found compressed geometry, expected a build with meshoptimizer (package libmeshoptimizer-dev)",
         c.place);
}
#endif

}  // namespace

bool has_meshopt() {
#ifdef TENEBRA_MESHOPT
  return true;
#else
  return false;
#endif
}

void decode_meshopt(Asset& asset) {
  for (std::size_t i = 0; i < asset.model.bufferViews.size(); ++i) {
    auto& view = asset.model.bufferViews[i];
    const auto* const name =
        std::find_if(std::begin(compression_names), std::end(compression_names),
                     [&](const char* candidate) { return view.extensions.contains(candidate); });
    if (name == std::end(compression_names)) continue;
    // Without the library the file's fallback is read, where there is one.
    if (!has_meshopt() && !asset.buffers[static_cast<std::size_t>(view.buffer)].empty()) continue;
    const Compressed compressed = read_header(asset, i, *name, view.extensions.at(*name));
    check_mode(compressed);
    pay_for_decoded(asset, compressed.bytes.size(), compressed.count * compressed.stride, compressed.place);
    set_view(asset, view, decode(compressed));
  }
}

}  // namespace tenebra::formats::gltf
