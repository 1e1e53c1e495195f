// Trees on disk: what was saved comes back bit for bit; what is no order of all triangles is refused with a
// sentence, and no file can make a tree that is not whole.
#include "ao/cache/tree_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "support/samples.h"
#include "support/seeded_random.h"
#include "support/temporary_folder.h"
#include "trees/bvh_order.h"

namespace tenebra {
namespace {

using namespace testing;
using glm::dvec3;
using glm::vec3;
namespace fs = std::filesystem;

struct TreeTriangles {
  std::vector<vec3> positions;
  std::vector<glm::uvec3> triangles;
  trees::TriangleBvh bvh() const { return trees::build_triangle_bvh(positions, triangles); }
  std::optional<trees::TriangleBvh> ordered(const trees::BvhOrder& order) const {
    return trees::order_triangles(positions, triangles, order);
  }
};

/// Every seventh is none that a tree holds: flat, out of range, not finite.
TreeTriangles make_triangles(int count, std::uint64_t seed = 1) {
  Random random(seed);
  TreeTriangles set;
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(set.positions.size());
    const dvec3 at = 3.0 * random.in_cube(1);
    for (int k = 0; k < 3; ++k) set.positions.emplace_back(at + random.in_cube(0.2));
    set.triangles.emplace_back(first, first + 1, first + 2);
    if (i % 21 == 6) set.triangles.back().z = first;
    if (i % 21 == 13) set.triangles.back().z = 1'000'000;
    if (i % 21 == 20) set.positions.back().x = INFINITY;
  }
  return set;
}

bool same(const trees::BvhNode& a, const trees::BvhNode& b) {
  return std::memcmp(a.plane, b.plane, sizeof(a.plane)) == 0 &&
         std::memcmp(a.child, b.child, sizeof(a.child)) == 0;
}
bool same(const trees::BvhTriangles& a, const trees::BvhTriangles& b) {
  return std::memcmp(a.corner, b.corner, sizeof(a.corner)) == 0 &&
         std::memcmp(a.triangle, b.triangle, sizeof(a.triangle)) == 0;
}
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return same(x, y); });
}
bool same(const trees::TriangleBvh& a, const trees::TriangleBvh& b) {
  return a.triangles == b.triangles && same(a.nodes, b.nodes) && same(a.blocks, b.blocks);
}

TEST(TreeFile, GivesBackWhatWasSavedBitForBit) {
  const TemporaryFolder folder;
  for (const int count : {0, 1, 8, 9, 500, 20'000}) {
    const TreeTriangles set = make_triangles(count);
    const trees::TriangleBvh built = set.bvh();
    const ao::CacheKey key = ao::tree_key(set.positions, set.triangles);
    ASSERT_TRUE(ao::save_tree(folder.path() / "new" / "folder", key, built));
    const auto loaded = ao::load_tree(folder.path() / "new" / "folder", key, set.positions, set.triangles);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_TRUE(same(*loaded, built)) << count << " triangles";
  }
}

TEST(TreeFile, TrianglesInOnePlaceComeBackToo) {
  TreeTriangles set = make_triangles(1);
  set.triangles.assign(3000, set.triangles.front());
  const trees::TriangleBvh built = set.bvh();
  const auto again = set.ordered(trees::order_of(built));
  ASSERT_TRUE(again);
  EXPECT_TRUE(same(*again, built));
}

TEST(TreeFile, TheKeyChangesWithEveryTriangle) {
  const TreeTriangles set = make_triangles(100);
  std::set<std::string> keys;
  const auto add = [&](const TreeTriangles& of) {
    keys.insert(ao::tree_path("", ao::tree_key(of.positions, of.triangles)).string());
  };
  add(set);
  TreeTriangles other = set;
  other.positions[7].y = std::nextafter(other.positions[7].y, INFINITY);
  add(other);
  other = set;
  std::swap(other.triangles[1], other.triangles[2]);
  add(other);
  other = set;
  other.triangles.pop_back();
  add(other);
  EXPECT_EQ(keys.size(), 4u);
}

/// Whatever the bytes of an order say, it is refused or the tree holds every triangle once.
TEST(TreeFile, AnOrderThatIsNoTreeIsRefused) {
  const TreeTriangles set = make_triangles(300);
  const trees::BvhOrder good = trees::order_of(set.bvh());
  const auto refused = [&](const auto& change) {
    trees::BvhOrder order = good;
    change(order);
    return !set.ordered(order);
  };
  EXPECT_TRUE(set.ordered(good));
  EXPECT_TRUE(refused([](auto& order) { order.triangles[3] = order.triangles[4]; })) << "twice";
  EXPECT_TRUE(refused([](auto& order) { order.triangles[3] = 0xffffffffu; })) << "none";
  EXPECT_TRUE(refused([](auto& order) { order.triangles[3] = 6; })) << "one without an area";
  EXPECT_TRUE(refused([](auto& order) { order.triangles.pop_back(); }));
  EXPECT_TRUE(refused([](auto& order) { order.children.pop_back(); }));
  EXPECT_TRUE(refused([](auto& order) { order.children.resize(order.children.size() + 8, 0); }));
  EXPECT_TRUE(refused([](auto& order) { order.children.clear(); }));
  EXPECT_TRUE(refused([](auto& order) { std::fill(order.children.begin(), order.children.end(), 0xff); }));
  EXPECT_TRUE(refused([](auto& order) { std::fill(order.children.begin(), order.children.end(), 9); }));
  const auto chain = [](auto& order) {
    order.children.assign(8 * 1000, 0);
    for (std::size_t n = 0; n < 1000; ++n) order.children[8 * n] = trees::BvhOrder::node;
  };
  EXPECT_TRUE(refused(chain)) << "too many levels";
  Random random(5);
  for (int i = 0; i < 2000; ++i) {
    trees::BvhOrder order = good;
    order.children[random.index(static_cast<std::uint32_t>(order.children.size()))] =
        static_cast<std::uint8_t>(random.index(256));
    const auto tree = set.ordered(order);
    if (tree) {
      EXPECT_EQ(tree->triangles, good.triangles.size());
    }
  }
}

TEST(KeptTrees, AreReadInTheNextProcessAndMadeAnewWhereDamaged) {
  const TemporaryFolder folder;
  const TreeTriangles set = make_triangles(5000);
  const trees::TriangleBvh expected = set.bvh();
  const auto path = ao::tree_path(folder.path(), ao::tree_key(set.positions, set.triangles));
  const auto make = [&] {
    ao::KeptTrees trees{folder.path(), {}, false};
    EXPECT_TRUE(same(*trees.make(set.positions, set.triangles, nullptr), expected));
    return trees.notes;
  };
  EXPECT_TRUE(make().empty());
  ASSERT_TRUE(fs::is_regular_file(path));
  const std::string whole = read_text(path);
  EXPECT_TRUE(make().empty());
  for (const std::size_t size : {std::size_t{0}, std::size_t{40}, whole.size() / 2, whole.size() - 1}) {
    write_text(path, whole.substr(0, size));
    EXPECT_EQ(make().size(), 1u) << size << " bytes";
    EXPECT_EQ(read_text(path), whole) << "made anew";
  }
  std::string changed = whole;
  changed[changed.size() / 2] ^= 1;
  write_text(path, changed);
  EXPECT_EQ(make().size(), 1u);
}

TEST(KeptTrees, SayOnceThatAFolderTakesNoFiles) {
  const TemporaryFolder folder;
  write_text(folder.path() / "file", "not a folder");
  ao::KeptTrees trees{folder.path() / "file", {}, false};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const TreeTriangles set = make_triangles(3000, seed);
    EXPECT_TRUE(same(*trees.make(set.positions, set.triangles, nullptr), set.bvh()));
  }
  EXPECT_EQ(trees.notes.size(), 1u);
}

TEST(KeptTrees, SmallOnesLeaveNoFile) {
  const TemporaryFolder folder;
  const TreeTriangles set = make_triangles(100);
  ao::KeptTrees trees{folder.path() / "new", {}, false};
  EXPECT_TRUE(same(*trees.make(set.positions, set.triangles, nullptr), set.bvh()));
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

}  // namespace
}  // namespace tenebra
