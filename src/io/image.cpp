#include "io/image.h"

#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "base/fail.h"
#include "io/output_file.h"
#include "io/png_structure.h"
#include "io/png_writer.h"

namespace tenebra::io {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;
constexpr int most_jpeg_side = 65'535;
constexpr std::uint64_t most_file_bytes = std::uint64_t{1} << 30;

template <class T>
bool has_consistent_size(const Image<T>& image) {
  return image.width > 0 && image.height > 0 && image.channels > 0 &&
         static_cast<std::uint64_t>(image.width) * image.height <= most_pixels &&
         image.pixels.size() == static_cast<std::size_t>(image.width) * image.height * image.channels;
}

template <class T>
tl::unexpected<Error> refuse_size(const std::filesystem::path& path, const Image<T>& image) {
  return base::fail("cannot write {}: found a picture of {} x {} with {} channels and {} values",
                    path.string(), image.width, image.height, image.channels, image.pixels.size());
}

Expected<std::string> read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  if (error) return base::fail("cannot read {}: {}", path.string(), error.message());
  if (!regular) return base::fail("cannot read {}: it is not a file", path.string());
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) return base::fail("cannot read {}: {}", path.string(), error.message());
  if (size > most_file_bytes)
    return base::fail("cannot read {}: its {} bytes are over the limit of 1 GiB", path.string(), size);
  const auto reason = [] { return std::generic_category().message(errno); };
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return base::fail("cannot read {}: {}", path.string(), reason());
  std::string bytes(size, '\0');
  errno = 0;
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    return base::fail("cannot read {}: found {} of {} bytes{}{}", path.string(), stream.gcount(), size,
                      errno != 0 ? ", then " : "", errno != 0 ? reason() : "");
  }
  return bytes;
}

bool is_jpeg(std::string_view bytes) {
  return bytes.starts_with("\xff\xd8\xff");
}

const stbi_uc* as_stb(std::string_view bytes) {
  return reinterpret_cast<const stbi_uc*>(bytes.data());
}

/// What stb_image_write has made so far. Exceptions must not pass through it.
struct JpegBytes {
  std::string bytes;
  bool no_memory = false;
};

void add_bytes(void* to, void* data, int size) {
  auto& out = *static_cast<JpegBytes*>(to);
  try {
    if (!out.no_memory) out.bytes.append(static_cast<const char*>(data), static_cast<std::size_t>(size));
  } catch (const std::bad_alloc&) {
    out.no_memory = true;
  }
}

/// Why stb_image gave up. Where it was for lack of memory, throws: the picture may be whole. No reason is
/// stated where its own thread-local state had no memory.
std::string_view reason_of_stb() {
  const char* const stated = stbi_failure_reason();
  if (stated == nullptr || std::string_view(stated) == "outofmem") throw std::bad_alloc();
  return stated;
}

}  // namespace

Expected<std::string> encode_png(const Image8& image) {
  const bool has_png_channels = image.channels == 1 || image.channels == 3 || image.channels == 4;
  if (!has_png_channels || !has_consistent_size(image)) {
    return base::fail("found a picture of {} x {} with {} channels and {} values", image.width, image.height,
                      image.channels, image.pixels.size());
  }
  return png_of_pixels(image);
}

Expected<void> write_png(const std::filesystem::path& path, const Image8& image) {
  const auto bytes = encode_png(image);
  if (!bytes) return base::fail("cannot write {}: {}", path.string(), bytes.error().message);
  return write_file(path, *bytes);
}

Expected<void> write_jpeg(const std::filesystem::path& path, const Image8& image) {
  constexpr int quality = 95;  // of 100; above 90 colours have the resolution of brightness
  if ((image.channels != 1 && image.channels != 3) || !has_consistent_size(image) ||
      std::max(image.width, image.height) > most_jpeg_side)
    return base::fail(
        "cannot write {}: found {} x {} pixels of {} channels, expected at most {} a side, of 1 or 3",
        path.string(), image.width, image.height, image.channels, most_jpeg_side);
  JpegBytes out;
  const bool encoded = stbi_write_jpg_to_func(add_bytes, &out, image.width, image.height, image.channels,
                                              image.pixels.data(), quality) != 0;
  if (out.no_memory) throw std::bad_alloc();
  if (!encoded) return base::fail("cannot write {}: its pixels cannot be encoded", path.string());
  return write_file(path, out.bytes);
}

bool is_png_or_jpeg(std::string_view bytes) {
  return bytes.starts_with("\x89PNG") || is_jpeg(bytes);
}

Expected<ImageSize> stated_size(std::string_view bytes) {
  if (bytes.size() > most_file_bytes)
    return base::fail("found {} bytes, expected at most 1 GiB", bytes.size());
  if (!is_jpeg(bytes)) {
    const auto header = check_png_structure(bytes);
    if (!header) return tl::unexpected(header.error());
    return ImageSize{header->width, header->height};
  }
  int width = 0, height = 0, channels = 0;
  if (stbi_info_from_memory(as_stb(bytes), static_cast<int>(bytes.size()), &width, &height, &channels) == 0)
    return base::fail("found no size in its header ({})", reason_of_stb());
  return ImageSize{static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height)};
}

Expected<Image8> decode_rgba(std::string_view bytes) {
  const auto size = stated_size(bytes);
  if (!size) return tl::unexpected(size.error());
  if (!is_jpeg(bytes)) {
    if (const auto checked = check_png_pixels(bytes); !checked) return tl::unexpected(checked.error());
  }
  Image8 image;
  int stored_channels = 0;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(as_stb(bytes), static_cast<int>(bytes.size()), &image.width, &image.height,
                            &stored_channels, 4),
      stbi_image_free);
  if (decoded == nullptr)
    return base::fail("cannot decode its {} x {} pixels ({})", size->width, size->height, reason_of_stb());
  image.channels = 4;
  image.pixels.assign(decoded.get(), decoded.get() + std::size_t{4} * image.width * image.height);
  return image;
}

Expected<Image8> read_png(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto header = check_png_structure(*bytes);
  if (!header) return base::fail("{}: {}", path.string(), header.error().message);
  if (header->bit_depth > 8) {
    return base::fail("{}: found {} bits a channel, expected at most 8", path.string(), header->bit_depth);
  }
  if (std::uint64_t{header->width} * header->height > most_pixels) {
    return base::fail("{}: found {} x {} pixels, expected at most 2^28", path.string(), header->width,
                      header->height);
  }
  if (const auto checked = check_png_pixels(*bytes); !checked)
    return base::fail("{}: {}", path.string(), checked.error().message);
  Image8 image;
  const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes->data()), static_cast<int>(bytes->size()),
                            &image.width, &image.height, &image.channels, 0),
      stbi_image_free);
  if (decoded == nullptr) {
    return base::fail("{}: cannot decode its {} x {} pixels ({})", path.string(), header->width,
                      header->height, reason_of_stb());
  }
  const std::size_t count = static_cast<std::size_t>(image.width) * image.height * image.channels;
  image.pixels.assign(decoded.get(), decoded.get() + count);
  return image;
}

Expected<void> write_pfm(const std::filesystem::path& path, const ImageF& image) {
  static_assert(std::endian::native == std::endian::little, "the scale -1 announces little-endian floats");
  const bool has_pfm_channels = image.channels == 1 || image.channels == 3;
  if (!has_pfm_channels || !has_consistent_size(image)) return refuse_size(path, image);
  std::string bytes =
      fmt::format("{}\n{} {}\n-1.0\n", image.channels == 3 ? "PF" : "Pf", image.width, image.height);
  const std::size_t row_values = static_cast<std::size_t>(image.width) * image.channels;
  for (int y = image.height - 1; y >= 0; --y) {  // PFM stores the bottom row first
    bytes.append(reinterpret_cast<const char*>(image.pixels.data() + y * row_values),
                 row_values * sizeof(float));
  }
  return write_file(path, bytes);
}

}  // namespace tenebra::io
