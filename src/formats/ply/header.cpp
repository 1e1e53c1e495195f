#include "formats/ply/header.h"

#include <algorithm>

#include "base/number_in.h"
#include "formats/import_failure.h"
#include "formats/text_lines.h"

namespace tenebra::formats::ply {
namespace {

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr TypeName type_names[] = {
    {"char", Type::int8},       {"int8", Type::int8},       {"uchar", Type::uint8},
    {"uint8", Type::uint8},     {"short", Type::int16},     {"int16", Type::int16},
    {"ushort", Type::uint16},   {"uint16", Type::uint16},   {"int", Type::int32},
    {"int32", Type::int32},     {"uint", Type::uint32},     {"uint32", Type::uint32},
    {"float", Type::float32},   {"float32", Type::float32}, {"double", Type::float64},
    {"float64", Type::float64},
};

class HeaderReader {
public:
  explicit HeaderReader(std::string_view file) : file_(file) {}

  Header read() {
    if (trim(take_line()) != "ply") refuse("line 1: found no 'ply', expected a PLY file");
    for (bool end = false; !end;) {
      constexpr std::size_t most_lines = 100'000;
      if (header_.size >= file_.size() || line_ > most_lines)
        refuse("line {}: found no end_header, expected one: the file may be cut off, copy it again", line_);
      rest_ = take_line();
      end = read_line(take_word(rest_));
    }
    if (!encoded_) refuse("header: found no format, expected ascii or a binary one");
    return std::move(header_);
  }

private:
  /// Lines end as the first does: what stands behind end_header may be a value.
  std::string_view take_line() {
    std::string_view rest = file_.substr(header_.size);
    if (line_ == 0) {
      const std::string_view first = rest.substr(0, rest.find_first_of("\r\n"));
      const std::string_view behind = rest.substr(first.size(), 2);
      end_ = behind == "\r\n" ? behind : behind.substr(0, 1);
      if (end_.empty()) end_ = "\n";
    }
    ++line_;
    const std::size_t size = rest.find(end_);
    header_.size = size == std::string_view::npos ? file_.size() : header_.size + size + end_.size();
    return rest.substr(0, size);
  }

  /// True at the end of the header.
  bool read_line(std::string_view word) {
    if (word == "end_header") return true;
    if (word == "format")
      read_format();
    else if (word == "element")
      read_element();
    else if (word == "property")
      read_property();
    else if (word == "comment" && take_word(rest_) == "TextureFile")
      header_.pictures.emplace_back(trim(rest_));
    return false;  // comment, obj_info, and what others add
  }

  void read_format() {
    const std::string_view word = take_word(rest_);
    if (word == "ascii")
      header_.encoding = Encoding::ascii;
    else if (word == "binary_little_endian")
      header_.encoding = Encoding::little_endian;
    else if (word == "binary_big_endian")
      header_.encoding = Encoding::big_endian;
    else
      refuse("line {}: found format '{}', expected ascii, binary_little_endian or binary_big_endian", line_,
             shown(word));
    encoded_ = true;
  }

  void read_element() {
    Element element;
    element.name = take_word(rest_);
    const std::string_view count = take_word(rest_);
    const auto number = base::number_in<decltype(element.count)>(count);
    if (!number)
      refuse("line {}: found '{}' as a count of '{}', expected a whole number of 64 bits", line_,
             shown(count), shown(element.name));
    element.count = *number;
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) refuse("line {}: found a property, expected an element first", line_);
    Property property;
    std::string_view word = take_word(rest_);
    if (word == "list") {
      property.count_type = type_of(take_word(rest_));
      word = take_word(rest_);
    }
    property.type = type_of(word);
    property.name = take_word(rest_);
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type_of(std::string_view word) const {
    for (const TypeName& known : type_names)
      if (word == known.name) return known.type;
    refuse("line {}: found type '{}', expected one such as uchar, int, float or double", line_, shown(word));
  }

  std::string_view file_, rest_, end_;
  std::size_t line_ = 0;
  bool encoded_ = false;
  Header header_;
};

}  // namespace

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::float64:
      return 8;
    default:
      return 4;
  }
}

Header read_header(std::string_view file) {
  return HeaderReader(file).read();
}

}  // namespace tenebra::formats::ply
