// OpenEXR pictures: what is written is read again, and what is damaged ends in a sentence.
// tests/pictures_test.py reads them with readers that are not ours.
#include "io/exr/exr_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/output_file.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {
namespace {

namespace exr = io::exr;

constexpr float infinite = std::numeric_limits<float>::infinity();

struct Sample {
  std::vector<float> colors, depth;
  std::vector<std::uint32_t> ids;
  exr::Picture picture;
};

/// 5 x 3 pixels with values that halves hold exactly, but for the last red.
Sample sample(exr::Precision precision, exr::Compression compression) {
  Sample s;
  for (int i = 0; i < 15; ++i) {
    s.colors.insert(s.colors.end(), {0.25f * static_cast<float>(i), -2.0f, 1e-3f});
    s.depth.push_back(1.0f + 1e-7f * static_cast<float>(i));
    s.ids.push_back(0xfffffff0u + static_cast<std::uint32_t>(i));
  }
  s.colors[3 * 14] = 1e9f;
  s.depth[14] = infinite;
  s.picture = {.width = 5, .height = 3, .compression = compression};
  for (std::size_t c = 0; c < 3; ++c)
    s.picture.channels.push_back(
        {std::string(1, "RGB"[c]), exr::Floats{std::span(s.colors).subspan(c), 3, precision}});
  s.picture.channels.push_back({"Z", exr::Floats{s.depth, 1, exr::Precision::full}});
  s.picture.channels.push_back({"id", exr::Numbers(s.ids)});
  s.picture.texts.push_back({"software", "tenebra"});
  return s;
}

Expected<io::ImageF> read_back(const TemporaryFolder& folder, const std::string& bytes,
                               std::string_view layer = "") {
  if (auto written = io::write_file(folder / "a.exr", bytes); !written)
    return tl::unexpected(written.error());
  return exr::read(folder / "a.exr", layer);
}

TEST(ExrFile, KeepsFloatsAndRoundsHalves) {
  const TemporaryFolder folder;
  for (const auto compression : {exr::Compression::zip, exr::Compression::piz}) {
    const Sample full = sample(exr::Precision::full, compression);
    const auto bytes = exr::encode(full.picture);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto colors = read_back(folder, *bytes);
    ASSERT_TRUE(colors) << colors.error().message;
    EXPECT_EQ(colors->pixels, full.colors);
    EXPECT_EQ(read_back(folder, *bytes, "Z")->pixels, full.depth);
    EXPECT_EQ(read_back(folder, *bytes, "id")->pixels[14], 4294967294.0f);

    Sample half = sample(exr::Precision::half, compression);
    const auto halves = read_back(folder, *exr::encode(half.picture));
    ASSERT_TRUE(halves);
    EXPECT_EQ(halves->pixels[3 * 14], 65504.0f);  // not infinite
    half.colors[3 * 14] = 65504.0f;
    for (std::size_t i = 0; i < half.colors.size(); ++i)
      EXPECT_NEAR(halves->pixels[i], half.colors[i], std::abs(half.colors[i]) / 2048) << i;
  }
}

TEST(ExrFile, WritesTheSameBytesForTheSamePicture) {
  const Sample a = sample(exr::Precision::half, exr::Compression::zip),
               b = sample(exr::Precision::half, exr::Compression::zip);
  EXPECT_EQ(*exr::encode(a.picture), *exr::encode(b.picture));
}

TEST(ExrFile, NamesTheChannelsThatItFound) {
  const TemporaryFolder folder;
  const Sample s = sample(exr::Precision::half, exr::Compression::zip);
  const auto none = read_back(folder, *exr::encode(s.picture), "N");
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("found the channels B, G, R, Z, id, expected N"), std::string::npos)
      << none.error().message;
}

TEST(ExrFile, RefusesWhatIsDamaged) {
  const TemporaryFolder folder;
  const Sample s = sample(exr::Precision::half, exr::Compression::zip);
  const std::string whole = *exr::encode(s.picture);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    const auto cut = read_back(folder, whole.substr(0, size));
    ASSERT_FALSE(cut) << size;
    EXPECT_EQ(cut.error().message.find('\n'), std::string::npos);
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {  // fails or not, but ends
    std::string bytes = whole;
    bytes[at] = static_cast<char>(~bytes[at]);
    const auto read = read_back(folder, bytes);
    EXPECT_LE(read ? read->pixels.size() : 0, 3u << 20) << at;
  }
}

/// The header states what would take gigabytes.
TEST(ExrFile, TakesNoMemoryForWhatTheFileCannotHold) {
  const TemporaryFolder folder;
  const Sample s = sample(exr::Precision::half, exr::Compression::zip);
  const std::string whole = *exr::encode(s.picture);
  const auto with_number = [&](std::string_view name, std::size_t behind, std::uint32_t number) {
    std::string bytes = whole;
    const std::size_t at = bytes.find(name) + behind;
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(number >> (8 * i) & 0xff);
    return bytes;
  };
  const std::string_view window("dataWindow\0box2i\0", 17), text("software\0string\0", 16);
  const auto wide = read_back(folder, with_number(window, 17 + 4 + 8, (1 << 24) - 1));
  ASSERT_FALSE(wide);
  EXPECT_NE(wide.error().message.find("cannot hold its 16777216 x 3 pixels"), std::string::npos)
      << wide.error().message;
  const auto wider = read_back(folder, with_number(window, 17 + 4 + 8, 0x7fffff00));
  ASSERT_FALSE(wider);
  const auto long_text = read_back(folder, with_number(text, 16, 0x7ffffff0));
  ASSERT_FALSE(long_text);
  EXPECT_NE(long_text.error().message.find("an attribute of 2147483632 bytes"), std::string::npos)
      << long_text.error().message;
}

/// Found by fuzzing: the library reads values by their types, whatever size is stated, and took what came
/// after the channels here for an attribute of a gigabyte.
TEST(ExrFile, AttributesTakeTheBytesThatTheyState) {
  const TemporaryFolder folder;
  const std::string begin("\x76\x2f\x31\x01\x02\0\0\0", 8);
  const auto refused = [&](const std::string& attribute, std::string_view what) {
    const auto read = read_back(folder, begin + attribute + std::string(600, '\0'));
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find(what), std::string::npos) << read.error().message;
  };
  const std::string channel("R\0\1\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0", 18), end(1, '\0');
  const auto with_size = [](std::string type_and_name, int size) {
    return type_and_name + std::string({static_cast<char>(size), 0, 0, 0});
  };
  const std::string channels("channels\0chlist\0", 16), window("dataWindow\0box2i\0", 17),
      views("multiView\0stringvector\0", 23), preview("preview\0preview\0", 16),
      weights("weights\0floatvector\0", 20);
  refused(with_size(channels, 18 + 1 + 40) + channel + end + std::string(40, 'x'),
          "whose 59 bytes are no chlist");
  refused(with_size(channels, 18) + channel, "whose 18 bytes are no chlist");
  refused(with_size(channels, 5) + "R" + end + "123", "whose 5 bytes are no chlist");
  refused(with_size(window, 20) + std::string(20, '\0'), "whose 20 bytes are no box2i");
  refused(with_size(views, 8) + std::string("\x10\0\0\0left", 8), "whose 8 bytes are no stringvector");
  refused(with_size(weights, 7) + std::string(7, '\0'), "whose 7 bytes are no floatvector");
  refused(with_size(preview, 12) + std::string("\2\0\0\0\2\0\0\0....", 12), "whose 12 bytes are no preview");
}

}  // namespace
}  // namespace tenebra::testing
