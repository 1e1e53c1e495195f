#include <algorithm>
#include <cmath>

#include "base/lower_case.h"
#include "formats/import_failure.h"
#include "formats/obj/mtl.h"
#include "formats/text_lines.h"

namespace tenebra::formats {
namespace {

class MtlParser {
public:
  MtlParser(const std::string& file, std::vector<MtlMaterial>& materials, std::vector<std::string>& warnings)
      : file_(file), materials_(materials), warnings_(warnings) {}

  /// False: there are too many materials.
  bool parse(std::string_view text) {
    for (TextLines lines(text); lines.next(at_);) {
      const std::string word = base::lower_case(at_.word);
      if (word == "newmtl" && materials_.size() == most_materials) return false;
      written_ = at_.rest;
      read_statement(word);
    }
    return true;
  }

private:
  void read_statement(const std::string& word) {
    if (word == "newmtl") return begin();
    if (materials_.size() == before_) return warn(", expected newmtl first");
    MtlMaterial& material = materials_.back();
    if (word == "kd") return read_color(material.diffuse);
    if (word == "ks") return read_color(material.specular);
    if (word == "ke") return read_color(material.emission);
    if (word == "ns") return read_number(material.shininess);
    if (word == "tr") return read_number(material.transparency);
    if (word == "pr") return read_number(material.roughness);
    if (word == "pm") return read_number(material.metallic);
    if (word == "d") {
      if (at_.rest.starts_with("-halo")) take_word(at_.rest);
      return read_number(material.dissolve);
    }
    if (word == "illum") {
      std::optional<float> model;
      read_number(model);
      if (model && *model >= 0 && *model <= 10) material.illumination = static_cast<int>(*model);
      return;
    }
    if (is_map(word)) read_map(word);
  }

  static bool is_map(std::string_view word) {
    return word.starts_with("map_") || word == "bump" || word == "norm" || word == "disp" || word == "refl";
  }

  void begin() { materials_.push_back({std::string(without_comment(at_.rest)), std::string(at_.rest)}); }

  void warn(std::string_view what) {
    constexpr int most = 20;  // a file of another kind has thousands
    if (++said_ <= most)
      warnings_.push_back(fmt::format("{}, line {}: found '{} {}'{}.", file_, at_.line, shown(at_.word),
                                      shown(written_), what));
  }

  /// A number of the statement; `otherwise` where there is none, or none that a float can hold.
  float number(float otherwise) {
    double value = otherwise;
    switch (take_number(at_.rest, value)) {
      case NumberFault::none:
      case NumberFault::missing:
        break;
      case NumberFault::decimal_comma:
        // Once for a statement, with the rest of it.
        if (!comma_) warn(", whose decimal commas are read as points");
        comma_ = true;
        break;
      case NumberFault::not_a_number:
        warn(", which is not read");
        at_.rest = {};
        return otherwise;
    }
    const auto number = static_cast<float>(value);
    return std::isfinite(number) ? number : otherwise;
  }

  void read_number(std::optional<float>& member) {
    comma_ = false;
    if (const float value = number(NAN); !std::isnan(value)) member = value;
  }

  /// One number stands for all three.
  void read_color(glm::vec3& member) {
    comma_ = false;
    const float red = number(NAN);
    if (std::isnan(red)) return;
    const float green = number(red), blue = number(green);
    member = glm::max(glm::vec3(red, green, blue), 0.0f);
  }

  /// Options that begin with a dash, each with its words; the picture's name is the rest of the line.
  void read_map(const std::string& word) {
    MtlMap map;
    map.statement = word;
    map.written = std::string(at_.word);
    while (at_.rest.starts_with('-')) {
      const std::string_view before = at_.rest;
      if (!read_option(take_word(at_.rest), map)) {
        at_.rest = before;  // a name that begins with a dash
        break;
      }
      at_.rest = trim(at_.rest);
    }
    map.picture = std::string(without_comment(at_.rest));
    if (!map.picture.empty()) materials_.back().maps.push_back(std::move(map));
  }

  bool read_option(std::string_view option, MtlMap& map) {
    if (option == "-o") return read_vector(map.offset);
    if (option == "-s") return read_vector(map.scale);
    glm::vec2 unused(0);
    if (option == "-t" || option == "-mm") return read_vector(unused);
    if (option == "-bm") {
      map.bump = number(1);
      return true;
    }
    static constexpr std::string_view with_a_word[] = {
        "-blendu", "-blendv", "-cc", "-clamp", "-texres", "-boost", "-imfchan", "-type", "-colorspace"};
    if (std::find(std::begin(with_a_word), std::end(with_a_word), option) == std::end(with_a_word))
      return false;
    const std::string_view value = take_word(at_.rest);
    if (option == "-clamp") map.clamp = value == "on";
    return true;
  }

  /// One to three numbers; a picture's name may begin with a digit, so that a number ends before a blank.
  bool read_vector(glm::vec2& vector) {
    for (int i = 0; i < 3; ++i) {
      double value = 0;
      if (take_number(at_.rest, value) != NumberFault::none) break;
      const auto number = static_cast<float>(value);
      if (i < 2 && std::isfinite(number)) vector[i] = number;
    }
    return true;
  }

  const std::string& file_;
  std::vector<MtlMaterial>& materials_;
  std::vector<std::string>& warnings_;
  const std::size_t before_ = materials_.size();  ///< materials of other files
  Statement at_;
  std::string_view written_;  ///< what the statement says, all of it
  int said_ = 0;
  bool comma_ = false;  ///< the statement has been warned of
};

}  // namespace

bool parse_mtl(std::string_view text, const std::string& file, std::vector<MtlMaterial>& materials,
               std::vector<std::string>& warnings) {
  return MtlParser(file, materials, warnings).parse(text);
}

const MtlMap* MtlMaterial::map(std::initializer_list<std::string_view> statements) const {
  const MtlMap* found = nullptr;
  for (const MtlMap& map : maps)
    if (std::find(statements.begin(), statements.end(), map.statement) != statements.end()) found = &map;
  return found;
}

}  // namespace tenebra::formats
