#include <algorithm>
#include <array>
#include <bit>
#include <random>

#include "base/lower_case.h"
#include "formats/import_failure.h"
#include "formats/polygon.h"
#include "formats/stl/stl_file.h"
#include "formats/text_lines.h"

namespace tenebra::formats {
namespace {

constexpr std::size_t header_size = 84, triangle_size = 50;  // of the binary form; the count ends the header

/// Of many solids each costs a node and a mesh, about a kilobyte: beyond this number they share the last.
constexpr std::size_t most_solids = 100'000;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Vertices of one solid by their place, to the bit: a table of numbers of positions, at most half full. The
/// numbers follow the file's order, wherever in the table they stand.
class PlaceIndex {
public:
  void clear() { slots_.clear(), used_ = 0; }
  std::uint32_t find(const glm::dvec3& given, std::vector<glm::dvec3>& positions) {
    if (2 * used_ >= slots_.size()) grow(positions);
    const glm::dvec3 place = given + 0.0;  // -0 is 0
    std::uint32_t& slot = slot_of(place, positions);
    if (slot != none) return slot;
    slot = static_cast<std::uint32_t>(positions.size());
    positions.push_back(place);
    ++used_;
    return slot;
  }

private:
  static constexpr std::uint32_t none = ~0u;
  using Bits = std::array<std::uint64_t, 3>;
  static Bits bits_of(const glm::dvec3& place) {
    return std::bit_cast<Bits>(std::array{place.x, place.y, place.z});
  }

  /// An odd number, another one each time the program runs: no file can be made whose places collide.
  static std::uint64_t factor() {
    static const std::uint64_t drawn = [] {
      std::random_device device;
      return std::uint64_t{device()} << 32 | device() | 1;
    }();
    return drawn;
  }

  std::uint32_t& slot_of(const glm::dvec3& place, const std::vector<glm::dvec3>& positions) {
    const Bits bits = bits_of(place);
    std::uint64_t hash = 0;
    for (const std::uint64_t part : bits) hash = (std::rotl(hash, 23) ^ part) * factor();
    // A product carries bits upward only: its top bits alone depend on all bits of the factors.
    std::size_t at = hash >> (64 - std::countr_zero(slots_.size()));
    while (slots_[at] != none && bits_of(positions[slots_[at]]) != bits) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }

  void grow(const std::vector<glm::dvec3>& positions) {
    constexpr std::size_t least = 64;
    std::vector<std::uint32_t> old(std::max(least, 2 * slots_.size()), none);
    std::swap(old, slots_);
    for (const std::uint32_t number : old)
      if (number != none) slot_of(positions[number], positions) = number;
  }

  std::vector<std::uint32_t> slots_;  ///< a power of two, 64 or more
  std::size_t used_ = 0;
};

class StlParser {
public:
  StlFile parse_binary(std::string_view bytes) {
    const std::size_t held = (bytes.size() - header_size) / triangle_size;
    std::size_t count = word_at(bytes, header_size - 4);
    if (count == 0) count = held;  // some programs do not come back to write it
    if (count > held)
      refuse(
          "found {} triangles stated and the bytes of {}, expected all: the file is cut off, copy it again",
          count, held);
    if (const std::size_t rest = bytes.size() - header_size - count * triangle_size; rest > 0)
      file_.warnings.push_back(fmt::format(
          "Found {} bytes behind the {} triangles that the header states; not read.", rest, count));
    file_.floats = true;
    begin_solid({});
    file_.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      add_binary(bytes.substr(header_size + i * triangle_size, triangle_size));
    return std::move(file_);
  }

  StlFile parse_text(std::string_view text) {
    for (TextLines lines(text); lines.next(at_);) read_statement(base::lower_case(at_.word));
    if (open_)
      refuse(
          "line {}: found the end of the file within a facet, expected endfacet: the file is cut off, copy "
          "it again",
          at_.line);
    if (!ended_)
      file_.warnings.push_back("Found no endsolid at the end: the file may be cut off, copy it again.");
    return std::move(file_);
  }

private:
  void begin_solid(std::string name) {
    if (!file_.solids.empty() && file_.solids.back().first_triangle == file_.triangles.size())
      file_.solids.back().name = std::move(name);  // the one before is empty
    else if (file_.solids.size() < most_solids)
      file_.solids.push_back({std::move(name), file_.positions.size(), file_.triangles.size()});
    else
      return;
    places_.clear();
  }

  std::uint32_t vertex(const glm::dvec3& place) {
    if (file_.positions.size() >= ~0u) refuse("found more than 2^32 vertices, expected fewer");
    return places_.find(place, file_.positions);
  }

  void add_binary(std::string_view bytes) {
    glm::uvec3 corners;
    for (std::size_t k = 0; k < 3; ++k) {
      glm::vec3 place;
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[static_cast<int>(axis)] = std::bit_cast<float>(word_at(bytes, 12 * (k + 1) + 4 * axis));
      corners[static_cast<int>(k)] = vertex(place);
    }
    file_.triangles.push_back(corners);
    file_.colored += bytes[48] != 0 || bytes[49] != 0;
  }

  void read_statement(const std::string& word) {
    if (word == "vertex") return read_vertex();
    if (word == "facet" || word == "outer") {
      if (word == "outer") corners_.clear();
      open_ = true;
    } else if (word == "endloop" || word == "endfacet") {
      end_facet();
      open_ = word == "endloop";
    } else if (word == "solid") {
      ended_ = false;
      begin_solid(std::string(trim(at_.rest)));
    } else if (word == "endsolid") {
      ended_ = true;
      begin_solid({});
    } else if (word != "color") {
      refuse("line {}: found '{}', expected facet, outer loop, vertex, endloop, endfacet or endsolid",
             at_.line, shown(at_.word));
    }
  }

  void read_vertex() {
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view before = at_.rest;
      if (take_number(at_.rest, place[axis]) != NumberFault::none)
        refuse("line {}: found '{}', expected the numbers x, y and z, with a decimal point", at_.line,
               shown(before));
    }
    corners_.push_back(place);
  }

  /// A facet has three corners, or as some programs write it more.
  void end_facet() {
    if (corners_.empty()) return;
    if (corners_.size() < 3)
      refuse("line {}: found a facet of {} vertices, expected 3", at_.line, corners_.size());
    if (file_.solids.empty()) begin_solid({});
    if (corners_.size() == 3)
      add_triangle({0, 1, 2});
    else
      cut_facet();
    corners_.clear();
  }

  void cut_facet() {
    const auto check = [&](bool fits) {
      if (!fits) refuse("line {}: found a facet of {} vertices, expected 3", at_.line, corners_.size());
    };
    check(corners_.size() <= most_polygon_corners);
    std::vector<glm::vec3> near;
    near.reserve(corners_.size());
    for (const glm::dvec3& corner : corners_) near.emplace_back(corner - corners_[0]);
    const std::vector<glm::uvec3> triangles = triangulate(near, work_);
    check(work_ <= most_polygon_work);
    for (const glm::uvec3& t : triangles) add_triangle(t);
  }

  void add_triangle(const glm::uvec3& corners) {
    const std::uint32_t a = vertex(corners_[corners.x]), b = vertex(corners_[corners.y]),
                        c = vertex(corners_[corners.z]);
    file_.triangles.emplace_back(a, b, c);
  }

  StlFile file_;
  PlaceIndex places_;
  Statement at_;
  std::vector<glm::dvec3> corners_;  ///< of the facet
  bool open_ = false;                ///< within a facet
  bool ended_ = true;                ///< by endsolid
  std::uint64_t work_ = 0;
};

/// Whether `bytes` are text: binary files may begin with "solid" too, and say their size.
bool is_text(std::string_view bytes) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string_view front = bytes.substr(0, 256);
  if (front.starts_with(byte_order_mark)) front.remove_prefix(byte_order_mark.size());
  const bool begins = base::lower_case(trim(front).substr(0, 5)) == "solid";
  if (bytes.size() < header_size) return begins;
  if (bytes.size() == header_size + std::size_t{word_at(bytes, header_size - 4)} * triangle_size)
    return false;
  return begins && bytes.substr(0, 1024).find('\0') == std::string_view::npos;
}

}  // namespace

StlFile parse_stl(std::string_view bytes) {
  if (is_text(bytes)) return StlParser().parse_text(bytes);
  if (bytes.size() < header_size)
    refuse("found {} bytes and no 'solid', expected an STL file: it may be cut off, copy it again",
           bytes.size());
  return StlParser().parse_binary(bytes);
}

}  // namespace tenebra::formats
