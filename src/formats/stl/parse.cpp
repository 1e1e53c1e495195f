#include <algorithm>
#include <array>
#include <bit>

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

std::string lower_word(std::string_view word) {
  std::string text(word.substr(0, 16));
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Vertices of one solid by their place, to the bit: a table of numbers of positions, at most half full.
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

  std::uint32_t& slot_of(const glm::dvec3& place, const std::vector<glm::dvec3>& positions) {
    const Bits bits = bits_of(place);
    std::uint64_t hash = 0;
    for (const std::uint64_t part : bits) hash = (std::rotl(hash, 23) ^ part) * 0x9E3779B97F4A7C15u;
    std::size_t at = hash >> 20;  // the upper bits are the mixed ones
    while (true) {
      at &= slots_.size() - 1;
      if (slots_[at] == none || bits_of(positions[slots_[at]]) == bits) return slots_[at];
      ++at;
    }
  }

  void grow(const std::vector<glm::dvec3>& positions) {
    constexpr std::size_t least = 64;
    std::vector<std::uint32_t> old(std::max(least, 2 * slots_.size()), none);
    std::swap(old, slots_);
    for (const std::uint32_t number : old)
      if (number != none) slot_of(positions[number], positions) = number;
  }

  std::vector<std::uint32_t> slots_;  ///< a power of two
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
    begin_solid({});
    file_.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      add_binary(bytes.substr(header_size + i * triangle_size, triangle_size));
    return std::move(file_);
  }

  StlFile parse_text(std::string_view text) {
    for (TextLines lines(text); lines.next(at_);) read_statement(lower_word(at_.word));
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
    std::vector<glm::vec3> near;
    for (const glm::dvec3& corner : corners_) near.emplace_back(corner - corners_[0]);
    for (const glm::uvec3& t : triangulate(near, work_)) add_triangle(t);
    constexpr std::uint64_t most_work = 300'000'000;  // corner tests in about half a second
    if (work_ > most_work)
      refuse("line {}: found a facet of {} vertices, expected 3", at_.line, corners_.size());
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
  const bool begins = lower_word(trim(bytes.substr(0, 256)).substr(0, 5)) == "solid";
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
