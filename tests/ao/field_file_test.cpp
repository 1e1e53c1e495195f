// Fields on disk: a saved field comes back bit for bit; any other file there is refused with a sentence.
#include "ao/field/field_file.h"

#include <gtest/gtest.h>

#include <set>

#include "ao/objects.h"
#include "support/seeded_random.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

using testing::chords;
using testing::Object;
using testing::paper;
using testing::Random;
namespace fs = std::filesystem;

ao::CacheKey key_of(const Object& object, const ao::FieldSettings& settings) {
  return ao::field_key(object.positions, object.triangles, settings);
}

void expect_same(const ao::DisplacementField& a, const ao::DisplacementField& b) {
  EXPECT_EQ(a.layout, b.layout);
  EXPECT_EQ(a.bits, b.bits);
  EXPECT_EQ(a.table, b.table);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.close, b.close);
  EXPECT_EQ(a.bound.centre, b.bound.centre);
  EXPECT_EQ(a.bound.axes, b.bound.axes);
}

TEST(FieldFile, GivesBackWhatWasSaved) {
  const testing::TemporaryFolder folder;
  const Object object = testing::table();
  for (const FieldLayout layout : {paper, chords}) {
    for (const int bits : {1, 8, 32}) {
      const ao::FieldSettings settings{layout, 625, 625, bits};
      const ao::DisplacementField field = object.field(settings);
      const ao::CacheKey key = key_of(object, settings);
      ASSERT_TRUE(ao::save_field(folder.path() / "new" / "folder", key, field));
      const auto loaded = ao::load_field(folder.path() / "new" / "folder", key, settings);
      ASSERT_TRUE(loaded) << loaded.error().message;
      expect_same(field, *loaded);
      // Compressed: most rays pass the table by.
      EXPECT_LT(fs::file_size(ao::field_path(folder.path() / "new" / "folder", key)), field.bytes() * 2 / 3);
    }
  }
}

TEST(FieldFile, TheKeyChangesWithEverythingThatMatters) {
  const Object object = testing::table();
  std::set<std::string> keys;
  int count = 0;
  const auto add = [&](const Object& o, const ao::FieldSettings& s) {
    keys.insert(ao::field_path("", key_of(o, s)).string());
    ++count;
  };
  add(object, {});
  add(object, {paper, 4225, 1024, 8});
  add(object, {chords, 4224, 1024, 8});
  add(object, {chords, 4225, 1023, 8});
  add(object, {chords, 4225, 1024, 1});
  for (std::size_t i = 0; i < 3 * object.positions.size(); ++i) {
    Object other = object;
    float& x = other.positions[i / 3][static_cast<int>(i % 3)];
    x = std::nextafter(x, 9.0f);
    add(other, {});
  }
  Object turned = object;
  std::swap(turned.triangles[0].x, turned.triangles[0].y);
  add(turned, {});
  EXPECT_EQ(static_cast<int>(keys.size()), count);
  EXPECT_EQ(key_of(object, {}), key_of(testing::table(), {}));
}

TEST(FieldFile, RefusesWhatIsDamagedCutOrForeign) {
  const testing::TemporaryFolder folder;
  const Object object = testing::table();
  const ao::FieldSettings settings{chords, 121, 121, 8};
  const ao::CacheKey key = key_of(object, settings);
  const fs::path path = ao::field_path(folder.path(), key);
  EXPECT_FALSE(ao::load_field(folder.path(), key, settings));  // missing
  ASSERT_TRUE(ao::save_field(folder.path(), key, object.field(settings)));
  const std::string good = testing::read_text(path);
  ASSERT_TRUE(ao::load_field(folder.path(), key, settings));
  const auto refused = [&](const std::string& bytes) {
    testing::write_text(path, bytes);
    const auto loaded = ao::load_field(folder.path(), key, settings);
    if (loaded) return bytes == good;
    EXPECT_NE(loaded.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(loaded.error().message.find('\n'), std::string::npos);
    return true;
  };
  for (std::size_t size = 0; size < 200; ++size) EXPECT_TRUE(refused(good.substr(0, size)));
  EXPECT_TRUE(refused(good.substr(0, good.size() - 1)));
  EXPECT_TRUE(refused(good + "x"));
  EXPECT_TRUE(refused(good + good));
  EXPECT_TRUE(refused(std::string(5'000'000, 'x')));
  for (std::size_t at = 0; at < 200; ++at) {  // every bit of the header, and beyond
    for (int bit = 0; bit < 8; ++bit) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(bytes[at] ^ 1 << bit);
      EXPECT_TRUE(refused(bytes)) << at;
    }
  }
  Random random(2);
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    const int flips = 1 + static_cast<int>(random.index(8));
    for (int k = 0; k < flips; ++k)
      bytes[random.index(static_cast<std::uint32_t>(bytes.size()))] = static_cast<char>(random.bits());
    if (random.chance(0.2)) bytes.resize(random.index(static_cast<std::uint32_t>(bytes.size())));
    if (random.chance(0.2)) bytes.insert(random.index(static_cast<std::uint32_t>(bytes.size())), "zstd");
    EXPECT_TRUE(refused(bytes));
  }
  // A whole field, but of something else: of other geometry, other settings.
  const ao::FieldSettings others[] = {{chords, 121, 121, 1}, {paper, 121, 121, 8}, {chords, 144, 144, 8}};
  for (const ao::FieldSettings& other : others) {
    ASSERT_TRUE(ao::save_field(folder.path(), key_of(object, other), object.field(other)));
    EXPECT_TRUE(refused(testing::read_text(ao::field_path(folder.path(), key_of(object, other)))));
  }
  const Object ball = testing::ball({0, 0, 0}, {1, 1, 1}, 6);
  ASSERT_TRUE(ao::save_field(folder.path(), key_of(ball, settings), ball.field(settings)));
  EXPECT_TRUE(refused(testing::read_text(ao::field_path(folder.path(), key_of(ball, settings)))));
  testing::write_text(path, good);
  EXPECT_TRUE(ao::load_field(folder.path(), key, settings));
}

TEST(FieldFile, SaysWhyItCannotSave) {
  const testing::TemporaryFolder folder;
  const Object object = testing::table();
  const ao::FieldSettings settings{chords, 16, 16, 8};
  testing::write_text(folder / "file", "in the way");
  const auto saved = ao::save_field(folder / "file", key_of(object, settings), object.field(settings));
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("file"), std::string::npos);
}

}  // namespace
}  // namespace tenebra
