#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "formats/import_failure.h"
#include "formats/ply/header.h"
#include "formats/text_lines.h"

namespace tenebra::formats::ply {
namespace {

template <class T>
double value_of(const char* bytes, bool turned) {
  std::array<char, sizeof(T)> copy;
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (turned) std::reverse(copy.begin(), copy.end());
  return static_cast<double>(std::bit_cast<T>(copy));
}

}  // namespace

void Values::check_count(const Element& element) const {
  constexpr std::size_t shortest_text = 2;  // a digit and a blank
  std::size_t least = 0;
  for (const Property& property : element.properties)
    least +=
        encoding_ == Encoding::ascii ? shortest_text : size_of(property.count_type.value_or(property.type));
  if (least == 0) return;
  if (const std::size_t most = (rest_.size() + 1) / least; element.count > most)
    refuse(
        "element '{}': found a count of {}, expected at most the {} that the file's bytes can hold: the file "
        "is cut off, copy it again",
        shown(element.name), element.count, most);
}

double Values::take(Type type) {
  return encoding_ == Encoding::ascii ? take_text() : take_binary(type);
}

void Values::refuse_text() const {
  const std::string_view before = file_.substr(0, file_.size() - rest_.size());
  std::string_view rest = rest_;
  if (!skip_blanks(rest) && rest.empty())
    refuse("values: found the end of the file, expected more: copy it again");
  const std::string_view word = rest.substr(0, std::min<std::size_t>(rest.find_first_of(" \t\r\n"), 40));
  refuse("line {}: found '{}', expected a number", 1 + std::count(before.begin(), before.end(), '\n'),
         shown(word));
}

double Values::take_text() {
  double value = 0;
  if (take_number(rest_, value) != NumberFault::none) refuse_text();
  return value;
}

double Values::take_binary(Type type) {
  const std::size_t size = size_of(type);
  if (rest_.size() < size) refuse("values: found the end of the file, expected more: copy it again");
  const char* const bytes = rest_.data();
  rest_.remove_prefix(size);
  const bool turned = (encoding_ == Encoding::big_endian) != (std::endian::native == std::endian::big);
  switch (type) {
    case Type::int8:
      return value_of<std::int8_t>(bytes, turned);
    case Type::uint8:
      return value_of<std::uint8_t>(bytes, turned);
    case Type::int16:
      return value_of<std::int16_t>(bytes, turned);
    case Type::uint16:
      return value_of<std::uint16_t>(bytes, turned);
    case Type::int32:
      return value_of<std::int32_t>(bytes, turned);
    case Type::uint32:
      return value_of<std::uint32_t>(bytes, turned);
    case Type::float32:
      return value_of<float>(bytes, turned);
    default:
      return value_of<double>(bytes, turned);
  }
}

std::size_t Values::take_count(const Property& list) {
  const double count = take(*list.count_type);
  const std::size_t least = encoding_ == Encoding::ascii ? 2 : size_of(list.type);
  if (!(count >= 0) || count != std::floor(count))
    refuse("list '{}': found a length of {}, expected a whole number", shown(list.name), count);
  if (const std::size_t most = (rest_.size() + 1) / least; count > static_cast<double>(most))
    refuse("list '{}': found a length of {}, expected at most {}: the file is cut off, copy it again",
           shown(list.name), count, most);
  return static_cast<std::size_t>(count);
}

void Values::skip(const Property& property) {
  for (std::size_t left = property.count_type ? take_count(property) : 1; left > 0; --left)
    take(property.type);
}

void Values::end_row() {
  if (encoding_ == Encoding::ascii) rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size()));
}

void Values::skip(const Element& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) skip(property);
    end_row();
  }
}

}  // namespace tenebra::formats::ply
