// Views and accessors: their ranges in 64-bit checked arithmetic, and their values.
#include <fmt/core.h>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/gltf/model.h"

namespace tenebra::formats::gltf {
namespace {

using std::uint64_t;

uint64_t component_size(int type, const std::string& place) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      refuse("{}.componentType: found {}, expected 5120 to 5123, 5125 or 5126", place, type);
  }
}

/// Elements in memory: matrix columns start at multiples of four bytes.
struct Layout {
  int rows = 1;
  int columns = 1;
  uint64_t component = 4;
  uint64_t column_stride = 4;
  uint64_t element = 4;
};

Layout layout_of(const Accessor& accessor, const std::string& place) {
  Layout layout;
  switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
      break;
    case TINYGLTF_TYPE_VEC2:
      layout.rows = 2;
      break;
    case TINYGLTF_TYPE_VEC3:
      layout.rows = 3;
      break;
    case TINYGLTF_TYPE_VEC4:
      layout.rows = 4;
      break;
    case TINYGLTF_TYPE_MAT2:
      layout.rows = layout.columns = 2;
      break;
    case TINYGLTF_TYPE_MAT3:
      layout.rows = layout.columns = 3;
      break;
    case TINYGLTF_TYPE_MAT4:
      layout.rows = layout.columns = 4;
      break;
    default:
      refuse("{}.type: found an unknown one, expected SCALAR, VEC or MAT", place);
  }
  layout.component = component_size(accessor.componentType, place);
  layout.column_stride = layout.rows * layout.component;
  if (layout.columns > 1) layout.column_stride = (layout.column_stride + 3) / 4 * 4;
  layout.element = layout.column_stride * (layout.columns - 1) + layout.rows * layout.component;
  return layout;
}

/// The bytes of `count` elements of `element` bytes at `offset` in a view, `stride` apart.
const char* bytes_in_view(const Asset& asset, int view_index, uint64_t offset, uint64_t count,
                          uint64_t element, uint64_t stride, const std::string& place) {
  const auto& view = asset.model.bufferViews[static_cast<std::size_t>(view_index)];
  const uint64_t room = view.byteLength;
  if (offset > room || element > room - offset || count - 1 > (room - offset - element) / stride)
    refuse(
        "{}: found {} elements of {} bytes from offset {} with a byteStride of {}, expected them within the "
        "{} "
        "bytes of bufferViews[{}].byteLength",
        place, count, element, offset, stride, room, view_index);
  return asset.buffers[static_cast<std::size_t>(view.buffer)].data() + view.byteOffset + offset;
}

/// Says where elements lie at odd addresses; they are read byte by byte.
void note_alignment(Asset& asset, int view, uint64_t offset, uint64_t component, const std::string& place) {
  const uint64_t total = asset.model.bufferViews[static_cast<std::size_t>(view)].byteOffset + offset;
  if (offset % component != 0 || total % component != 0)
    asset.scene.warnings.push_back(
        fmt::format("{}: found total offset {}, expected a multiple of {}.", place, total, component));
}

template <class T>
T load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

double load_component(const char* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const auto value = load<std::int8_t>(bytes);
      return normalized ? std::max(value / 127.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes) / (normalized ? 255.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const auto value = load<std::int16_t>(bytes);
      return normalized ? std::max(value / 32767.0, -1.0) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(bytes);
    default:
      return load<float>(bytes);
  }
}

void load_element(const char* bytes, const Accessor& accessor, const Layout& layout, double* out) {
  for (int column = 0; column < layout.columns; ++column)
    for (int row = 0; row < layout.rows; ++row)
      *out++ = load_component(bytes + column * layout.column_stride + row * layout.component,
                              accessor.componentType, accessor.normalized);
}

void apply_sparse(const Asset& asset, const Accessor& accessor, const Layout& layout,
                  const std::string& place, std::vector<double>& values) {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<uint64_t>(sparse.count);
  if (sparse.count < 1 || count > accessor.count)
    refuse("{}.sparse.count: found {}, expected 1 to {}", place, sparse.count, accessor.count);
  for (const int view : {sparse.indices.bufferView, sparse.values.bufferView})
    if (asset.model.bufferViews[static_cast<std::size_t>(view)].byteStride != 0)
      refuse("{}.sparse: found bufferViews[{}] with a byteStride, expected none", place, view);
  const int index_type = sparse.indices.componentType;
  const uint64_t index_size = component_size(index_type, place + ".sparse.indices");
  const char* indices = bytes_in_view(asset, sparse.indices.bufferView, sparse.indices.byteOffset, count,
                                      index_size, index_size, place + ".sparse.indices");
  const char* elements = bytes_in_view(asset, sparse.values.bufferView, sparse.values.byteOffset, count,
                                       layout.element, layout.element, place + ".sparse.values");
  double last = -1;
  for (uint64_t i = 0; i < count; ++i) {
    const double index = load_component(indices + i * index_size, index_type, false);
    if (!(index > last && index < static_cast<double>(accessor.count)))
      refuse("{}.sparse.indices: found {} at {}, expected rising indices below {}", place, index, i,
             accessor.count);
    last = index;
    load_element(elements + i * layout.element, accessor, layout,
                 values.data() + static_cast<std::size_t>(index) * layout.rows * layout.columns);
  }
}

std::vector<double> read_unbudgeted(const Asset& asset, int index) {
  const std::string place = fmt::format("accessors[{}]", index);
  const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(index)];
  const Layout layout = layout_of(accessor, place);
  const std::size_t components = static_cast<std::size_t>(layout.rows * layout.columns);
  if (accessor.count == 0) refuse("{}.count: found 0, expected 1 or more", place);
  const char* bytes = nullptr;
  uint64_t stride = layout.element;
  if (accessor.bufferView >= 0) {
    const auto& view = asset.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    if (view.byteStride != 0) stride = view.byteStride;
    if (stride < layout.element)
      refuse("{}: found elements of {} bytes in a stride of {}, expected them to fit", place, layout.element,
             stride);
    bytes = bytes_in_view(asset, accessor.bufferView, accessor.byteOffset, accessor.count, layout.element,
                          stride, place);
  }
  std::vector<double> values(accessor.count * components);
  for (std::size_t i = 0; bytes && i < accessor.count; ++i)
    load_element(bytes + i * stride, accessor, layout, values.data() + i * components);
  if (accessor.sparse.isSparse) apply_sparse(asset, accessor, layout, place, values);
  return values;
}

/// What normalised integers of that type are divided by; 1 for floats.
double scale_of(const Accessor& accessor) {
  if (!accessor.normalized) return 1;
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 65535;
    default:
      return 1;
  }
}

/// Whether the bounds that the accessor states are those of its values, as floats or stored integers.
bool bounds_are_exact(const Accessor& accessor, const std::vector<double>& values) {
  const std::size_t components = static_cast<std::size_t>(component_count(accessor));
  if (accessor.minValues.size() != components || accessor.maxValues.size() != components) return true;
  const double scale = scale_of(accessor);
  for (std::size_t c = 0; c < components; ++c) {
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = c; i < values.size(); i += components) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    // -128 and -127 are both -1 as normalised bytes.
    const auto differ = [&](double stated, double found) {
      const double stored = scale > 1 ? std::round(found * scale) : found;
      return static_cast<float>(stated) != static_cast<float>(stored) && !(scale > 1 && stated < -scale);
    };
    if (differ(accessor.minValues[c], low) || differ(accessor.maxValues[c], high)) return false;
  }
  return true;
}

/// Compares values with the bounds that the accessor states: integers as stored, floats to their precision.
/// A difference is harmless. Returns whether there is one that the warnings do not name.
bool check_bounds(Asset& asset, std::size_t index, const std::vector<double>& values) {
  const Accessor& accessor = asset.model.accessors[index];
  const std::size_t components = static_cast<std::size_t>(component_count(accessor));
  std::size_t outside = 0, not_finite = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t c = i % components;
    const double slack = 1e-5 * std::max(1.0, std::abs(values[i]));
    if (!std::isfinite(values[i])) {
      ++not_finite;
    } else if (!accessor.normalized) {
      outside += c < accessor.minValues.size() && values[i] < accessor.minValues[c] - slack;
      outside += c < accessor.maxValues.size() && values[i] > accessor.maxValues[c] + slack;
    }
  }
  auto& warnings = asset.scene.warnings;
  if (outside > 0)
    warnings.push_back(fmt::format(
        "accessors[{}]: found {} values outside its min and max; kept as they are.", index, outside));
  if (not_finite > 0)
    warnings.push_back(fmt::format(
        "accessors[{}]: found {} values that are not finite; triangles that use them are dropped.", index,
        not_finite));
  return outside == 0 && not_finite == 0 && !bounds_are_exact(accessor, values);
}

/// All alignments of accessor `index`, whose values have been read.
void note_alignments(Asset& asset, std::size_t index) {
  const Accessor& accessor = asset.model.accessors[index];
  const std::string place = fmt::format("accessors[{}]", index);
  const Layout layout = layout_of(accessor, place);
  if (accessor.bufferView >= 0)
    note_alignment(asset, accessor.bufferView, accessor.byteOffset, layout.component, place);
  if (!accessor.sparse.isSparse) return;
  const auto& indices = accessor.sparse.indices;
  const auto& values = accessor.sparse.values;
  note_alignment(asset, indices.bufferView, indices.byteOffset, component_size(indices.componentType, place),
                 place + ".sparse.indices");
  note_alignment(asset, values.bufferView, values.byteOffset, layout.component, place + ".sparse.values");
}

void check_view(Asset& asset, std::size_t index) {
  const auto& view = asset.model.bufferViews[index];
  const uint64_t room = asset.buffers[static_cast<std::size_t>(view.buffer)].size();
  auto& warnings = asset.scene.warnings;
  if (view.byteLength == 0)
    warnings.push_back(fmt::format("bufferViews[{}].byteLength: found 0, expected 1 or more.", index));
  if (view.byteOffset > room || view.byteLength > room - view.byteOffset)
    refuse(
        "bufferViews[{}]: found {} bytes from offset {}, expected them within the {} bytes of "
        "buffers[{}].byteLength and of its file, which may be cut off",
        index, view.byteLength, view.byteOffset, room, view.buffer);
  if (view.byteStride != 0 && (view.byteStride < 4 || view.byteStride > 252 || view.byteStride % 4 != 0))
    warnings.push_back(
        fmt::format("bufferViews[{}].byteStride: found {}, expected a multiple of 4 from 4 to 252.", index,
                    view.byteStride));
  if (view.byteStride != 0 && view.target == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER)
    warnings.push_back(fmt::format(
        "bufferViews[{}].byteStride: found {} on a view of indices, expected none.", index, view.byteStride));
}

}  // namespace

int component_count(const Accessor& accessor) {
  return tinygltf::GetNumComponentsInType(accessor.type);
}

void check_accessors(Asset& asset) {
  for (std::size_t i = 0; i < asset.model.bufferViews.size(); ++i) check_view(asset, i);
  // Beside one element for each byte of the buffers: only overlapping views could have more.
  std::uint64_t most_elements = 20'000'000;
  for (const std::string& buffer : asset.buffers) most_elements += buffer.size();
  Budget work(most_elements);
  std::size_t loose = 0, first_loose = 0, unaligned = 0;
  constexpr std::size_t most_unaligned = 10;  // that are named
  for (std::size_t i = 0; i < asset.model.accessors.size(); ++i) {
    const Accessor& accessor = asset.model.accessors[i];
    if (accessor.count == 0) continue;  // or of an unknown type: refused where its values are needed
    const bool all_zeros = accessor.bufferView < 0 && !accessor.sparse.isSparse;
    if (all_zeros) continue;
    work.take(accessor.count, 1, fmt::format("accessors[{}].count", i));
    Budget passing = asset.budget;  // the values live only for the check
    passing.take(accessor.count, 8 * static_cast<std::uint64_t>(component_count(accessor)),
                 fmt::format("accessors[{}].count", i));
    const std::size_t said = asset.scene.warnings.size();
    if (unaligned < most_unaligned) note_alignments(asset, i);
    unaligned += asset.scene.warnings.size() > said;
    if (check_bounds(asset, i, read_unbudgeted(asset, static_cast<int>(i))) && loose++ == 0) first_loose = i;
  }
  if (loose > 0)
    asset.scene.warnings.push_back(
        fmt::format("accessors[{}]{}: found a min or max that is not that of its values; kept as they are.",
                    first_loose, loose > 1 ? fmt::format(" and {} more", loose - 1) : ""));
}

std::vector<double> read_numbers(Asset& asset, int index) {
  const auto count = asset.model.accessors[static_cast<std::size_t>(index)].count;
  asset.budget.take(count, 16, fmt::format("accessors[{}].count", index));
  return read_unbudgeted(asset, index);
}

std::vector<std::uint32_t> read_indices(Asset& asset, int index, const std::string& what) {
  const Accessor& accessor = asset.model.accessors[static_cast<std::size_t>(index)];
  const int type = accessor.componentType;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || accessor.normalized ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT))
    refuse("{}: found accessors[{}] of another format, expected unsigned SCALAR integers", what, index);
  if (accessor.bufferView >= 0 &&
      asset.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride != 0)
    asset.scene.warnings.push_back(
        fmt::format("{}: found a bufferView with byteStride, expected tightly packed indices.", what));
  const std::vector<double> numbers = read_numbers(asset, index);
  return {numbers.begin(), numbers.end()};
}

}  // namespace tenebra::formats::gltf
