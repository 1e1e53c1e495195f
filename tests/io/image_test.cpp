// PNG and PFM: what is written is read back, and what is broken is refused.
#include "io/image.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::read_text;
using testing::TemporaryFolder;
using testing::write_text;

io::Image8 random_image(int width, int height, int channels, unsigned seed) {
  std::mt19937 random(seed);
  io::Image8 image{width, height, channels, {}};
  image.pixels.resize(static_cast<std::size_t>(width) * height * channels);
  for (auto& value : image.pixels) value = static_cast<std::uint8_t>(random());
  return image;
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

/// Bit by bit, as the definition has it (PNG, annex D).
std::uint32_t slow_crc(const std::string& bytes) {
  std::uint32_t crc = ~0u;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320u : 0);
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& content) {
  return big_endian(static_cast<std::uint32_t>(content.size())) + type + content +
         big_endian(slow_crc(type + content));
}

const std::string signature("\x89PNG\r\n\x1a\n", 8);

std::string png_with_header(std::uint32_t width, std::uint32_t height, char bit_depth,
                            const std::string& idat) {
  const std::string header = big_endian(width) + big_endian(height) + bit_depth + std::string("\0\0\0\0", 4);
  return signature + chunk("IHDR", header) + chunk("IDAT", idat) + chunk("IEND", "");
}

/// Reads `bytes` as a PNG file; the failure's sentence, which must name the file, or "" if it was read.
std::string refusal_of(const TemporaryFolder& folder, const std::string& bytes) {
  write_text(folder / "bad.png", bytes);
  const auto image = io::read_png(folder / "bad.png");
  if (image) return "";
  EXPECT_NE(image.error().message.find("bad.png"), std::string::npos) << image.error().message;
  EXPECT_EQ(image.error().message.find('\n'), std::string::npos) << image.error().message;
  return image.error().message;
}

TEST(Png, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3, 4}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 97}, {97, 1}, {33, 31}, {640, 2}}) {
      const io::Image8 image = random_image(width, height, channels, 1);
      ASSERT_TRUE(io::write_png(folder / "a.png", image));
      const auto read = io::read_png(folder / "a.png");
      ASSERT_TRUE(read) << read.error().message;
      EXPECT_EQ(*read, image) << width << " x " << height << " x " << channels;
    }
  }
}

TEST(Png, RefusesToWriteWhatIsNoPicture) {
  const TemporaryFolder folder;
  EXPECT_FALSE(io::write_png(folder / "a.png", io::Image8{}));
  EXPECT_FALSE(io::write_png(folder / "a.png", io::Image8{2, 2, 3, std::vector<std::uint8_t>(11)}));
  EXPECT_FALSE(io::write_png(folder / "a.png", io::Image8{2, 2, 2, std::vector<std::uint8_t>(8)}));
  EXPECT_FALSE(io::write_png(folder / "a.png", io::Image8{-2, -2, 1, std::vector<std::uint8_t>(4)}));
  EXPECT_TRUE(folder.names().empty());
}

TEST(Png, ReportsWhereItCannotWrite) {
  const TemporaryFolder folder;
  const auto written = io::write_png(folder / "no/a.png", random_image(2, 2, 1, 1));
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("No such file or directory"), std::string::npos)
      << written.error().message;
}

TEST(Png, RefusesWhatIsNoPng) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal_of(folder, "").find("no PNG signature"), std::string::npos);
  EXPECT_NE(refusal_of(folder, "P5 1 1 255 x").find("no PNG signature"), std::string::npos);
  EXPECT_NE(refusal_of(folder, signature), "");
  EXPECT_NE(refusal_of(folder, signature + chunk("IDAT", "x")).find("first chunk"), std::string::npos);
  EXPECT_FALSE(io::read_png(folder / "missing.png"));
  EXPECT_FALSE(io::read_png(folder.path()));
}

/// The compressed bytes of a picture that write_png writes: it has one chunk of them.
std::string compressed(const io::Image8& image) {
  const std::string png = io::encode_png(image).value();
  const std::size_t at = png.find("IDAT");
  return png.substr(at + 4, png.size() - at - 4 - 4 - 12);
}

TEST(Png, RefusesMoreCompressedDataThanItsPixelsTake) {
  const TemporaryFolder folder;
  const io::Image8 large{4000, 4000, 1, std::vector<std::uint8_t>(16000000, 7)};
  const std::string bomb = png_with_header(4, 4, 8, compressed(large));
  EXPECT_LT(bomb.size(), 400000u);
  EXPECT_NE(refusal_of(folder, bomb).find("more compressed data than its 4 x 4 pixels take"),
            std::string::npos);
  EXPECT_FALSE(io::decode_rgba(bomb));
  EXPECT_EQ(refusal_of(folder, png_with_header(4000, 4000, 8, compressed(large))), "");
  EXPECT_NE(refusal_of(folder, png_with_header(4, 4, 8, "x\x9cnonsense")).find("damaged"), std::string::npos);
}

TEST(Png, RefusesEveryTruncation) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "a.png", random_image(13, 7, 3, 2)));
  const std::string whole = read_text(folder / "a.png");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_NE(refusal_of(folder, whole.substr(0, size)), "") << size;
  }
}

TEST(Png, RefusesEveryFlippedBit) {
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_png(folder / "a.png", random_image(5, 7, 3, 3)));
  const std::string whole = read_text(folder / "a.png");
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::string broken = whole;
    broken[bit / 8] = static_cast<char>(broken[bit / 8] ^ 1 << bit % 8);
    ASSERT_NE(refusal_of(folder, broken), "") << "bit " << bit;
  }
}

TEST(Png, RefusesRandomBytesWithRightChecksums) {
  const TemporaryFolder folder;
  std::mt19937 random(4);
  for (int i = 0; i < 1000; ++i) {
    std::string idat(random() % 200, '\0');
    for (char& byte : idat) byte = static_cast<char>(random());
    ASSERT_NE(refusal_of(folder, png_with_header(40, 40, 8, idat)), "") << i;
  }
}

TEST(Png, RefusesClaimsThatItsBytesCannotHoldBeforeDecoding) {
  const TemporaryFolder folder;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_NE(refusal_of(folder, png_with_header(16384, 16384, 8, "tiny")).find("too few"), std::string::npos);
  EXPECT_NE(refusal_of(folder, png_with_header(0xffffffffu, 0xffffffffu, 8, "tiny")), "");
  EXPECT_NE(refusal_of(folder, png_with_header(40000, 40000, 8, std::string(1'000'000, 'x'))).find("2^28"),
            std::string::npos);
  EXPECT_NE(refusal_of(folder, png_with_header(0, 5, 8, "tiny")), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST(Png, RefusesSixteenBits) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal_of(folder, png_with_header(1, 1, 16, "tiny")).find("16 bits"), std::string::npos);
}

TEST(Pfm, ReadsBackBitForBitBottomRowFirst) {
  const TemporaryFolder folder;
  io::ImageF image{2, 3, 1, {1.0f, -0.0f, 1e-42f, INFINITY, NAN, 0.1f}};
  for (const int channels : {1, 3}) {
    image.channels = channels;
    image.width = channels == 1 ? 2 : 1;
    image.height = channels == 1 ? 3 : 2;
    ASSERT_TRUE(io::write_pfm(folder / "a.pfm", image));
    const std::string bytes = read_text(folder / "a.pfm");
    std::istringstream stream(bytes);
    std::string kind;
    int width = 0;
    int height = 0;
    double scale = 0;
    stream >> kind >> width >> height >> scale;
    EXPECT_EQ(kind, channels == 1 ? "Pf" : "PF");
    EXPECT_EQ(width, image.width);
    EXPECT_EQ(height, image.height);
    EXPECT_EQ(scale, -1.0);
    const std::size_t begin = static_cast<std::size_t>(stream.tellg()) + 1;
    ASSERT_EQ(bytes.size() - begin, image.pixels.size() * sizeof(float));
    const std::size_t row = static_cast<std::size_t>(width) * channels * sizeof(float);
    for (int y = 0; y < height; ++y) {
      const char* stored = bytes.data() + begin + (height - 1 - y) * row;
      EXPECT_EQ(std::memcmp(stored, image.pixels.data() + y * width * channels, row), 0) << "row " << y;
    }
    const auto read = io::read_pfm(folder / "a.pfm");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->width, image.width);
    EXPECT_EQ(std::memcmp(read->pixels.data(), image.pixels.data(), image.pixels.size() * sizeof(float)), 0);
  }
}

TEST(Pfm, ReadsBigEndianFloats) {
  const TemporaryFolder folder;
  write_text(folder / "a.pfm", "Pf\n2 1\n1.0\n" + big_endian(0x3f800000) + big_endian(0xc0200000));
  const auto image = io::read_pfm(folder / "a.pfm");
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->pixels, (std::vector<float>{1.0f, -2.5f}));
}

TEST(Pfm, RefusesToWriteWhatIsNoPicture) {
  const TemporaryFolder folder;
  EXPECT_FALSE(io::write_pfm(folder / "a.pfm", io::ImageF{}));
  EXPECT_FALSE(io::write_pfm(folder / "a.pfm", io::ImageF{1, 1, 4, std::vector<float>(4)}));
  EXPECT_TRUE(folder.names().empty());
}

TEST(Jpeg, HoldsAPictureOfGradients) {
  io::Image8 image{64, 48, 3, {}};
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x)
      for (const int level : {4 * x, 5 * y, 255 - 4 * x})
        image.pixels.push_back(static_cast<std::uint8_t>(level));
  const TemporaryFolder folder;
  ASSERT_TRUE(io::write_jpeg(folder / "a.jpg", image).has_value());
  const auto read = io::decode_rgba(read_text(folder / "a.jpg"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->width, 64);
  ASSERT_EQ(read->height, 48);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    ASSERT_NEAR(read->pixels[i / 3 * 4 + i % 3], image.pixels[i], 6) << i;
}

TEST(Jpeg, RefusesWhatItCannotHold) {
  const TemporaryFolder folder;
  EXPECT_FALSE(io::write_jpeg(folder / "a.jpg", {2, 1, 4, {1, 2, 3, 4, 5, 6, 7, 8}}).has_value());
  EXPECT_FALSE(
      io::write_jpeg(folder / "a.jpg", {65'536, 1, 1, std::vector<std::uint8_t>(65'536)}).has_value());
  EXPECT_FALSE(io::write_jpeg(folder / "a.jpg", {3, 1, 1, {1, 2}}).has_value());
  EXPECT_FALSE(std::filesystem::exists(folder / "a.jpg"));
}

}  // namespace
}  // namespace tenebra
