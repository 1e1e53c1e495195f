// KTX2 with Basis Universal (KHR_texture_basisu) by libktx, where CMake found it.
#include "formats/images/decode.h"
#include "formats/import_failure.h"

#ifdef TENEBRA_KTX
#include <ktx.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <vector>
#endif

namespace tenebra::formats {

#ifdef TENEBRA_KTX
namespace {

struct DestroyKtx {
  void operator()(ktxTexture2* texture) const { ktxTexture2_Destroy(texture); }
};
using KtxTexture = std::unique_ptr<ktxTexture2, DestroyKtx>;

/// A little-endian number at byte `at`, which `bytes` have.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little, "a KTX2 file is little-endian");
  Number value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// libktx believes what a file says of its own parts; so whatever it goes by is checked here first
// (KTX 2.0, 3.1 to 3.12). The header is 80 bytes, then come three numbers for each level.
constexpr std::size_t header_bytes = 80, level_bytes = 24;
constexpr std::uint32_t without = 0, basis_lz = 1, zlib = 3;  // supercompression schemes
constexpr std::uint64_t block_side = 4, block_bytes = 16;     // of UASTC

struct Ktx2Header {
  std::uint32_t width = 0, height = 0, levels = 0, scheme = 0;
};

/// The `size` bytes at `from`; throws where the file ends before.
std::string_view part(std::string_view bytes, std::uint64_t from, std::uint64_t size, const char* what) {
  if (from > bytes.size() || size > bytes.size() - from)
    refuse("found the {} of a KTX2 picture beyond its {} bytes, expected a whole picture", what,
           bytes.size());
  return bytes.substr(from, size);
}

/// The descriptor of the format is one basic block with its samples, where libktx reads it: behind the
/// levels. On a block that states no size libktx loops for ever.
void check_descriptor(std::string_view bytes, std::uint32_t at, std::uint32_t size, std::uint32_t levels) {
  constexpr std::uint32_t total_bytes = 4, basic_bytes = 24, sample_bytes = 16;
  const std::string_view descriptor = part(bytes, at, size, "format descriptor");
  const bool is_basic = at == header_bytes + levels * level_bytes && size > total_bytes + basic_bytes &&
                        (size - total_bytes - basic_bytes) % sample_bytes == 0 &&
                        number_at<std::uint32_t>(descriptor, 0) == size &&
                        number_at<std::uint16_t>(descriptor, 10) == size - total_bytes;
  if (!is_basic)
    refuse(
        "found a format descriptor of {} bytes at byte {} of a KTX2 picture, expected one basic block behind "
        "its levels",
        size, at);
}

/// One flat picture with its levels of detail. Takes its pixels.
Ktx2Header read_header(std::string_view bytes, std::uint64_t& pixels_left) {
  part(bytes, 0, header_bytes, "header");
  const auto field = [&](std::size_t at) { return number_at<std::uint32_t>(bytes, at); };
  if (const std::uint32_t format = field(12); format != 0)
    refuse("found a KTX2 picture of Vulkan's format {}, expected Basis Universal", format);
  const Ktx2Header header{field(20), field(24), std::max(field(40), 1u), field(44)};
  const std::uint32_t depth = field(28), layers = field(32), faces = field(36);
  if (depth > 0 || layers > 0 || faces != 1)
    refuse("found a KTX2 picture of depth {}, {} layers and {} faces, expected 0, 0 and 1", depth, layers,
           faces);
  if (header.scheme > zlib)
    refuse("found a KTX2 picture of supercompression {}, expected 0 to 3", header.scheme);
  charge_pixels(header.width, header.height, pixels_left);
  const auto most_levels = static_cast<std::uint32_t>(std::bit_width(std::max(header.width, header.height)));
  if (header.levels > most_levels)
    refuse("found {} levels in a KTX2 picture of {} x {} pixels, expected at most {}", header.levels,
           header.width, header.height, most_levels);
  check_descriptor(bytes, field(48), field(52), header.levels);
  part(bytes, field(56), field(60), "keys");
  return header;
}

/// The levels lie in the file from the smallest to the largest and decode to UASTC's blocks. Returns the
/// sizes as they are stored.
std::vector<std::uint64_t> check_levels(std::string_view bytes, const Ktx2Header& header) {
  const std::string_view index = part(bytes, header_bytes, header.levels * level_bytes, "levels");
  std::vector<std::uint64_t> sizes(header.levels);
  std::uint64_t end = 0;
  for (std::uint32_t level = header.levels; level-- > 0;) {
    const std::size_t entry = level * level_bytes;
    const auto from = number_at<std::uint64_t>(index, entry),
               size = number_at<std::uint64_t>(index, entry + 8),
               decoded = number_at<std::uint64_t>(index, entry + 16);
    part(bytes, from, size, "levels");
    if (from < end || size == 0)
      refuse("found level {} of a KTX2 picture at byte {}, expected it behind the smaller ones", level, from);
    end = from + size;
    const auto blocks = [&](std::uint32_t side) {
      return (std::max(side >> level, 1u) + block_side - 1) / block_side;
    };
    const std::uint64_t expected = block_bytes * blocks(header.width) * blocks(header.height);
    if (header.scheme != basis_lz && (decoded != expected || (header.scheme == without && size != expected)))
      refuse("found {} bytes in level {} of a KTX2 picture, expected the {} of UASTC", decoded, level,
             expected);
    sizes[level] = size;
  }
  return sizes;
}

/// ETC1S: what all levels share, and where in each level its picture lies.
void check_shared_data(std::string_view shared, const std::vector<std::uint64_t>& level_sizes) {
  constexpr std::size_t lengths = 4, shared_header = 20, image_bytes = 20;
  part(shared, 0, shared_header, "shared header");
  std::uint64_t end = shared_header + image_bytes * level_sizes.size();
  for (std::size_t i = 0; i < lengths; ++i) end += number_at<std::uint32_t>(shared, 4 + 4 * i);
  part(shared, 0, end, "shared data");
  for (std::size_t level = 0; level < level_sizes.size(); ++level)
    for (const std::size_t slice : {4, 12}) {  // colours, alpha: where and how many bytes
      const std::size_t at = shared_header + image_bytes * level + slice;
      if (std::uint64_t{number_at<std::uint32_t>(shared, at)} + number_at<std::uint32_t>(shared, at + 4) >
          level_sizes[level])
        refuse("found a slice of a KTX2 picture beyond its level {}, expected it within", level);
    }
}

void check_ktx2(std::string_view bytes, std::uint64_t& pixels_left) {
  const Ktx2Header header = read_header(bytes, pixels_left);
  const std::vector<std::uint64_t> level_sizes = check_levels(bytes, header);
  const std::string_view shared =
      part(bytes, number_at<std::uint64_t>(bytes, 64), number_at<std::uint64_t>(bytes, 72), "shared data");
  if (header.scheme == basis_lz) check_shared_data(shared, level_sizes);
}

/// Throws unless `result` is success.
void expect_done(KTX_error_code result, const char* stage) {
  if (result != KTX_SUCCESS)
    refuse("found a KTX2 picture that cannot be {} ({}), expected a whole one in Basis Universal", stage,
           ktxErrorString(result));
}

}  // namespace

bool reads_ktx2() {
  return true;
}

TextureImage decode_ktx2(std::string_view bytes, std::uint64_t& pixels_left) {
  check_ktx2(bytes, pixels_left);
  ktxTexture2* opened = nullptr;
  const auto* data = reinterpret_cast<const ktx_uint8_t*>(bytes.data());
  expect_done(ktxTexture2_CreateFromMemory(
                  data, bytes.size(),
                  KTX_TEXTURE_CREATE_LOAD_IMAGE_DATA_BIT | KTX_TEXTURE_CREATE_SKIP_KVDATA_BIT, &opened),
              "read");
  const KtxTexture texture(opened);
  if (!ktxTexture2_NeedsTranscoding(opened))
    refuse("found a KTX2 picture in another encoding, expected Basis Universal");
  expect_done(ktxTexture2_TranscodeBasis(opened, KTX_TTF_RGBA32, 0), "decoded");
  TextureImage image;
  image.width = static_cast<int>(opened->baseWidth);
  image.height = static_cast<int>(opened->baseHeight);
  const std::size_t size = std::size_t{4} * opened->baseWidth * opened->baseHeight;
  ktx_size_t from = 0;
  expect_done(ktxTexture2_GetImageOffset(opened, 0, 0, 0, &from), "found");
  if (from > opened->dataSize || size > opened->dataSize - from)
    refuse("found {} bytes of a KTX2 picture decoded, expected {}", opened->dataSize, size);
  image.rgba.assign(opened->pData + from, opened->pData + from + size);
  return image;
}

#else

bool reads_ktx2() {
  return false;
}

TextureImage decode_ktx2(std::string_view, std::uint64_t&) {
  refuse(
      "found a KTX2 picture, which this build does not read, expected PNG, JPEG or PPM (install libktx of "
      "KTX-Software and build again to read KTX2)");
}

#endif

}  // namespace tenebra::formats
