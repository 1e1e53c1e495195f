#include "formats/placement.h"

#include <gtest/gtest.h>

#include <limits>

namespace tenebra::formats {
namespace {

using glm::dvec3;
using Points = std::vector<dvec3>;

/// Corners of a box 10 x 5 x 8 at `at`.
Points house(const dvec3& at) {
  Points points;
  for (int corner = 0; corner < 8; ++corner)
    points.push_back(at + dvec3(corner & 1 ? 10 : 0, corner & 2 ? 5 : 0, corner & 4 ? 8 : 0));
  return points;
}

dvec3 origin_of(const Points& points, const Points& carriers = {}) {
  return choose_frame({}, {}, points, carriers).origin;
}

TEST(Placement, SubtractsNothingWhereFloatsAreFine) {
  EXPECT_EQ(origin_of(house({0, 0, 0})), dvec3(0));
  EXPECT_EQ(origin_of(house({70, -20, 40})), dvec3(0)) << "the largest coordinate is 8 times the side";
  EXPECT_EQ(origin_of(house({71, -20, 40})), dvec3(80, -20, 40));
  EXPECT_EQ(origin_of({}), dvec3(0));
  EXPECT_EQ(origin_of({dvec3(std::numeric_limits<double>::quiet_NaN())}), dvec3(0));
}

TEST(Placement, SubtractsTheSameFromEqualScenesAtRoundPlaces) {
  for (const double far : {1e3, 1e6, 1e7, -1e9})
    EXPECT_EQ(origin_of(house({far, 0, -far})), dvec3(far, 0, -far));
}

TEST(Placement, SubtractsWholeNumbersNearTheMiddle) {
  EXPECT_EQ(origin_of(house({691234.127, 500.25, 5334567.381})), dvec3(691240, 500, 5334580));
  EXPECT_EQ(origin_of({dvec3(7.3), dvec3(7.31)}), dvec3(7)) << "a small thing";
}

TEST(Placement, PrefersACarrierAsItStands) {
  const Points far = house({691234.25, 0, 5334567});
  EXPECT_EQ(origin_of(far, {dvec3(0), dvec3(691234, 0, 5334567), dvec3(691236, 0, 5334570)}),
            dvec3(691234, 0, 5334567));
  EXPECT_EQ(origin_of(house({0, 0, 0}), {dvec3(1, 2, 3)}), dvec3(0)) << "nothing to mend";
}

TEST(Placement, SeesPastStrayPoints) {
  Points points;
  for (int storey = 0; storey < 20; ++storey)
    for (const dvec3& p : house({691234.127, storey, 5334567.381})) points.push_back(p);
  points.push_back(dvec3(0));
  EXPECT_EQ(origin_of(points), dvec3(691250, 0, 5334550));
  Points room(house({0, 0, 0}));  // most of whose points are those of a small thing in one corner
  for (int i = 0; i < 1000; ++i) room.push_back(dvec3(9, 0, 7) + 1e-4 * i);
  EXPECT_EQ(origin_of(room), dvec3(0));
}

TEST(Placement, IsWhatTheUserSays) {
  const Points far = house({1e6, 0, 0});
  EXPECT_EQ(choose_frame({.offset = OffsetChoice::none}, {}, far).origin, dvec3(0));
  const Placement given{.offset = OffsetChoice::given, .given_offset = {1, 2.5, 3}};
  EXPECT_EQ(choose_frame(given, {}, far).origin, dvec3(1, 2.5, 3));
  const FileFrame frame = choose_frame({.up = UpAxis::y, .metres_per_unit = 0.5}, {UpAxis::z, 2}, {});
  EXPECT_EQ(frame.up, UpAxis::y);
  EXPECT_EQ(frame.metres_per_unit, 0.5);
  EXPECT_EQ(choose_frame({}, {UpAxis::z, 2}, {}).up, UpAxis::z);
}

TEST(FileFrame, GoesThereAndBack) {
  const FileFrame frame{.origin = {100, 200, 10}, .up = UpAxis::z, .metres_per_unit = 0.5};
  EXPECT_EQ(frame.to_scene({104, 206, 18}), dvec3(2, 4, -3));
  EXPECT_EQ(frame.to_file({2, 4, -3}), dvec3(104, 206, 18));
  EXPECT_EQ(frame.direction_to_scene({0, 0, 1}), dvec3(0, 1, 0));
  EXPECT_EQ(frame.direction_to_file({0, 1, 0}), dvec3(0, 0, 1));
}

}  // namespace
}  // namespace tenebra::formats
