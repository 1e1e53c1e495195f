// Checks what the shafts give to each group against exact arithmetic on lines from its points to the light.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "oracle/triangle_boxes.h"
#include "parallel/parallel.h"
#include "reference/exact_segment.h"
#include "soft/group_case.h"
#include "soft/shafts/shafts.h"

namespace tenebra::testing {

/// What a group was given.
struct Given {
  soft::GroupClass kind = soft::GroupClass::lit;
  std::vector<std::uint32_t> candidates;
  std::uint32_t from_middle = 0;
  bool operator==(const Given&) const = default;
};

inline soft::PointGroups grouped(const GroupCase& c, SoftGrouping grouping = SoftGrouping::neighbourhood) {
  soft::PointGroups groups;
  soft::group_points(seen_from(c.points, c.view), c.soup.view(), c.light, grouping, groups);
  return groups;
}

/// One for each group; each group must be handed over exactly once.
inline std::vector<Given> given(const GroupCase& c, const soft::PointGroups& groups,
                                SimdLevel simd = SimdLevel::automatic, soft::ShaftStats* stats = nullptr) {
  std::vector<Given> all(groups.groups.size());
  std::vector<int> calls(all.size(), 0);
  soft::ShaftCuller culler;
  SoftShadowConfig config;
  config.simd = simd;
  config.error_255 = 1;  // candidates are counted from the middle, too
  EXPECT_TRUE(culler.for_each_family(groups, c.soup.view(), c.light, config, nullptr,
                                     [&](std::span<const soft::GroupDecision> family, int thread) {
                                       for (const auto& [group, kind, candidates, from_middle] : family) {
                                         const auto i =
                                             static_cast<std::size_t>(group - groups.groups.data());
                                         all[i] = {kind, {candidates.begin(), candidates.end()}, from_middle};
                                         ++calls[i];
                                       }
                                       EXPECT_LT(thread, thread_count());
                                     }));
  EXPECT_EQ(std::count(calls.begin(), calls.end(), 1), static_cast<std::ptrdiff_t>(calls.size()));
  if (stats != nullptr) *stats = culler.stats();
  return all;
}

/// A line that the rule asks about: from a point in front of the light to a point of it on the seen side; of
/// a sun to a place in its direction, beyond all triangles.
struct Line {
  glm::dvec3 p, q;
  std::uint32_t receiver;
};

/// Sums over the comparisons of a test.
struct Tally {
  std::uint64_t lines = 0, blocked = 0, dropped = 0, kept = 0, lit = 0, dark = 0, mixed = 0;
  void print(const char* what) const {
    std::printf(
        "%s: %llu lines, blocked %llu times; pairs of group and caster: %llu dropped, %llu kept; "
        "groups: %llu lit, %llu dark, %llu mixed\n",
        what, static_cast<unsigned long long>(lines), static_cast<unsigned long long>(blocked),
        static_cast<unsigned long long>(dropped), static_cast<unsigned long long>(kept),
        static_cast<unsigned long long>(lit), static_cast<unsigned long long>(dark),
        static_cast<unsigned long long>(mixed));
  }
};

/// One case, its groups and what they were given.
class ShaftCheck {
  using dvec3 = glm::dvec3;

public:
  ShaftCheck(const GroupCase& c, SoftGrouping grouping = SoftGrouping::neighbourhood)
      : c_(c), groups_(grouped(c, grouping)), given_(given(c, groups_)), boxes_(c.soup.view(), casters()) {}

  const soft::PointGroups& groups() const { return groups_; }
  const std::vector<Given>& all() const { return given_; }

  /// Every `step`-th group with `lines` random lines and as many that touch an edge or a vertex of a caster.
  void run(Tally& tally, int lines, std::size_t step = 1) {
    Random random(5);
    candidate_.assign(c_.soup.triangles.size(), 0);
    for (std::size_t i = 0; i < given_.size(); i += step) {
      count(given_[i], tally);
      for (const std::uint32_t id : given_[i].candidates) candidate_[id] = 1;
      for (int k = 0; k < 2 * lines; ++k) {
        const auto line =
            k % 2 == 0 ? random_line(groups_.groups[i], random) : aimed_line(groups_.groups[i], random);
        if (line) check(given_[i], *line, tally);
        if (::testing::Test::HasFatalFailure()) return;
      }
      for (const std::uint32_t id : given_[i].candidates) candidate_[id] = 0;
    }
  }

private:
  bool casts(std::uint32_t id) const { return c_.soup.casts.empty() || c_.soup.casts[id] != 0; }
  std::vector<std::uint32_t> casters() const {
    std::vector<std::uint32_t> ids(c_.soup.triangles.size());
    std::iota(ids.begin(), ids.end(), 0u);
    std::erase_if(ids, [&](std::uint32_t id) { return !casts(id); });
    return ids;
  }

  void count(const Given& g, Tally& tally) {
    ++(g.kind == soft::GroupClass::lit    ? tally.lit
       : g.kind == soft::GroupClass::dark ? tally.dark
                                          : tally.mixed);
    ASSERT_EQ(g.candidates.empty(), g.kind == soft::GroupClass::lit);
    ASSERT_TRUE(g.kind != soft::GroupClass::dark || g.candidates.size() == 1);
    std::vector<std::uint32_t> sorted = g.candidates;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << "given twice";
    for (const std::uint32_t id : sorted) ASSERT_TRUE(casts(id));
    tally.kept += sorted.size(), tally.dropped += casters().size() - sorted.size();
  }

  std::optional<Line> line_to(const soft::PointGroup& group, std::uint32_t k, const dvec3& q) const {
    const std::uint32_t pixel = groups_.pixels_of(group)[k];
    const Line line{c_.points.positions[pixel], q, c_.points.triangles[pixel]};
    if (!c_.light.at_infinity && !(glm::dot(line.p - c_.light.centre, c_.light.normal) > 0)) return {};
    const int side = points::eye_side(points::corners_of(c_.soup.view(), line.receiver).v, c_.view);
    if (reference::height_sign(points::corners_of(c_.soup.view(), line.receiver), line.q) != side) return {};
    return line;
  }
  std::optional<Line> random_line(const soft::PointGroup& group, Random& random) const {
    const std::uint32_t k = random.index(group.count);
    const dvec3 q = random_light_point(c_.light, random);
    return line_to(group, k, c_.light.at_infinity ? place(group, k) + far() * q : q);
  }
  /// Through a vertex or a point of an edge of a caster, onto the light.
  std::optional<Line> aimed_line(const soft::PointGroup& group, Random& random) const {
    const std::uint32_t k = random.index(group.count);
    const dvec3 p = place(group, k);
    for (int tries = 0; tries < 20; ++tries) {
      const auto id = random.index(static_cast<std::uint32_t>(c_.soup.triangles.size()));
      const auto corner = random.index(3);
      const dvec3 a(c_.soup.corner(id, static_cast<int>(corner)));
      const dvec3 b(c_.soup.corner(id, static_cast<int>((corner + 1) % 3)));
      const dvec3 x = a + (random.chance(0.3) ? 0.0 : random.unit()) * (b - a);
      const dvec3 to_centre = c_.light.at_infinity ? c_.light.centre : c_.light.centre - p;
      const double t = glm::dot(to_centre, c_.light.normal) / glm::dot(x - p, c_.light.normal);
      if (!(t > (c_.light.at_infinity ? 0 : 1)) || !std::isfinite(t)) continue;
      if (within(c_.light, c_.light.centre + t * (x - p) - to_centre))
        return line_to(group, k, p + (c_.light.at_infinity ? t * far() : t) * (x - p));
    }
    return {};
  }
  dvec3 place(const soft::PointGroup& group, std::uint32_t k) const {
    return c_.points.positions[groups_.pixels_of(group)[k]];
  }
  /// So many lengths of a sun's directions lead beyond all triangles.
  double far() const { return 8 * std::max(soft::largest(c_.soup.low()), soft::largest(c_.soup.high())); }
  static bool within(const AreaLight& light, const dvec3& q) {
    const glm::dvec2 at(glm::dot(q - light.centre, light.ex), glm::dot(q - light.centre, light.ey));
    for (std::size_t k = 0; k < light.polygon.size(); ++k) {
      const glm::dvec2 a = light.polygon[k], e = light.polygon[(k + 1) % light.polygon.size()] - a;
      if (e.x * (at.y - a.y) - e.y * (at.x - a.x) < 0) return false;
    }
    return true;
  }

  void check(const Given& g, const Line& line, Tally& tally) {
    ++tally.lines;
    const TriangleView view = c_.soup.view();
    const auto blocks = [&](std::uint32_t id) {
      return id != line.receiver && reference::blocks(points::corners_of(view, id),
                                                      theta_of(view, id, line.receiver), line.p, line.q);
    };
    if (g.kind == soft::GroupClass::dark) {
      ASSERT_TRUE(blocks(g.candidates[0])) << "not dark: " << describe(line, g.candidates[0]);
      return;
    }
    boxes_.any_of({line.p, line.q - line.p, 1 + 0x1p-40}, [&](std::uint32_t id) {
      if (!blocks(id)) return false;
      ++tally.blocked;
      EXPECT_NE(candidate_[id], 0) << "left out: " << describe(line, id);
      return candidate_[id] == 0;
    });
    ASSERT_FALSE(::testing::Test::HasFailure());
  }

  std::string describe(const Line& line, std::uint32_t id) const {
    std::string text =
        fmt::format("{}: triangle {}, receiver {}, P {:a} {:a} {:a}, Q {:a} {:a} {:a}, corners", c_.name, id,
                    line.receiver, line.p.x, line.p.y, line.p.z, line.q.x, line.q.y, line.q.z);
    for (const glm::vec3& v : points::corners_of(c_.soup.view(), id).v)
      text += fmt::format(" ({:a} {:a} {:a})", v.x, v.y, v.z);
    return text;
  }

  const GroupCase& c_;
  soft::PointGroups groups_;
  std::vector<Given> given_;
  oracle::TriangleBoxes boxes_;
  std::vector<std::uint8_t> candidate_;
};

}  // namespace tenebra::testing
