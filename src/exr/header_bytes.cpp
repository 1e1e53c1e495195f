#include "exr/header_bytes.h"

#include <cstdint>
#include <cstring>

#include "base/fail.h"

namespace tenebra::exr {
namespace {

constexpr std::string_view magic("\x76\x2f\x31\x01", 4);
constexpr std::uint32_t several_parts = 0x1000;  // of the version's flags
constexpr std::size_t longest_name = 255;

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
  std::uint32_t number = 0;
  for (int i = 3; i >= 0; --i)
    number = number << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
  return number;
}

/// Takes a text that ends in a zero off `bytes`; false: there is none.
bool take_name(std::string_view& bytes, std::string_view& name) {
  const std::size_t end = bytes.substr(0, longest_name + 1).find('\0');
  if (end == std::string_view::npos) return false;
  name = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  return true;
}

tl::unexpected<Error> cut_short() {
  return base::fail("found a damaged OpenEXR picture (its header ends too soon)");
}

/// Takes the attributes of one part off `bytes`; their number.
Expected<std::size_t> take_attributes(std::string_view& bytes) {
  for (std::size_t count = 0;; ++count) {
    std::string_view name, type;
    if (!take_name(bytes, name)) return cut_short();
    if (name.empty()) return count;
    if (!take_name(bytes, type) || bytes.size() < 4) return cut_short();
    const std::uint32_t size = number_at(bytes, 0);
    bytes.remove_prefix(4);
    if (size > bytes.size())
      return base::fail("found a damaged OpenEXR picture (an attribute of {} bytes, where {} follow)", size,
                        bytes.size());
    bytes.remove_prefix(size);
  }
}

}  // namespace

Expected<void> check_header_bytes(std::string_view bytes) {
  if (!bytes.starts_with(magic) || bytes.size() < 8)
    return base::fail("found no OpenEXR picture, expected one that starts with the bytes 76 2f 31 01");
  const bool parts = (number_at(bytes, 4) & several_parts) != 0;
  bytes.remove_prefix(8);
  for (;;) {  // a header without attributes ends the list of parts
    const auto count = take_attributes(bytes);
    if (!count) return tl::unexpected(count.error());
    if (!parts || *count == 0) return {};
  }
}

}  // namespace tenebra::exr
