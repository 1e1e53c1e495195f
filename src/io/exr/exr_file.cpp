#include "io/exr/exr_file.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <half.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "base/fail.h"
#include "io/exr/header_bytes.h"
#include "io/input_file.h"

namespace tenebra::io::exr {
namespace {

constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30;
constexpr std::uint64_t most_pixels = std::uint64_t{1} << 26;
constexpr std::uint64_t most_buffer_bytes = std::uint64_t{1} << 30;
constexpr int in_this_thread = 0;

/// A file in memory.
class BytesOut : public Imf::OStream {
public:
  BytesOut() : OStream("the picture") {}
  void write(const char bytes[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (at_ + size > bytes_.size()) bytes_.resize(at_ + size);
    std::memcpy(&bytes_[at_], bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
  std::size_t at_ = 0;
};

class BytesIn : public Imf::IStream {
public:
  explicit BytesIn(std::string_view bytes) : IStream("the picture"), bytes_(bytes) {}
  /// Whether there are more.
  bool read(char to[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (count < 0 || at_ > bytes_.size() || size > bytes_.size() - at_)
      throw std::runtime_error("it ends too soon");
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override { at_ = at; }

private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

std::vector<half> as_halves(const Floats& floats, std::size_t count) {
  std::vector<half> halves(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float value = floats.values[i * floats.step];
    halves[i] = half(value > HALF_MAX ? HALF_MAX : value < -HALF_MAX ? -HALF_MAX : value);  // NaN stays
  }
  return halves;
}

bool is_half(const Channel& channel) {
  const auto* const floats = std::get_if<Floats>(&channel.values);
  return floats != nullptr && floats->precision == Precision::half;
}

Imf::PixelType type_of(const Channel& channel) {
  if (is_half(channel)) return Imf::HALF;
  return std::holds_alternative<Floats>(channel.values) ? Imf::FLOAT : Imf::UINT;
}

/// The library wants pointers that it could write to, and writes to none of them.
char* base_of(const void* values) {
  return static_cast<char*>(const_cast<void*>(values));
}

Imf::Slice slice_of(const Channel& channel, std::span<const half> halves, std::size_t width) {
  if (is_half(channel)) return {Imf::HALF, base_of(halves.data()), sizeof(half), sizeof(half) * width};
  if (const auto* const floats = std::get_if<Floats>(&channel.values)) {
    const std::size_t step = sizeof(float) * floats->step;
    return {Imf::FLOAT, base_of(floats->values.data()), step, step * width};
  }
  return {Imf::UINT, base_of(std::get<Numbers>(channel.values).data()), sizeof(std::uint32_t),
          sizeof(std::uint32_t) * width};
}

Imath::M44f matrix(const std::array<float, 16>& values) {
  Imath::M44f m;
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = values[static_cast<std::size_t>(i)];
  return m;
}

Imf::Header header_of(const Picture& picture) {
  Imf::Header header(picture.width, picture.height);
  header.compression() =
      picture.compression == Compression::zip ? Imf::ZIP_COMPRESSION : Imf::PIZ_COMPRESSION;
  Imf::addWorldToCamera(header, matrix(picture.camera.world_to_camera));
  Imf::addWorldToNDC(header, matrix(picture.camera.world_to_ndc));
  for (const Text& text : picture.texts) header.insert(text.name, Imf::StringAttribute(text.value));
  for (const Channel& channel : picture.channels)
    header.channels().insert(channel.name, Imf::Channel(type_of(channel)));
  return header;
}

std::string encoded(const Picture& picture) {
  const auto width = static_cast<std::size_t>(picture.width);
  std::vector<std::vector<half>> halves;
  Imf::FrameBuffer pixels;
  for (const Channel& channel : picture.channels) {
    halves.push_back(is_half(channel) ? as_halves(std::get<Floats>(channel.values),
                                                  width * static_cast<std::size_t>(picture.height))
                                      : std::vector<half>());
    pixels.insert(channel.name, slice_of(channel, halves.back(), width));
  }
  BytesOut bytes;
  {
    Imf::OutputFile file(bytes, header_of(picture), in_this_thread);
    file.setFrameBuffer(pixels);
    file.writePixels(picture.height);
  }  // here it writes where its rows are
  return bytes.take();
}

/// Rows that are compressed together.
std::uint64_t rows_at_once(Imf::Compression compression) {
  switch (compression) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      return 1;
  }
}

/// What a file of one byte can state at most, in bytes of pixels: deflate reaches 1032, what DWA stores of a
/// block of equal pixels once 64 times as much.
std::uint64_t most_ratio(Imf::Compression compression) {
  const bool lossy = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
  return lossy ? 1 << 17 : 1 << 11;
}

struct Window {
  int left = 0, top = 0;
  std::uint64_t width = 0, height = 0;
};

Expected<Window> checked_window(const Imf::Header& header, std::uint64_t file_bytes) {
  const Imath::Box2i& box = header.dataWindow();
  if (box.max.x < box.min.x || box.max.y < box.min.y) return base::fail("found an empty picture");
  const Window window{box.min.x, box.min.y,
                      static_cast<std::uint64_t>(std::int64_t{box.max.x} - box.min.x + 1),
                      static_cast<std::uint64_t>(std::int64_t{box.max.y} - box.min.y + 1)};
  if (window.width > most_pixels || window.height > most_pixels || window.width * window.height > most_pixels)
    return base::fail("found {} x {} pixels, expected at most 2^26", window.width, window.height);
  std::uint64_t pixel_bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
      return base::fail("channel {} has fewer samples than pixels, expected one for each", c.name());
    pixel_bytes += c.channel().type == Imf::HALF ? 2 : 4;
  }
  const std::uint64_t bytes = pixel_bytes * window.width * window.height;
  if (bytes / most_ratio(header.compression()) > file_bytes)
    return base::fail("found {} bytes, which cannot hold its {} x {} pixels", file_bytes, window.width,
                      window.height);
  std::uint64_t at_once = rows_at_once(header.compression()) * window.width;
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tiles = header.tileDescription();
    at_once = std::max(at_once, std::max<std::uint64_t>(tiles.xSize, window.width) * tiles.ySize);
  }
  if (at_once > most_buffer_bytes || at_once * pixel_bytes > most_buffer_bytes)
    return base::fail("its rows of {} bytes per pixel need more than 1 GiB at once", pixel_bytes);
  return window;
}

/// The names of the one or three channels that are wanted; none: the file lacks them.
std::vector<std::string> names_of(const Imf::ChannelList& channels, const std::string& layer) {
  const std::string before = layer.empty() ? "" : layer + ".";
  using Names = std::vector<std::string>;
  for (const Names& names : {Names{"R", "G", "B"}, Names{"X", "Y", "Z"}, Names{"Y"}}) {
    Names full;
    for (const std::string& name : names)
      if (channels.findChannel(before + name) != nullptr) full.push_back(before + name);
    if (full.size() == names.size()) return full;
  }
  if (!layer.empty() && channels.findChannel(layer) != nullptr) return {layer};
  return {};
}

std::string list_of(const Imf::ChannelList& channels) {
  constexpr int most_named = 40;
  std::string list;
  int named = 0;
  for (auto c = channels.begin(); c != channels.end(); ++c)
    if (++named <= most_named) list += fmt::format("{}{}", list.empty() ? "" : ", ", c.name());
  return named > most_named ? list + " and others" : list.empty() ? "none" : list;
}

Expected<io::ImageF> decoded(std::string_view bytes, const std::string& layer) {
  BytesIn stream(bytes);
  Imf::MultiPartInputFile file(stream, in_this_thread);
  const Imf::Header& header = file.header(0);
  if (header.hasType() && Imf::isDeepData(header.type()))
    return base::fail("found a deep picture, expected a flat one");
  const auto window = checked_window(header, bytes.size());
  if (!window) return tl::unexpected(window.error());
  const std::vector<std::string> names = names_of(header.channels(), layer);
  if (names.empty())
    return base::fail("found the channels {}, expected {}", list_of(header.channels()),
                      layer.empty() ? "R, G, B or Y" : fmt::format("{0} or {0}.R, {0}.G, {0}.B", layer));
  io::ImageF image{
      static_cast<int>(window->width), static_cast<int>(window->height), static_cast<int>(names.size()), {}};
  image.pixels.resize(window->width * window->height * names.size());
  const std::size_t step = sizeof(float) * names.size();
  Imf::FrameBuffer pixels;
  for (std::size_t c = 0; c < names.size(); ++c)
    pixels.insert(names[c], Imf::Slice::Make(Imf::FLOAT, &image.pixels[c], header.dataWindow(), step,
                                             step * window->width));
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(pixels);
  part.readPixels(header.dataWindow().min.y, header.dataWindow().max.y);
  return image;
}

/// In one line, without the stop at its end.
std::string phrase_of(const std::exception& error) {
  std::string text = error.what();
  std::ranges::replace(text, '\n', ' ');
  while (text.ends_with('.') || text.ends_with(' ')) text.pop_back();
  return text;
}

}  // namespace

Expected<std::string> encode(const Picture& picture) {
  try {
    return encoded(picture);
  } catch (const std::bad_alloc&) {
    throw;  // memory that is lacking is no fault of the file
  } catch (const std::exception& error) {
    return base::fail("{}", phrase_of(error));
  }
}

Expected<io::ImageF> read(const std::filesystem::path& path, std::string_view layer) {
  const auto bytes = io::read_file(path, most_file_bytes);
  if (!bytes) return tl::unexpected(bytes.error());
  if (auto checked = check_header_bytes(*bytes); !checked)
    return base::fail("{}: {}", path.string(), checked.error().message);
  try {
    auto image = decoded(*bytes, std::string(layer));
    if (!image) return base::fail("{}: {}", path.string(), image.error().message);
    return image;
  } catch (const std::bad_alloc&) {
    return base::fail("{}: not enough memory for its pixels", path.string());
  } catch (const std::exception& error) {
    return base::fail("{}: found a damaged OpenEXR picture ({})", path.string(), phrase_of(error));
  }
}

}  // namespace tenebra::io::exr
