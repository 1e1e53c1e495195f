#include "log/page_pictures.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>

#include "base/fail.h"
#include "io/image.h"
#include "log/page_text.h"

namespace tenebra::viewer {
namespace {

namespace fs = std::filesystem;

/// Means of k x k pixels, of values as they are stored; what is left over at the right and below is dropped.
/// Grey with alpha becomes grey: PNGs are not written with both.
io::Image8 made_small(const io::Image8& picture, int k) {
  io::Image8 small;
  small.width = std::max(picture.width / k, 1);
  small.height = std::max(picture.height / k, 1);
  small.channels = picture.channels == 2 ? 1 : picture.channels;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      for (int channel = 0; channel < small.channels; ++channel) {
        std::uint32_t sum = 0, count = 0;
        for (int v = y * k; v < std::min((y + 1) * k, picture.height); ++v)
          for (int u = x * k; u < std::min((x + 1) * k, picture.width); ++u, ++count) {
            const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(picture.width) +
                                      static_cast<std::size_t>(u);
            sum += picture.pixels[pixel * static_cast<std::size_t>(picture.channels) +
                                  static_cast<std::size_t>(channel)];
          }
        small.pixels.push_back(static_cast<std::uint8_t>((sum + count / 2) / count));
      }
    }
  }
  return small;
}

Expected<io::Image8> read_small(const fs::path& path) {
  const auto picture = io::read_png(path);
  if (!picture) return tl::unexpected(picture.error());
  const int k = (picture->width + widest_page_picture - 1) / widest_page_picture;
  return made_small(*picture, std::max(k, 1));
}

Expected<PagePicture> page_picture(int frame, const OutputPattern& a, const OutputPattern* b) {
  PagePicture picture;
  picture.frame = frame;
  const auto small = read_small(a.file(frame));
  if (!small) return tl::unexpected(small.error());
  picture.width = small->width;
  picture.height = small->height;
  auto uri = data_uri(*small);
  if (!uri) return tl::unexpected(uri.error());
  picture.a = std::move(*uri);
  if (b == nullptr) return picture;
  const auto other = read_small(b->file(frame));
  if (!other) return tl::unexpected(other.error());
  uri = data_uri(*other);
  if (!uri) return tl::unexpected(uri.error());
  picture.b = std::move(*uri);
  return picture;
}

}  // namespace

Expected<std::string> data_uri(const io::Image8& picture) {
  const auto png = io::encode_png(picture);
  if (!png) return tl::unexpected(png.error());
  return "data:image/png;base64," + base64(*png);
}

Expected<OutputPattern> picture_pattern(const std::string& text) {
  std::error_code error;
  if (!fs::is_directory(text, error)) return OutputPattern::parse(text);
  std::string folder;
  for (const char c : text) folder += c == '%' ? "%%" : std::string(1, c);
  return OutputPattern::parse((fs::path(folder) / "%04d.png").string());
}

Expected<std::vector<PagePicture>> page_pictures(const std::vector<int>& frames, const OutputPattern& a,
                                                 const OutputPattern* b) {
  const auto is_there = [](const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
  };
  std::vector<int> found;
  for (const int frame : frames)
    if (is_there(a.file(frame)) && (b == nullptr || is_there(b->file(frame)))) found.push_back(frame);
  if (found.empty() && !frames.empty()) {
    const bool lacks_b = b != nullptr && is_there(a.file(frames.front()));
    return base::fail("{}: found no picture of a frame of the log, expected files like {}",
                      lacks_b ? "--pictures-b" : "--pictures",
                      (lacks_b ? *b : a).file(frames.front()).string());
  }
  std::vector<PagePicture> pictures;
  const std::size_t count = std::min(found.size(), most_page_pictures);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count == 1 ? 0 : i * (found.size() - 1) / (count - 1);
    auto picture = page_picture(found[at], a, b);
    if (!picture) return tl::unexpected(picture.error());
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

}  // namespace tenebra::viewer
