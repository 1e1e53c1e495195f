// export_glb: a Scene as one binary glTF 2.0 file; the container around what GlbWriter's tables fill.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/fail.h"
#include "formats/glb/writer.h"
#include "formats/import_scene.h"
#include "io/output_file.h"

namespace tenebra::formats {
namespace {

void add_word(std::string& out, std::size_t word) {
  for (int i = 0; i < 4; ++i) out += static_cast<char>(word >> (8 * i) & 0xFF);
}

/// Whether all numbers in `value` are finite and no larger than the largest float: readers refuse others.
bool fit_floats(const GlbJson& value) {
  if (value.is_structured()) return std::all_of(value.begin(), value.end(), fit_floats);
  return !value.is_number_float() ||
         std::abs(value.get<double>()) <= static_cast<double>(std::numeric_limits<float>::max());
}

[[noreturn]] void refuse_unfit_number(const GlbJson& root) {
  const GlbJson flat = root.flatten();
  const auto first = std::find_if_not(flat.begin(), flat.end(), fit_floats);
  refuse("{}: found {}, expected a number that a float can hold", first.key(), first->get<double>());
}

}  // namespace

GlbWriter::GlbWriter(const Scene& scene, double fps, const GlbAdditions& additions)
    : scene_(scene), fps_(fps), additions_(additions) {}

std::string GlbWriter::write() {
  write_materials();
  write_meshes();
  write_lights();
  write_cameras();
  write_skins();
  write_nodes();
  write_clips();
  if (binary_.not_finite > 0)
    losses.push_back(fmt::format("{} numbers are not finite, which glTF forbids.", binary_.not_finite));
  std::string& binary = binary_.bytes;
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  if (!binary.empty()) root_["buffers"].push_back({{"byteLength", binary.size()}});
  for (auto table = root_.begin(); table != root_.end();)
    table = table.value().is_null() ? root_.erase(table) : std::next(table);
  if (!fit_floats(root_)) refuse_unfit_number(root_);
  std::string json = root_.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t chunk = binary.empty() ? 0 : 8 + binary.size();
  const std::size_t size = 20 + json.size() + chunk;
  if (size > GlbBinary::max_bytes)
    refuse("found {} bytes to write, expected at most {} in a GLB", size, GlbBinary::max_bytes);
  std::string out = "glTF";
  out.reserve(size);
  add_word(out, 2);
  add_word(out, size);
  add_word(out, json.size());
  out += "JSON" + json;
  if (chunk == 0) return out;
  add_word(out, binary.size());
  out += std::string("BIN\0", 4);
  return out += binary;
}

Expected<std::vector<std::string>> export_glb(const Scene& scene, const std::filesystem::path& path,
                                              double fps) {
  return export_glb(scene, path, fps, {});
}

Expected<std::vector<std::string>> export_glb(const Scene& scene, const std::filesystem::path& path,
                                              double fps, const GlbAdditions& additions) {
  try {
    GlbWriter writer(scene, fps, additions);
    if (auto written = io::write_file(path, writer.write()); !written) return tl::unexpected(written.error());
    return std::move(writer.losses);
  } catch (const ImportFailure& failure) {
    return base::fail("{}: {}.", path.string(), failure.what());
  } catch (const std::exception& error) {
    return base::fail("{}: found a scene that cannot be written ({}), expected a smaller one.", path.string(),
                      error.what());
  }
}

}  // namespace tenebra::formats
