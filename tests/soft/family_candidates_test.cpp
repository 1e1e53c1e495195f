// The candidates of a family of groups: which of them, and with which signs, are those of one group.
#include "soft/occluders/family_candidates.h"

#include <gtest/gtest.h>

#include <vector>

namespace tenebra::testing {
namespace {

using Places = std::vector<std::uint32_t>;

Places copy_of(std::span<const std::uint32_t> places) {
  return {places.begin(), places.end()};
}

/// Triangles 2, 5, 7 and 9, of which 5 and 7 are a pair.
soft::GroupCandidates with_pair() {
  soft::GroupCandidates all;
  for (const std::uint32_t triangle : {2u, 5u, 7u, 9u}) {
    soft::Candidate c{};
    c.triangle = triangle;
    c.sign = 1;
    all.all.push_back(c);
  }
  all.all[1].is_quad = true;
  all.all[1].second = 2;
  return all;
}
const Places largest_first = {1, 0, 3};  ///< the pair stands for its second triangle

TEST(FamilyCandidates, AreTheTrianglesOfAllGroupsOnceInOrder) {
  soft::FamilyCandidates family;
  family.add(Places{2, 7});
  family.add(Places{5, 7, 9});
  family.add(Places{});
  EXPECT_EQ(copy_of(family.triangles()), (Places{2, 5, 7, 9}));
  family.clear();
  family.add(Places{1});
  EXPECT_EQ(copy_of(family.triangles()), Places{1});
}

TEST(FamilyCandidates, APairIsChosenForEitherOfItsTriangles) {
  soft::GroupCandidates all = with_pair();
  soft::FamilyCandidates family;
  for (const Places& triangles :
       {Places{5}, Places{7}, Places{5, 7}, Places{2, 9}, Places{2, 7, 9}, Places{4, 6, 8}})
    family.add(triangles);
  EXPECT_EQ(copy_of(family.triangles()), (Places{2, 4, 5, 6, 7, 8, 9}));
  family.make_ready(all, largest_first);
  const auto chosen = [&](std::size_t k) { return copy_of(family.choose(k, {}, all)); };
  EXPECT_EQ(chosen(0), Places{1});
  EXPECT_EQ(chosen(1), Places{1});
  EXPECT_EQ(chosen(2), Places{1});
  EXPECT_EQ(chosen(3), (Places{0, 3}));
  EXPECT_EQ(chosen(4), (Places{1, 0, 3}));
  EXPECT_EQ(chosen(5), Places{});
}

// Triangle 9 lies in y = 0: above it, at 2, it blocks with one sign, below with the other, near it depends.
// A receiver does not block its own points, wherever they lie.
TEST(FamilyCandidates, SignsAreThoseOfTheGroupUntilRestored) {
  soft::GroupCandidates all = with_pair();
  all.heights.push_back({0.0, {0, 1, 0}, 1e-7, 1.0});
  all.all[3].sign = 0;
  soft::FamilyCandidates family;
  family.add(Places{2});
  family.add(Places{9});
  family.make_ready(all, largest_first);
  const auto sign_of_group = [&](double y, const Places& receivers) {
    soft::GroupFrame group;
    group.centre = {0, y, 0}, group.half = glm::dvec3(0.5), group.receivers = receivers;
    EXPECT_EQ(copy_of(family.choose(1, group, all)), Places{3});
    const double sign = all.all[3].sign;
    family.restore(all);
    EXPECT_EQ(copy_of(family.choose(0, group, all)), Places{0});
    EXPECT_EQ(all.all[3].sign, 0);
    EXPECT_EQ(all.all[1].sign, 1);
    return sign;
  };
  EXPECT_EQ(sign_of_group(2, {}), -1);
  EXPECT_EQ(sign_of_group(-2, {}), 1);
  EXPECT_EQ(sign_of_group(0.25, {}), 0);
  EXPECT_EQ(sign_of_group(2, {9}), 0);
  all.axes.turn = -1;
  EXPECT_EQ(sign_of_group(2, {}), 1);
}

}  // namespace
}  // namespace tenebra::testing
