// The header of a PLY file, and the values behind it one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tenebra::formats::ply {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Encoding { ascii, little_endian, big_endian };

/// Bytes of a binary value.
std::size_t size_of(Type type);

struct Property {
  std::string name;
  Type type = Type::float32;       ///< of a list: of its entries
  std::optional<Type> count_type;  ///< of lists
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;      ///< in the order of their values
  std::vector<std::string> pictures;  ///< what `comment TextureFile` names, in order
  std::size_t size = 0;               ///< bytes up to the first value
};

/// Throws ImportFailure, naming the line, for what is no header of a PLY file.
Header read_header(std::string_view file);

/// Reads values in the order of the file.
class Values {
public:
  /// `file` must outlive this.
  Values(const Header& header, std::string_view file)
      : encoding_(header.encoding), file_(file), rest_(file.substr(header.size)) {}

  /// Throws ImportFailure where the bytes that are left cannot hold all of `element`.
  void check_count(const Element& element) const;
  /// The next value; throws ImportFailure where there is none.
  double take(Type type);
  /// The count of a list, whose binary values are there.
  std::size_t take_count(const Property& list);
  /// Goes to the next of an element's values. In a text to the next line: MeshLab writes more than it states.
  void end_row();
  void skip(const Element& element);  ///< all of its values
  void skip(const Property& property);

private:
  [[noreturn]] void refuse_text() const;
  double take_text();
  double take_binary(Type type);

  Encoding encoding_;
  std::string_view file_, rest_;
};

}  // namespace tenebra::formats::ply
