// GeoTIFF 1.1 (OGC 19-008) on TIFF 6.0: one strip of floats and the tags that say where they lie.
#include <bit>
#include <vector>

#include "sun/plan.h"

namespace tenebra::sun {
namespace {

void add_bytes(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
}

enum Type : std::uint16_t { shorts = 3, longs = 4, doubles = 12 };

/// The directory of a file whose picture stands behind it.
class Tags {
public:
  explicit Tags(int count) : data_at_(header + 2 + 12 * static_cast<std::size_t>(count) + 4) {}
  /// In ascending order of `tag`.
  void add(int tag, std::uint32_t value, Type type = longs) { add_entry(tag, type, 1, value); }
  void add(int tag, const std::vector<double>& values) {
    add_entry(tag, doubles, values.size(), data_at_ + data_.size());
    for (const double value : values) add_bytes(data_, std::bit_cast<std::uint64_t>(value), 8);
  }
  void add(int tag, const std::vector<std::uint16_t>& values) {
    add_entry(tag, shorts, values.size(), data_at_ + data_.size());
    for (const std::uint16_t value : values) add_bytes(data_, value, 2);
    data_.resize((data_.size() + 7) / 8 * 8);
  }
  std::string file() const {
    std::string out("II\x2A\0", 4);
    add_bytes(out, header, 4);
    add_bytes(out, entries_.size() / 12, 2);
    out += entries_;
    add_bytes(out, 0, 4);  // no other directory
    return out + data_;
  }

private:
  static constexpr std::size_t header = 8;

  void add_entry(int tag, Type type, std::size_t count, std::size_t value) {
    add_bytes(entries_, static_cast<std::uint64_t>(tag), 2), add_bytes(entries_, type, 2);
    add_bytes(entries_, count, 4), add_bytes(entries_, value, 4);
  }

  std::size_t data_at_;
  std::string entries_, data_;
};

/// GeoKeyDirectoryTag: version, number of keys, and the keys.
std::vector<std::uint16_t> keys_of(int epsg) {
  constexpr std::uint16_t model = 1024, raster = 1025, projection = 3072;
  constexpr std::uint16_t projected = 1, user_defined = 32767, pixel_is_area = 1;
  std::vector<std::uint16_t> keys{1, 1, 1, 2};
  keys.insert(keys.end(), {model, 0, 1, epsg > 0 ? projected : user_defined, raster, 0, 1, pixel_is_area});
  if (epsg > 0) {
    keys[3] = 3;
    keys.insert(keys.end(), {projection, 0, 1, static_cast<std::uint16_t>(epsg)});
  }
  return keys;
}

}  // namespace

std::string geotiff_of(const Study& study, int epsg) {
  const Grid& grid = study.receivers.grid;
  const FileFrame& file = study.scene.frame;
  const glm::dvec3 corner = file.to_file({grid.west, grid.height, -grid.north});
  const double north = file.up == UpAxis::z ? corner.y : -corner.z, cell = grid.cell_m / file.metres_per_unit;
  const std::vector<std::uint16_t> keys = keys_of(epsg);
  constexpr int count = 13;
  constexpr std::size_t numbers = 8 * (3 + 6);
  const std::size_t picture_at = 8 + 2 + 12 * count + 4 + numbers + (2 * keys.size() + 7) / 8 * 8;
  const auto columns = static_cast<std::uint32_t>(grid.columns), rows = static_cast<std::uint32_t>(grid.rows);
  Tags tags(count);
  tags.add(256, columns), tags.add(257, rows);
  tags.add(258, 32, shorts), tags.add(259, 1, shorts);  // bits; not compressed
  tags.add(262, 1, shorts);                             // 0 is black
  tags.add(273, static_cast<std::uint32_t>(picture_at));
  tags.add(277, 1, shorts), tags.add(278, rows);  // one channel, one strip
  tags.add(279, 4 * columns * rows);
  tags.add(339, 3, shorts);                                           // floats
  tags.add(33550, std::vector<double>{cell, cell, 0});                // ModelPixelScale
  tags.add(33922, std::vector<double>{0, 0, 0, corner.x, north, 0});  // ModelTiepoint
  tags.add(34735, keys);                                              // GeoKeyDirectory
  std::string out = tags.file();
  for (std::size_t i = 0; i < study.receivers.list.size(); ++i)
    add_bytes(out, std::bit_cast<std::uint32_t>(static_cast<float>(value_of(study, i))), 4);
  return out;
}

}  // namespace tenebra::sun
