#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <unordered_map>

#include "formats/import_failure.h"
#include "formats/obj/obj_file.h"
#include "formats/text_lines.h"

namespace tenebra::formats {
namespace {

/// Of many shapes each costs a node and a mesh, about a kilobyte: beyond this number they share the last.
constexpr std::size_t most_shapes = 100'000;

/// Each is looked for in the scene's folder.
constexpr std::size_t most_libraries = 64;

/// Remarks that many lines may give: each said once, with the first line and the number of others.
class Remarks {
public:
  void add(const std::string& remark, std::size_t line) {
    ++lines_.try_emplace(remark, Lines{line, 0}).first->second.count;
  }
  /// A word that the format does not have: a file of another kind has thousands.
  void add_unknown(std::string_view word, std::size_t line) {
    constexpr std::size_t most_words = 20;
    const std::string remark = fmt::format("found '{}', which is not read", shown(word));
    if (lines_.contains(remark) || unknown_words_++ < most_words) return add(remark, line);
    add("found other words that are not read", line);
  }
  std::vector<std::string> sentences() const {
    std::vector<std::pair<std::size_t, std::string>> found;
    for (const auto& [remark, lines] : lines_) {
      const std::string more = lines.count > 1 ? fmt::format(" and {} more", lines.count - 1) : "";
      found.emplace_back(lines.first, fmt::format("Line {}{}: {}.", lines.first, more, remark));
    }
    std::sort(found.begin(), found.end());
    std::vector<std::string> sentences;
    for (auto& [line, sentence] : found) sentences.push_back(std::move(sentence));
    return sentences;
  }

private:
  struct Lines {
    std::size_t first, count;
  };
  std::map<std::string, Lines> lines_;
  std::size_t unknown_words_ = 0;
};

/// The largest index of a kind that a face names, from 0, and the line of it.
struct LargestIndex {
  std::int64_t index = -1;
  std::size_t line = 0;

  void add(std::int64_t other, std::size_t other_line) {
    if (other > index) *this = {other, other_line};
  }
};

class ObjParser {
public:
  ObjFile parse(std::string_view text) {
    for (TextLines lines(text); lines.next(at_);) read_statement();
    finish();
    return std::move(file_);
  }

private:
  void read_statement() {
    const std::string_view word = at_.word;
    if (word == "v") return read_position();
    if (word == "f" || word == "fo") return read_face();
    if (word == "vn") return read_normal();
    if (word == "vt") return read_coordinates();
    if (word == "usemtl") return use_material();
    if (word == "o" || word == "g") return begin_shape();
    if (word == "mtllib") return add_library();
    if (word == "p" || word == "l") return void(++skipped_);
    if (word != "s") remarks_.add_unknown(word, at_.line);
  }

  [[noreturn]] void refuse_word(std::string_view rest, std::string_view expected) {
    refuse("line {}: found '{}', expected {}", at_.line, shown(take_word(rest)), expected);
  }

  /// A number that the surface depends on; false: none is left on the line.
  bool take(double& value) {
    const std::string_view before = at_.rest;
    switch (take_number(at_.rest, value)) {
      case NumberFault::none:
        return true;
      case NumberFault::missing:
        return false;
      case NumberFault::decimal_comma:
        refuse_word(before, "a decimal point: export it again, with a language whose numbers have one");
      default:
        refuse_word(before, "a number");
    }
  }

  void read_position() {
    double values[7];
    int count = 0;
    for (; count < 3; ++count)
      if (!take(values[count])) refuse("line {}: found {} numbers, expected x, y and z", at_.line, count);
    // What follows is a weight or a colour, and more of these or something else: no part of the place.
    while (count < 7 && take_number(at_.rest, values[count]) == NumberFault::none) ++count;
    if (count >= 6) add_color(glm::vec3(values[3], values[4], values[5]));
    file_.positions.emplace_back(values[0], values[1], values[2]);
  }

  /// Of the next position. What is not finite is no colour.
  void add_color(const glm::vec3& color) {
    if (!std::isfinite(color.x) || !std::isfinite(color.y) || !std::isfinite(color.z)) return;
    file_.colors.resize(file_.positions.size(), ObjFile::not_colored);
    file_.colors.push_back(glm::max(color, 0.0f));
  }

  /// A number that the surface does not depend on: 0 where it is none.
  float take_or_zero() {
    double value = 0;
    const NumberFault fault = take_number(at_.rest, value);
    if (fault == NumberFault::none) return static_cast<float>(value);
    remarks_.add(fmt::format("found no number in '{}', 0 is used", at_.word), at_.line);
    return 0;
  }

  void read_normal() {
    const float x = take_or_zero(), y = take_or_zero(), z = take_or_zero();
    file_.normals.emplace_back(x, y, z);
  }

  void read_coordinates() {
    const float u = take_or_zero();
    double v = 0;  // may be left out
    if (take_number(at_.rest, v) != NumberFault::none) v = 0;
    file_.coordinates.emplace_back(u, static_cast<float>(v));
  }

  /// The index at the front of `corner`, from 1 or from the end, as one from 0; -1: none, or 0.
  std::int64_t take_index(std::string_view& corner, std::size_t size, bool& fault) {
    const char* const end = corner.data() + corner.size();
    std::int32_t index = 0;
    const auto [stop, error] = std::from_chars(corner.data(), end, index);
    fault |=
        error == std::errc::result_out_of_range || !(stop == end || *stop == '/' || ends_word({stop, 1}));
    corner = {stop, static_cast<std::size_t>(end - stop)};
    const auto last = static_cast<std::int64_t>(size);
    if (index < 0 && -static_cast<std::int64_t>(index) > last) fault = true;
    return index < 0 ? last + index : static_cast<std::int64_t>(index) - 1;
  }

  Corner take_corner() {
    std::string_view rest = at_.rest;
    bool fault = false, ignored = false;
    const auto next = [&](std::size_t size, bool& wrong) -> std::int64_t {
      if (!rest.starts_with('/')) return -1;
      rest.remove_prefix(1);
      return std::max<std::int64_t>(take_index(rest, size, wrong), -1);
    };
    const std::int64_t position = take_index(rest, file_.positions.size(), fault);
    const std::int64_t coordinates = next(file_.coordinates.size(), ignored);
    const std::int64_t normal = next(file_.normals.size(), ignored);
    if (fault || position < 0 || !ends_word(rest))
      refuse("line {}: found '{}' in a face, expected vertices such as 3, 3/1 or 3/1/2, of those before it",
             at_.line, shown(take_word(at_.rest)));
    at_.rest = rest;
    if (ignored) remarks_.add("found coordinates or normals of a face that are no numbers of any", at_.line);
    largest_position_.add(position, at_.line);
    largest_coordinates_.add(coordinates, at_.line);
    largest_normal_.add(normal, at_.line);
    return {static_cast<std::uint32_t>(position), static_cast<std::int32_t>(coordinates),
            static_cast<std::int32_t>(normal)};
  }

  void read_face() {
    const std::size_t first = file_.corners.size();
    while (skip_blanks(at_.rest)) file_.corners.push_back(take_corner());
    const std::size_t count = file_.corners.size() - first;
    if (count < 3) {
      file_.corners.resize(first);
      return remarks_.add("found a face of fewer than three corners, which is left out", at_.line);
    }
    if (file_.shapes.empty()) file_.shapes.emplace_back();
    file_.faces.push_back(static_cast<std::uint32_t>(count));
  }

  void begin_shape() {
    const std::string name(without_comment(at_.rest));
    if (!file_.shapes.empty() && file_.shapes.back().first_face == file_.faces.size())
      file_.shapes.back().name = name;  // the one before has no faces
    else if (file_.shapes.size() < most_shapes)
      file_.shapes.push_back({name, file_.faces.size()});
    else
      remarks_.add(fmt::format("found more than {} groups and objects: the rest is one", most_shapes),
                   at_.line);
  }

  void use_material() {
    const std::string name(at_.rest);
    ObjFile::Use use{-1, file_.faces.size(), at_.line};
    if (!name.empty()) {
      const auto [known, is_new] =
          name_index_.try_emplace(name, static_cast<std::int32_t>(file_.material_names.size()));
      if (is_new) file_.material_names.push_back(name);
      use.name = known->second;
    }
    if (!file_.uses.empty() && file_.uses.back().first_face == use.first_face) file_.uses.pop_back();
    file_.uses.push_back(use);
  }

  void add_library() {
    const std::string name(at_.rest);
    auto& known = file_.libraries;
    if (std::find(known.begin(), known.end(), name) != known.end()) return;
    if (known.size() < most_libraries)
      known.push_back(name);
    else
      remarks_.add(fmt::format("found more than {} MTL files, of which no more are read", most_libraries),
                   at_.line);
  }

  void finish() {
    const auto size = static_cast<std::int64_t>(file_.positions.size());
    if (largest_position_.index >= size)
      refuse("line {}: found vertex {} in a face, expected 1 to {}: the file may be cut off",
             largest_position_.line, largest_position_.index + 1, size);
    if (!file_.colors.empty()) file_.colors.resize(file_.positions.size(), ObjFile::not_colored);
    file_.warnings = remarks_.sentences();
    warn_beyond("texture coordinates", largest_coordinates_, file_.coordinates.size());
    warn_beyond("normal", largest_normal_, file_.normals.size());
    if (skipped_ > 0)
      file_.warnings.push_back(
          fmt::format("Skipped {} {} of points and lines.", skipped_, skipped_ == 1 ? "line" : "lines"));
  }

  void warn_beyond(const char* what, const LargestIndex& largest, std::size_t size) {
    if (largest.index < static_cast<std::int64_t>(size)) return;
    file_.warnings.push_back(
        fmt::format("Line {}: found {} {} in a face, expected 1 to {}: where there are none, the "
                    "face is read without.",
                    largest.line, what, largest.index + 1, size));
  }

  ObjFile file_;
  Statement at_;
  Remarks remarks_;
  LargestIndex largest_position_, largest_coordinates_, largest_normal_;
  std::unordered_map<std::string, std::int32_t> name_index_;  ///< into ObjFile::material_names
  std::size_t skipped_ = 0;
};

}  // namespace

ObjFile parse_obj(std::string_view text) {
  return ObjParser().parse(text);
}

}  // namespace tenebra::formats
