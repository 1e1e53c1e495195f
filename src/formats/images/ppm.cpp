// Netpbm's portable pixmap, the pictures of BART.
#include <algorithm>

#include "formats/images/decode.h"
#include "formats/import_failure.h"

namespace tenebra::formats {
namespace {

bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The numbers of a header, and of the pixels of a P3.
class PpmNumbers {
public:
  explicit PpmNumbers(std::string_view bytes) : bytes_(bytes) {}

  std::uint32_t next(const char* what) {
    skip_blanks();
    std::uint32_t value = 0;
    const std::size_t start = at_;
    for (; at_ < bytes_.size() && is_digit(bytes_[at_]) && value < 100'000'000; ++at_)
      value = value * 10 + static_cast<std::uint32_t>(bytes_[at_] - '0');
    if (at_ == start) refuse("found no number at byte {}, expected {}", at_, what);
    return value;
  }

  /// What follows the one blank after the header's last number.
  std::string_view pixels() const { return bytes_.substr(std::min(at_ + 1, bytes_.size())); }
  std::size_t bytes_left() const { return bytes_.size() - at_; }

private:
  void skip_blanks() {
    while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || bytes_[at_] == '#')) {
      if (bytes_[at_] == '#')
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      else
        ++at_;
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 2;  // after "P6"
};

struct PpmHeader {
  std::uint32_t width = 0, height = 0, largest = 0;
};

/// `value` of 0 to `largest`, rounded to 0 to 255.
std::uint8_t to_byte(std::uint32_t value, std::uint32_t largest) {
  return static_cast<std::uint8_t>((std::min(value, largest) * 255 + largest / 2) / largest);
}

/// Calls `next` for the three values of every pixel.
template <class Next>
void fill(TextureImage& image, std::uint32_t largest, Next next) {
  for (std::size_t pixel = 0; pixel < image.rgba.size(); pixel += 4)
    for (std::size_t c = 0; c < 3; ++c) image.rgba[pixel + c] = to_byte(next(), largest);
}

void read_binary(std::string_view bytes, const PpmHeader& header, TextureImage& image) {
  const std::size_t width = header.largest > 255 ? 2 : 1;
  const std::size_t needed = image.rgba.size() / 4 * 3 * width;
  if (bytes.size() < needed) refuse("found {} bytes of pixels, expected {}", bytes.size(), needed);
  std::size_t at = 0;
  const auto byte = [&] { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at++])); };
  fill(image, header.largest, [&] {
    const std::uint32_t high = byte();
    return width == 1 ? high : high << 8 | byte();
  });
}

}  // namespace

TextureImage decode_ppm(std::string_view bytes, std::uint64_t& pixels_left) {
  PpmNumbers numbers(bytes);
  PpmHeader header;
  header.width = numbers.next("the picture's width");
  header.height = numbers.next("the picture's height");
  header.largest = numbers.next("the largest value");
  if (header.largest == 0 || header.largest > 65535)
    refuse("found {} as the largest value, expected 1 to 65535", header.largest);
  const bool text = bytes[1] == '3';
  const std::uint64_t values = 3 * std::uint64_t{header.width} * header.height;
  const std::uint64_t least = text ? 2 * values : values;  // a digit and a blank each
  if (least > numbers.bytes_left() + 1)
    refuse("found {} bytes for {} x {} pixels, expected at least {}", numbers.bytes_left(), header.width,
           header.height, least);
  charge_pixels(header.width, header.height, pixels_left);
  TextureImage image;
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  image.rgba.assign(4 * std::size_t{header.width} * header.height, 255);
  if (text)
    fill(image, header.largest, [&] { return numbers.next("a value of a pixel"); });
  else
    read_binary(numbers.pixels(), header, image);
  return image;
}

}  // namespace tenebra::formats
