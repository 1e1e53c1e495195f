// Pictures of all kinds, whole, broken, and larger than they may be.
#include <gtest/gtest.h>

#include <array>

#include "formats/images/decode.h"
#include "formats/import_failure.h"
#include "pictures.h"

#ifdef TENEBRA_WEBP
#include <webp/encode.h>
#endif

namespace tenebra {
namespace {

using formats::decode_image;
using testing::jpeg_of;
using testing::png_of;
using testing::small_picture;

TextureImage decode(const std::string& bytes) {
  std::uint64_t pixels_left = formats::most_scene_pixels;
  return decode_image(bytes, "a picture", pixels_left);
}

std::string refusal(const std::string& bytes, std::uint64_t pixels_left = formats::most_scene_pixels) {
  try {
    decode_image(bytes, "a picture", pixels_left);
  } catch (const formats::ImportFailure& failure) {
    return failure.what();
  }
  return "";
}

void expect_refused(const std::string& bytes, const std::string& words) {
  const std::string said = refusal(bytes);
  EXPECT_NE(said.find(words), std::string::npos) << "said: " << said;
  EXPECT_NE(said.find("expected"), std::string::npos) << said;
}

std::vector<int> values(const TextureImage& image) {
  return {image.rgba.begin(), image.rgba.end()};
}

TEST(ImageDecode, ReadsPngWithItsAlpha) {
  const io::Image8 picture = small_picture(5, 3);
  const TextureImage image = decode(png_of(picture));
  EXPECT_EQ(image.name, "a picture");
  EXPECT_EQ(image.width, 5);
  EXPECT_EQ(image.height, 3);
  EXPECT_EQ(image.rgba, picture.pixels);
}

TEST(ImageDecode, GivesAlpha255WhereThereIsNone) {
  const TextureImage grey = decode(png_of({2, 1, 1, {7, 200}}));
  EXPECT_EQ(values(grey), (std::vector<int>{7, 7, 7, 255, 200, 200, 200, 255}));
  const TextureImage rgb = decode(png_of({1, 1, 3, {1, 2, 3}}));
  EXPECT_EQ(values(rgb), (std::vector<int>{1, 2, 3, 255}));
}

TEST(ImageDecode, ReadsJpeg) {
  io::Image8 picture{16, 8, 3, {}};
  for (int i = 0; i < 16 * 8; ++i) picture.pixels.insert(picture.pixels.end(), {200, 100, 50});
  const TextureImage image = decode(jpeg_of(picture));
  ASSERT_EQ(image.rgba.size(), 4u * 16 * 8);
  EXPECT_NEAR(image.rgba[0], 200, 3);
  EXPECT_NEAR(image.rgba[1], 100, 3);
  EXPECT_NEAR(image.rgba[2], 50, 3);
  EXPECT_EQ(image.rgba[3], 255);
}

TEST(ImageDecode, ReadsBinaryPpmWithCommentsInItsHeader) {
  const TextureImage image =
      decode("P6 # of a gimp\n#\n2 1# two by one\n255\n" + std::string("\1\2\3\4\5\6"));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(values(image), (std::vector<int>{1, 2, 3, 255, 4, 5, 6, 255}));
}

TEST(ImageDecode, ReadsPixelsThatLookLikeBlanksOrComments) {
  EXPECT_EQ(values(decode("P6 1 1 255\n" + std::string("#\n "))), (std::vector<int>{'#', '\n', ' ', 255}));
}

TEST(ImageDecode, RoundsOtherRangesTo255) {
  EXPECT_EQ(values(decode("P6 1 1 3 " + std::string("\0\1\3", 3))), (std::vector<int>{0, 85, 255, 255}));
  EXPECT_EQ(values(decode("P6 1 1 65535 " + std::string("\x80\x80\xff\xff\0\0", 6))),
            (std::vector<int>{128, 255, 0, 255}));
  EXPECT_EQ(values(decode("P6 1 1 100 " + std::string("\x64\x65\x32", 3))),
            (std::vector<int>{255, 255, 128, 255}));  // 101 is more than 100 can be
}

TEST(ImageDecode, ReadsTextPpm) {
  const TextureImage image = decode("P3\n2 1 1023\n0 1023 512 # half\n 1 2 3");
  EXPECT_EQ(values(image), (std::vector<int>{0, 255, 128, 255, 0, 0, 1, 255}));
}

TEST(ImageDecode, RefusesWhatIsBroken) {
  expect_refused("", "no known kind");
  expect_refused("P6", "no known kind");
  expect_refused("GIF89a....", "no known kind");
  expect_refused("P6 2 2 255 abc", "for 2 x 2 pixels");
  expect_refused("P6 2 2 65535 " + std::string(12, 'a'), "12 bytes of pixels");
  expect_refused("P6 x 2 255 ", "no number");
  expect_refused("P6 0 2 255 aaa", "0 x 2 pixels");
  expect_refused("P6 1 1 0 aaa", "found 0 as the largest");
  expect_refused("P6 1 1 65536 aaaaaaa", "found 65536 as the largest");
  expect_refused("P3 1 1 255 1 2 ....", "no number");
  expect_refused("\x89PNG\r\n", "no PNG signature");
  const std::string png = png_of(small_picture(8, 8));
  for (std::size_t size = 4; size < png.size(); size += 7) expect_refused(png.substr(0, size), "whole");
  const std::string jpeg = jpeg_of(small_picture(8, 8));
  expect_refused(jpeg.substr(0, 20), "header");
}

TEST(ImageDecode, NeverCrashesOnChangedBytes) {
  const std::string wholes[] = {png_of(small_picture(8, 8)), jpeg_of(small_picture(8, 8)),
                                testing::ppm_of(8, 8, 1, 2, 3)};
  for (const std::string& whole : wholes)
    for (std::size_t at = 0; at < whole.size(); ++at)
      for (const int change : {0, 0x7F, 0xFF}) {
        std::string broken = whole;
        broken[at] = static_cast<char>(change);
        refusal(broken);  // read or refused
      }
}

TEST(ImageDecode, RefusesBombsByTheirHeader) {
  expect_refused("P6 100000000 100000000 255 abc", "100000000 x 100000000");
  expect_refused("P3 60000 60000 255 1 2 3", "60000 x 60000");
  std::string jpeg = jpeg_of(small_picture(8, 8));
  const std::size_t frame = jpeg.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  for (const std::size_t at : {frame + 5, frame + 6, frame + 7, frame + 8}) jpeg[at] = '\xff';
  expect_refused(jpeg, "65535 x 65535 pixels, expected at most 67108864 in one picture");
}

TEST(ImageDecode, RefusesMorePixelsThanASceneMayHave) {
  const std::string png = png_of(small_picture(4, 4));
  EXPECT_EQ(refusal(png, 16), "");
  EXPECT_NE(refusal(png, 15).find("in all pictures of a scene"), std::string::npos);
  std::uint64_t pixels_left = 40;
  decode_image(png, "", pixels_left);
  EXPECT_EQ(pixels_left, 24u);
}

/// A KTX2 picture of 4 x 4 pixels of one colour: UASTC's mode 8, in which a block is one colour, and its
/// format's descriptor. Numbers are of four bytes.
std::string ktx2_of_one_colour(const std::array<std::uint8_t, 4>& rgba) {
  constexpr std::uint32_t descriptor_at = 104, descriptor_bytes = 44, block_at = 160, block_bytes = 16;
  const std::uint32_t numbers[] = {
      0, 1, 4, 4, 0, 0, 1, 1, 0, descriptor_at, descriptor_bytes,  // to the keys
      0, 0, 0, 0, 0, 0, block_at, 0, block_bytes, 0, block_bytes, 0,
      // size, vendor and type, version and size, model 166 (UASTC, linear), texels 4x4
      descriptor_bytes, 0, 2 | 40 << 16, 166 | 1 << 8 | 1 << 16, 3 | 3 << 8, 16, 0,
      // the one sample: RGBA in 128 bits
      127 << 16 | 3 << 24, 0, 0, 0xFFFFFFFF, 0, 0, 0};
  std::string bytes = "\xABKTX 20\xBB\r\n\x1A\n";
  for (const std::uint32_t number : numbers)
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i);
  bytes.resize(block_at);
  std::uint64_t block = 0x17;  // the mode, in five bits
  for (std::size_t i = 0; i < 4; ++i) block |= std::uint64_t{rgba[i]} << (5 + 8 * i);
  for (unsigned i = 0; i < block_bytes; ++i) bytes += static_cast<char>(i < 8 ? block >> 8 * i : 0);
  return bytes;
}

TEST(ImageDecode, ReadsKtx2OrNamesTheLibrary) {
  const std::string bytes = ktx2_of_one_colour({250, 100, 7, 200});
#ifdef TENEBRA_KTX
  ASSERT_TRUE(formats::reads_ktx2());
  const TextureImage picture = decode(bytes);
  ASSERT_EQ(picture.rgba.size(), 64u);
  for (std::size_t i = 0; i < 64; i += 4)
    EXPECT_EQ(std::vector<std::uint8_t>(&picture.rgba[i], &picture.rgba[i] + 4),
              (std::vector<std::uint8_t>{250, 100, 7, 200}));
#else
  EXPECT_FALSE(formats::reads_ktx2());
  expect_refused(bytes, "install libktx");
#endif
}

#ifdef TENEBRA_KTX
/// libktx believes the file: what it says of its parts is checked before. A descriptor's block of no size
/// made it loop for ever.
TEST(ImageDecode, Ktx2IsCheckedBeforeItIsDecoded) {
  const std::string good = ktx2_of_one_colour({1, 2, 3, 4});
  const auto with = [&](std::size_t at, std::uint32_t number) {
    std::string bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(number >> 8 * i);
    return bytes;
  };
  expect_refused(with(12, 37), "Vulkan's format 37");
  expect_refused(with(20, 1u << 31), "at most");
  expect_refused(with(24, 0), "at least one");
  expect_refused(with(28, 1), "of depth 1");
  expect_refused(with(36, 6), "6 faces");
  expect_refused(with(40, 99), "found 99 levels");
  expect_refused(with(40, 2), "behind its levels");
  expect_refused(with(44, 4), "supercompression 4");
  expect_refused(with(48, 5000), "format descriptor");
  expect_refused(with(112, 2), "one basic block");
  expect_refused(with(60, 5000), "keys");
  expect_refused(with(80, 5000), "levels");
  expect_refused(with(88, 0xFFFFFFFF), "levels");
  expect_refused(with(96, 32), "expected the 16 of UASTC");
  expect_refused(with(44, 1), "shared header");
  for (std::size_t size = 0; size < good.size(); ++size) refusal(good.substr(0, size));
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bytes = good;
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    refusal(bytes);  // a sentence, or a picture
  }
}
#endif

TEST(ImageDecode, ReadsWebpOrNamesThePackage) {
#ifdef TENEBRA_WEBP
  ASSERT_TRUE(formats::reads_webp());
  io::Image8 picture = small_picture(6, 5);
  for (std::size_t i = 3; i < picture.pixels.size(); i += 4)
    if (picture.pixels[i] == 0) picture.pixels[i] = 1;  // colours below alpha 0 are not kept
  std::uint8_t* out = nullptr;
  const std::size_t size =
      WebPEncodeLosslessRGBA(picture.pixels.data(), picture.width, picture.height, 4 * picture.width, &out);
  const std::string bytes(reinterpret_cast<const char*>(out), size);
  WebPFree(out);
  EXPECT_EQ(decode(bytes).rgba, picture.pixels);
  expect_refused(bytes.substr(0, 18), "broken WebP");
  expect_refused(bytes.substr(0, size / 2), "broken WebP");
#else
  EXPECT_FALSE(formats::reads_webp());
  expect_refused("RIFF....WEBPVP8 ", "libwebp-dev");
#endif
}

}  // namespace
}  // namespace tenebra
