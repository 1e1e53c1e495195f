// Looking fields up: hits lie where the object is, on every instruction set, under every transform, from
// outside, on and inside the sphere, and whatever the ray.
#include "ao/field/field_lookup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "ao/objects.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;
using testing::chords;
using testing::Object;
using testing::paper;
using testing::Random;

constexpr float nothing_met = std::numeric_limits<float>::infinity();
constexpr SimdLevel levels[] = {SimdLevel::scalar, SimdLevel::sse4, SimdLevel::avx2, SimdLevel::avx512};

/// Distances of sixteen rays; infinity: nothing met.
struct Distances {
  float t[trees::batch_size];
};
Distances look(const ao::FieldInstance& instance, const trees::RayBatch& rays,
               SimdLevel level = SimdLevel::automatic, float limit = nothing_met) {
  Distances d;
  std::fill(d.t, d.t + trees::batch_size, limit);
  ao::field_kernels(level).nearest_hits(instance, {&rays, 1}, d.t);
  return d;
}
float look_one(const ao::FieldInstance& instance, vec3 origin, vec3 direction, float limit = nothing_met) {
  trees::RayBatch rays{};
  rays.set(5, origin, direction);
  const Distances d = look(instance, rays, SimdLevel::automatic, limit);
  for (int i = 0; i < trees::batch_size; ++i)
    EXPECT_TRUE(i == 5 || d.t[i] == limit) << "a lane without a ray";
  return d.t[5];
}

trees::RayBatch random_rays(Random& random, double spread) {
  trees::RayBatch rays;
  for (int i = 0; i < trees::batch_size; ++i)
    rays.set(i, vec3(random.in_cube(spread)), vec3(random.direction()));
  return rays;
}

TEST(FieldLookup, FindsABallWhereItIs) {
  const Object ball = testing::ball({3, -2, 1}, vec3(2), 24);
  for (const FieldLayout layout : {paper, chords}) {
    for (const int bits : {8, 32}) {
      const ao::DisplacementField field = ball.field({layout, 1225, 784, bits});
      const ao::FieldInstance instance = *ao::place_field(field, nullptr, dmat4(1));
      // Through the middle, from outside, from on the sphere, from far away.
      for (const double from : {2.001, 2.5, 5.0, 100.0}) {
        Random random(1);
        for (int i = 0; i < 200; ++i) {
          const dvec3 d = random.direction();
          EXPECT_NEAR(look_one(instance, vec3(dvec3(3, -2, 1) - from * d), vec3(d)), from - 2,
                      0.05 + 1e-5 * from);
        }
      }
      EXPECT_EQ(look_one(instance, {3, 0.2f, 1}, {0, 1, 0}), nothing_met);  // looks away
      EXPECT_EQ(look_one(instance, {3, 0.2f, 1}, {1, 0, 0}), nothing_met);  // passes above
      EXPECT_EQ(look_one(instance, {30, -2, 1}, {1, 0, 0}), nothing_met);
    }
  }
}

TEST(FieldLookup, GivesTheSameBitsOnEveryInstructionSet) {
  Random random(2);
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  const dmat4 world = glm::rotate(glm::translate(dmat4(1), dvec3(0.3, 0.1, -0.2)), 0.7, dvec3(1, 2, 3));
  for (const FieldLayout layout : {paper, chords}) {
    for (const int bits : {1, 8, 32}) {
      const ao::DisplacementField field = object.field({layout, 625, 625, bits});
      for (const trees::TriangleBvh* near : {static_cast<const trees::TriangleBvh*>(nullptr), &bvh}) {
        for (const ao::FieldEnds ends : {ao::FieldEnds::first, ao::FieldEnds::both}) {
          const ao::FieldInstance instance = *ao::place_field(field, near, world, ends);
          for (int i = 0; i < 300; ++i) {
            const trees::RayBatch rays = random_rays(random, i % 2 ? 3 : 1);
            const Distances expected = look(instance, rays, SimdLevel::scalar, i % 3 ? nothing_met : 1.0f);
            for (const SimdLevel level : levels) {
              if (!simd_level_supported(level)) continue;
              const Distances found = look(instance, rays, level, i % 3 ? nothing_met : 1.0f);
              ASSERT_TRUE(std::equal(found.t, found.t + trees::batch_size, expected.t))
                  << simd_level_name(level);
            }
          }
        }
      }
    }
  }
}

TEST(FieldLookup, OneFieldServesAllInstances) {
  // Distances along the ray go with the ray: to move, turn, scale, stretch or mirror object and ray alike
  // changes nothing but the scale.
  Random random(3);
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  const ao::DisplacementField field = object.field();
  const dmat4 moved = glm::translate(dmat4(1), dvec3(5, -7, 11));
  const dmat4 turned = glm::rotate(moved, 2.1, glm::normalize(dvec3(1, 2, -3)));
  dmat4 sheared = turned;
  sheared[1] += 0.5 * sheared[0];
  for (const trees::TriangleBvh* near : {static_cast<const trees::TriangleBvh*>(nullptr), &bvh}) {
    const ao::FieldInstance here = *ao::place_field(field, near, dmat4(1));
    for (const dmat4& world :
         {moved, turned, glm::scale(turned, dvec3(1000)), glm::scale(dmat4(1), dvec3(1e-4)) * turned,
          glm::scale(turned, dvec3(1, 3, 0.2)), glm::scale(turned, dvec3(-1, 1, 1)), sheared}) {
      const ao::FieldInstance there = *ao::place_field(field, near, world);
      int hits = 0, differ = 0;
      for (int i = 0; i < 2000; ++i) {
        const dvec3 o = random.in_cube(2), d = random.direction();
        const dvec3 moved_d(world * glm::dvec4(d, 0));
        const double scale = glm::length(moved_d);  // world units per object unit along this ray
        const float t = look_one(here, vec3(o), vec3(d));
        const float u = look_one(there, vec3(world * glm::dvec4(o, 1)), vec3(moved_d / scale));
        // Rounding moves a few rays over the border of a cell.
        differ += std::isinf(t) != std::isinf(u) || (t < nothing_met && std::abs(u / scale - t) > 0.01);
        hits += t < nothing_met;
      }
      EXPECT_GT(hits, 80);
      EXPECT_LE(differ, 6);
    }
  }
}

TEST(FieldLookup, TakesDirectionsOfAnyLength) {
  const ao::DisplacementField field = testing::table().field();
  const ao::FieldInstance instance = *ao::place_field(field, nullptr, dmat4(1));
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const vec3 o(random.in_cube(2)), d(random.direction());
    const float t = look_one(instance, o, d),
                u = look_one(instance, o, 4.0f * d);  // a power of two: no rounding
    EXPECT_EQ(u, t / 4);
  }
}

TEST(FieldLookup, NeverCrossesWhatWasFoundBefore) {
  const ao::DisplacementField field = testing::table().field();
  const ao::FieldInstance instance = *ao::place_field(field, nullptr, dmat4(1));
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const trees::RayBatch rays = random_rays(random, 2);
    const Distances all = look(instance, rays);
    for (const float limit : {0.0f, 0.3f, 1.0f, 5.0f}) {
      const Distances some = look(instance, rays, SimdLevel::automatic, limit);
      for (int k = 0; k < trees::batch_size; ++k) EXPECT_EQ(some.t[k], std::min(limit, all.t[k]));
    }
  }
}

TEST(FieldLookup, IsNeverNanOrNegative) {
  Random random(6);
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  const float odd[] = {0.0f,  -0.0f, 1e-42f,      1e-20f,       1.0f, -1.0f,
                       1e20f, 3e38f, nothing_met, -nothing_met, NAN};
  for (const FieldLayout layout : {paper, chords}) {
    for (const int bits : {1, 8, 32}) {
      const ao::DisplacementField field = object.field({layout, 100, 100, bits});
      for (const dmat4& world :
           {dmat4(1), glm::scale(dmat4(1), dvec3(1e-15)), glm::scale(dmat4(1), dvec3(1e15))}) {
        const ao::FieldInstance instance = *ao::place_field(field, &bvh, world);
        for (int i = 0; i < 2000; ++i) {
          trees::RayBatch rays = random_rays(random, 1);
          for (int k = 0; k < trees::batch_size; ++k) {
            float* lanes[] = {rays.ox, rays.oy, rays.oz, rays.dx, rays.dy, rays.dz};
            lanes[random.index(6)][k] = odd[random.index(11)];
            if (random.chance(0.3)) lanes[random.index(6)][k] = odd[random.index(11)];
          }
          const Distances found = look(instance, rays);
          for (int k = 0; k < trees::batch_size; ++k) {
            ASSERT_GE(found.t[k], 0.0f);
            const vec3 o = rays.origin(k), d = rays.direction(k);
            if (!std::isfinite(o.x + o.y + o.z + d.x + d.y + d.z) || d == vec3(0)) {
              ASSERT_EQ(found.t[k], nothing_met);
            }
          }
        }
      }
    }
  }
}

TEST(FieldLookup, PlacesOnlyWhatHasVolume) {
  const ao::DisplacementField field = testing::table().field({chords, 16, 16, 8});
  EXPECT_FALSE(ao::place_field(field, nullptr, glm::scale(dmat4(1), dvec3(1, 0, 1))));
  EXPECT_FALSE(ao::place_field(field, nullptr, dmat4(0)));
  EXPECT_FALSE(ao::place_field(field, nullptr, glm::scale(dmat4(1), dvec3(NAN))));
  EXPECT_TRUE(ao::place_field(field, nullptr, glm::scale(dmat4(1), dvec3(1e-10))));
}

TEST(FieldLookup, KnowsTheSphereThatHoldsTheInstance) {
  Random random(7);
  const Object object = testing::table();
  const ao::DisplacementField field = object.field({chords, 16, 16, 8});
  for (int i = 0; i < 100; ++i) {
    dmat4 world(1);
    for (int k = 0; k < 3; ++k) world[k] = glm::dvec4(random.in_cube(2), 0);
    world[3] = glm::dvec4(random.in_cube(10), 1);
    const auto instance = ao::place_field(field, nullptr, world);
    ASSERT_TRUE(instance);
    for (const vec3 p : object.positions) {
      const dvec3 q(world * glm::dvec4(p, 1));
      EXPECT_LE(glm::length(q - instance->world.centre), instance->world.radius * 1.000001);
    }
  }
  const auto turned =
      ao::place_field(field, nullptr, glm::scale(glm::rotate(dmat4(1), 1.0, dvec3(0, 0, 1)), dvec3(3)));
  const dvec3 axes = field.bound.axes;
  EXPECT_NEAR(turned->world.radius, 3 * std::max({axes.x, axes.y, axes.z}), 1e-6);
}

TEST(FieldLookup, SeesFromInsideTheSphere) {
  // Between the table's legs, below its plate. The paper's first hit along the chord is behind, under the
  // floor, beside: nothing.
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  const ao::DisplacementField field = object.field();
  const ao::FieldInstance both = *ao::place_field(field, nullptr, dmat4(1));
  const ao::FieldInstance cast = *ao::place_field(field, &bvh, dmat4(1));
  const ao::FieldInstance first = *ao::place_field(field, nullptr, dmat4(1), ao::FieldEnds::first);
  EXPECT_NEAR(look_one(both, {0, 0.3f, 0}, {0, 1, 0}), 0.4f, 0.02f);      // the plate
  EXPECT_EQ(look_one(both, {0, 0.3f, 0}, {0, -1, 0}), nothing_met);       // the floor is not the table's
  EXPECT_EQ(look_one(both, {0, 0.9f, 0}, {0, 1, 0}), nothing_met);        // from above the plate upwards
  EXPECT_NEAR(look_one(both, {0, 0.9f, 0}, {0, -1, 0}), 0.1f, 0.02f);     // and back
  EXPECT_NEAR(look_one(both, {0, 0.3f, 0.45f}, {1, 0, 0}), 0.9f, 0.15f);  // the right leg; the left is behind
  EXPECT_EQ(look_one(first, {0, 0.3f, 0.45f}, {1, 0, 0}), nothing_met);
  EXPECT_NEAR(look_one(cast, {0.001f, 0.699f, 0.0f}, {0, 1, 0}), 0.001f, 1e-5f);  // contact, by casting
  EXPECT_NEAR(look_one(both, {0.001f, 0.699f, 0.0f}, {0, 1, 0}), 0.001f, 0.02f);  // and by the field
}

TEST(FieldLookup, AnswersManyBatchesAsItDoesOne) {
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  Random random(9);
  std::vector<trees::RayBatch> rays;  // inside and outside, and some that meet nothing
  for (int i = 0; i < 23; ++i)
    rays.push_back(i % 5 == 2 ? trees::RayBatch{} : random_rays(random, i % 3 + 0.7));
  const auto nearest_hits = ao::field_kernels(SimdLevel::automatic).nearest_hits;
  for (const FieldLayout layout : {paper, chords}) {
    const ao::DisplacementField field = object.field({layout, 400, 256, 8});
    const ao::FieldInstance instance = *ao::place_field(field, &bvh, dmat4(1));
    for (std::size_t count = 0; count <= rays.size(); ++count) {
      std::vector<float> all(rays.size() * trees::batch_size, 2.0f), single = all;
      const int casts = nearest_hits(instance, {rays.data(), count}, all.data());
      int casts_of_single = 0;
      for (std::size_t b = 0; b < count; ++b)
        casts_of_single += nearest_hits(instance, {&rays[b], 1}, single.data() + b * trees::batch_size);
      EXPECT_EQ(all, single) << count;
      EXPECT_EQ(casts, casts_of_single) << count;
      if (count == rays.size()) {
        EXPECT_LT(*std::min_element(all.begin(), all.end()), 2.0f);
      }
    }
  }
}

TEST(FieldLookup, CastsOnlyRaysThatStartCloseToTheObject) {
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  const ao::DisplacementField field = object.field();
  const ao::FieldInstance instance = *ao::place_field(field, &bvh, dmat4(1));
  const auto casts = [&](vec3 origin) {
    trees::RayBatch rays{};
    float distance[trees::batch_size];
    std::fill(distance, distance + trees::batch_size, nothing_met);
    rays.set(0, origin, {0, 1, 0});
    return ao::field_kernels(SimdLevel::automatic).nearest_hits(instance, {&rays, 1}, distance);
  };
  EXPECT_EQ(casts({0, -3, 0}), 0);
  EXPECT_EQ(casts({0, 0.3f, 0}), 0);
  EXPECT_EQ(casts({0, 0.69f, 0}), 1);
  EXPECT_EQ(casts({0.85f, 0.3f, 0.39f}), 1);
}

}  // namespace
}  // namespace tenebra
