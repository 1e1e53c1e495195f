// Fields: their sizes, what bounds an object, and that the table says what a ray along each chord meets.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "ao/field/displacement_field.h"
#include "ao/field/field_chords.h"
#include "ao/field/near_cells.h"
#include "ao/objects.h"
#include "parallel/parallel.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dvec3;
using glm::vec3;
using testing::chords;
using testing::Object;
using testing::paper;
using testing::Random;

TEST(FieldShape, KeepsToTheMemoryPromised) {
  const auto bytes = [](const ao::FieldSettings& s) {
    return ao::empty_field(s, *ao::field_shape(s)).bytes();
  };  // all
  EXPECT_EQ(ao::field_shape({paper, 4225, 1024, 8})->entries, 4225u * 1024);
  EXPECT_LE(bytes({paper, 4225, 1024, 8}), 4'500'000u);
  EXPECT_LE(bytes({paper, 4225, 1024, 1}), 600'000u);
  EXPECT_EQ(ao::field_shape({chords, 4225, 1024, 8})->position_side, 45);
  EXPECT_LE(bytes({chords, 4225, 1024, 8}), 4'500'000u);
  EXPECT_LE(bytes({chords, 4225, 1024, 1}), 600'000u);
  EXPECT_EQ(ao::field_shape(ao::sparse_field)->position_side, 24);
  EXPECT_LE(ao::field_shape(ao::sparse_field)->bytes, 350'000u);
  EXPECT_LE(bytes(ao::sparse_field), 370'000u);
  EXPECT_EQ(ao::field_shape({paper, 290, 256, 8})->position_side, 17);
}

TEST(FieldShape, RefusesWhatIsOutOfRange) {
  for (const ao::FieldSettings& settings :
       {ao::FieldSettings{paper, 3, 1024, 8}, ao::FieldSettings{paper, 4225, 0, 8},
        ao::FieldSettings{paper, -1, 16, 8}, ao::FieldSettings{paper, 4225, 1024, 16},
        ao::FieldSettings{chords, 1 << 20, 1 << 20, 8}, ao::FieldSettings{paper, 1 << 21, 16, 1},
        ao::FieldSettings{chords, 4225, 1024, 0}}) {
    const auto shape = ao::field_shape(settings);
    ASSERT_FALSE(shape);
    EXPECT_NE(shape.error().message.find("expected"), std::string::npos);
  }
}

TEST(BoundingEllipsoid, HoldsTheObjectTightly) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    Object object;
    const dvec3 size = glm::abs(random.wide(-3, 3)), at = random.wide(-2, 6);
    for (int i = 0; i < 60; ++i) object.positions.emplace_back(at + size * random.direction());
    for (std::uint32_t i = 0; i < 20; ++i) object.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    object.positions.emplace_back(1e6f);  // belongs to no triangle
    for (const FieldLayout layout : {paper, chords}) {
      const ao::Ellipsoid e = ao::bounding_ellipsoid(object.positions, object.triangles, layout);
      double farthest = 0;
      for (std::size_t i = 0; i < 60; ++i)
        farthest = std::max(farthest, glm::length((dvec3(object.positions[i]) - e.centre) / e.axes));
      EXPECT_LE(farthest, 1);
      EXPECT_GT(farthest, 0.98);
      if (layout == paper) {
        EXPECT_EQ(e.axes.x, e.axes.y);
        EXPECT_EQ(e.axes.x, e.axes.z);
        EXPECT_LE(e.axes.x, 1.02 * std::max({size.x, size.y, size.z}));
      }
    }
  }
}

TEST(BoundingEllipsoid, IsNothingWithoutTriangles) {
  EXPECT_EQ(ao::bounding_ellipsoid({}, {}, chords).axes, dvec3(0));
}

double stored_s(const ao::DisplacementField& field, std::size_t entry) {
  if (field.bits == 32) {
    float s;
    std::memcpy(&s, &field.table[4 * entry], 4);
    return s;
  }
  return field.table[entry] == 255 ? ao::no_hit : field.table[entry] / 127.0 - 1;
}

TEST(Field, SaysWhatARayAlongEachChordMeets) {
  const Object object = testing::table();
  const trees::TriangleBvh bvh = object.bvh();
  for (const FieldLayout layout : {paper, chords}) {
    for (const int bits : {8, 32}) {
      const ao::DisplacementField field = object.field({layout, 81, 81, bits});
      int hits = 0;
      for (std::size_t p = 0; p < 81; ++p) {
        for (std::size_t d = 0; d < 81; ++d) {
          const ao::Chord chord = ao::sample_chord(field, p, d);
          const double s = stored_s(field, p * 81 + d), length = glm::length(chord.along);
          // In double against every triangle.
          const dvec3 o = field.bound.centre + field.bound.axes * dvec3(chord.entry);
          const dvec3 direction = field.bound.axes * dvec3(chord.along);
          double nearest = 2, margin = 1;
          for (const glm::uvec3& t : object.triangles) {
            const dvec3 a(object.positions[t.x]), b(object.positions[t.y]), c(object.positions[t.z]);
            const dvec3 n = glm::cross(b - a, c - a);
            const double at = glm::dot(n, a - o) / glm::dot(n, direction);
            const dvec3 q = o + at * direction;
            const double u = glm::dot(glm::cross(c - b, q - b), n) / glm::dot(n, n);
            const double v = glm::dot(glm::cross(a - c, q - c), n) / glm::dot(n, n);
            const double inside = std::min({u, v, 1 - u - v});
            if (!std::isfinite(inside)) continue;
            margin = std::min(margin, std::abs(inside));
            if (inside >= 0 && at >= 0 && at <= 1) nearest = std::min(nearest, at);
          }
          if (margin < 1e-5 && length > 0) continue;
          if (nearest > 1 || length == 0) {
            EXPECT_EQ(s, ao::no_hit);
          } else {
            EXPECT_NEAR(s, (nearest - 0.5) * length, bits == 8 ? 0.5 / 127 + 1e-4 : 1e-4);
            ++hits;
          }
        }
      }
      EXPECT_GT(hits, 1000);
    }
  }
}

TEST(Field, OneBitKeepsTheHitsOfEightAndTheirMean) {
  const Object object = testing::table();
  for (const FieldLayout layout : {paper, chords}) {
    const ao::DisplacementField one = object.field({layout, 49, 81, 1}),
                                whole = object.field({layout, 49, 81, 32});
    const std::size_t positions = whole.shape.positions(), directions = whole.shape.directions();
    for (std::size_t p = 0; p < positions; ++p) {
      double sum = 0;
      int hits = 0;
      for (std::size_t d = 0; d < directions; ++d) {
        const std::size_t entry = p * directions + d;
        const double s = stored_s(whole, entry);
        EXPECT_EQ(one.table[entry / 8] >> entry % 8 & 1, s <= 1);
        if (s <= 1) sum += s, ++hits;
      }
      EXPECT_NEAR(one.mean[p], hits ? sum / hits : 0, 1e-5);
    }
  }
}

TEST(Field, IsTheSameForAnyNumberOfThreads) {
  const Object object = testing::table();
  for (const int bits : {1, 8}) {
    ao::DisplacementField fields[2];
    for (const int threads : {1, 5})
      with_threads(threads, [&] { fields[threads > 1] = object.field({chords, 121, 121, bits}); });
    EXPECT_EQ(fields[0].table, fields[1].table);
    EXPECT_EQ(fields[0].mean, fields[1].mean);
    EXPECT_EQ(fields[0].close, fields[1].close);
  }
}

TEST(Field, DoesNotDependOnTheOrderOfTriangles) {
  Object object = testing::table();
  const ao::DisplacementField before = object.field({chords, 121, 121, 8});
  std::reverse(object.triangles.begin(), object.triangles.end());
  EXPECT_EQ(before.table, object.field({chords, 121, 121, 8}).table);
}

TEST(Field, ReportsProgressAndStops) {
  const Object object = testing::table();
  std::vector<double> seen;
  ASSERT_TRUE(ao::build_field(object.positions, object.triangles, object.bvh(), {},
                              [&](double done) { seen.push_back(done); }));
  EXPECT_GE(seen.size(), 20u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.front(), 0);
  EXPECT_EQ(seen.back(), 1);
  StopFlag stop;
  int calls = 0;
  const auto stopped = ao::build_field(
      object.positions, object.triangles, object.bvh(), {},
      [&](double) {
        if (++calls == 3) stop.request();
      },
      &stop);
  ASSERT_FALSE(stopped);
  EXPECT_TRUE(is_stop(stopped));
  EXPECT_EQ(calls, 3);
}

TEST(NearCells, HoldAllThatIsNearAndLittleElse) {
  Random random(8);
  for (const Object& object : {testing::table(), testing::ball({5, 6, 7}, {1, 2, 3}, 40)}) {
    const ao::Ellipsoid bound = ao::bounding_ellipsoid(object.positions, object.triangles, chords);
    constexpr float reach = 0.03f;
    const std::vector<std::uint32_t> bits = ao::close_cells(object.positions, object.triangles, bound, reach);
    ASSERT_EQ(bits.size(), ao::near_words);
    const auto close = [&](dvec3 unit) {
      const glm::ivec3 c = glm::clamp(glm::ivec3((unit + 1.0) * (ao::near_side / 2.0)), 0, ao::near_side - 1);
      const int place = (c.z * ao::near_side + c.y) * ao::near_side + c.x;
      return (bits[static_cast<std::size_t>(place / 32)] >> place % 32 & 1) != 0;
    };
    const auto in_unit = [&](dvec3 p) { return (p - bound.centre) / bound.axes; };
    for (int i = 0; i < 20000; ++i) {
      const glm::uvec3 t =
          object.triangles[random.index(static_cast<std::uint32_t>(object.triangles.size()))];
      const dvec3 a(object.positions[t.x]), b(object.positions[t.y]), c(object.positions[t.z]);
      const double u = random.unit(), v = (1 - u) * random.unit();
      const dvec3 near = in_unit(a + u * (b - a) + v * (c - a)) + reach * random.unit() * random.direction();
      if (glm::dot(near, near) > 1) continue;
      EXPECT_TRUE(close(near));
    }
    // Nothing within a tenth in any direction: not close.
    const trees::TriangleBvh bvh = object.bvh();
    int far = 0;
    for (int i = 0; i < 2000; ++i) {
      const dvec3 p = random.in_cube(0.57);
      bool free = true;
      for (int k = 0; k < 200 && free; ++k)
        free = !trees::bvh_kernels(SimdLevel::automatic)
                    .any(bvh, {vec3(bound.centre + bound.axes * p), vec3(bound.axes * random.direction()), 0,
                               0.15f});
      if (!free) continue;
      ++far;
      EXPECT_FALSE(close(p));
    }
    EXPECT_GT(far, 100);
  }
}

TEST(Field, RefusesAMeshWithoutArea) {
  const std::vector<vec3> positions{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  const std::vector<glm::uvec3> triangles{{0, 1, 2}};
  EXPECT_FALSE(ao::build_field(positions, triangles, trees::build_triangle_bvh(positions, triangles), {}));
  EXPECT_FALSE(ao::build_field({}, {}, trees::build_triangle_bvh({}, {}), {}));
}

TEST(Field, HoldsASingleFlatTriangle) {
  Object object;
  object.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  object.triangles = {{0, 1, 2}};
  const ao::DisplacementField field = object.field({chords, 121, 121, 8});
  EXPECT_GT(field.bound.axes.z, 0.1);
  EXPECT_GT(std::count_if(field.table.begin(), field.table.end(), [](std::uint8_t s) { return s < 255; }),
            100);
}

}  // namespace
}  // namespace tenebra
