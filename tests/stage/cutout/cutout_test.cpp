// Triangles in place of alpha: the right ones, without a gap, whatever the picture and how it lies.
#include "stage/cutout/cutout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "stage/cutout/cards.h"
#include "tenebra/threads.h"

namespace tenebra::testing {
namespace {

double cross(glm::dvec2 a, glm::dvec2 b) {
  return a.x * b.y - a.y * b.x;
}

glm::dvec2 flat(glm::vec3 p) {
  return glm::dvec2(p.x, p.y);
}

/// Which triangles hold places of the plane z = 0, by a grid of buckets.
class Cover {
public:
  explicit Cover(const Mesh& mesh) : mesh_(mesh), buckets_(side * side) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      glm::dvec2 low(1e9), high(-1e9);
      for (int k = 0; k < 3; ++k) {
        low = glm::min(low, flat(mesh.positions[mesh.triangles[t][k]]));
        high = glm::max(high, flat(mesh.positions[mesh.triangles[t][k]]));
      }
      for (int y = bucket(low.y); y <= bucket(high.y); ++y)
        for (int x = bucket(low.x); x <= bucket(high.x); ++x)
          buckets_[static_cast<std::size_t>(y * side + x)].push_back(t);
    }
  }

  int count(glm::dvec2 p) const {
    int found = 0;
    for (const std::uint32_t t : buckets_[static_cast<std::size_t>(bucket(p.y) * side + bucket(p.x))]) {
      const glm::uvec3& v = mesh_.triangles[t];
      const glm::dvec2 a = flat(mesh_.positions[v.x]), b = flat(mesh_.positions[v.y]),
                       c = flat(mesh_.positions[v.z]);
      const double x = cross(b - a, p - a), y = cross(c - b, p - b), z = cross(a - c, p - c);
      found += (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
    }
    return found;
  }

private:
  static constexpr int side = 128;
  static int bucket(double at) { return std::clamp(static_cast<int>(at * side), 0, side - 1); }
  const Mesh& mesh_;
  std::vector<std::vector<std::uint32_t>> buckets_;
};

double area_of(const Mesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles)
    sum += 0.5 * cross(flat(mesh.positions[t.y]) - flat(mesh.positions[t.x]),
                       flat(mesh.positions[t.z]) - flat(mesh.positions[t.x]));
  return sum;
}

/// Places of the card; coordinates of its texture there.
struct Place {
  glm::dvec2 at;
  glm::vec2 uv;
};
Place place_at(const Scene& scene, double x, double y) {
  const auto& uv = scene.meshes[0].texture_coordinates[0];
  const glm::dvec2 low(uv[0]), high(uv[2]);
  return {{x, y}, glm::vec2(low + (high - low) * glm::dvec2(x, y))};
}

struct Judgement {
  int samples = 0;
  int wrong = 0;
  int near_line = 0;  ///< on the other side, within the tolerance
  int twice = 0;      ///< under two triangles
};

Judgement judge(const Scene& whole, const Scene& cut, double tolerance_px = 0.125, int samples = 40000) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  const Cover cover(cut.meshes[0]);
  Judgement result;
  for (int i = 0; i < samples; ++i) {
    const Place place = place_at(whole, unit(random), unit(random));
    const int count = cover.count(place.at);
    ++result.samples;
    result.twice += count > 1;
    if ((count > 0) == (alpha_over(whole, place.uv) >= 0)) continue;
    // 1 % more: a sample in float, rings of 48 directions.
    if (is_near_line(whole, place.uv, tolerance_px * 1.02 + 0.002)) {
      ++result.near_line;
    } else {
      ++result.wrong;
      if (result.wrong <= 3)
        ADD_FAILURE() << "at " << place.at.x << " " << place.at.y << ": " << count << " triangles, alpha "
                      << alpha_over(whole, place.uv);
    }
  }
  return result;
}

/// Every edge inside the card belongs to one triangle (at the line) or to two that run along it in opposite
/// directions; an edge of one triangle lies on the level line or on the card's border: so nowhere do two
/// triangles touch along parts of an edge.
void expect_watertight(const Scene& whole, const Scene& cut) {
  const Mesh& mesh = cut.meshes[0];
  using Ends = std::pair<std::pair<float, float>, std::pair<float, float>>;
  std::map<Ends, int> edges;
  const auto key = [&](std::uint32_t v) { return std::pair(mesh.positions[v].x, mesh.positions[v].y); };
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{key(t[k]), key(t[(k + 1) % 3])}];
  int open = 0;
  for (const auto& [ends, count] : edges) {
    EXPECT_EQ(count, 1) << "an edge is walked twice the same way";
    if (edges.contains({ends.second, ends.first})) continue;
    const glm::dvec2 a(ends.first.first, ends.first.second), b(ends.second.first, ends.second.second);
    const bool border = (a.x == b.x && (a.x == 0 || a.x == 1)) || (a.y == b.y && (a.y == 0 || a.y == 1));
    if (border) continue;
    for (const double u : {0.1, 0.5, 0.9}) {
      const glm::dvec2 at = a + u * (b - a);
      open += !is_near_line(whole, place_at(whole, at.x, at.y).uv, 0.13);
    }
  }
  EXPECT_EQ(open, 0);
}

struct Case {
  const char* name;
  Scene scene;
};

std::vector<Case> cases() {
  std::vector<Case> list;
  const auto add = [&](const char* name, Scene scene) -> Material& {
    list.push_back({name, std::move(scene)});
    return list.back().scene.materials[0];
  };
  add("checker", card(checker(64, 8)));
  add("checker of single pixels", card(checker(16, 1)));
  add("leaf", card(leaf(128)));
  add("fence", card(fence(64)));
  add("noise", card(noise(48, 32, 1)));
  add("noise, low cutoff", card(noise(31, 57, 2))).alpha_cutoff = 0.13f;
  add("noise, factor", card(noise(31, 17, 3))).alpha = 0.7f;
  add("leaf, repeated", card(leaf(32), {-1.3f, 0.2f}, {2.1f, 2.9f}));
  {
    Material& m = add("noise, clamped", card(noise(16, 16, 4), {-0.7f, -0.2f}, {1.6f, 1.9f}));
    m.base_color_map.wrap_u = m.base_color_map.wrap_v = Wrap::clamp_to_edge;
  }
  {
    Material& m = add("noise, mirrored", card(noise(16, 12, 5), {-1.7f, -0.2f}, {1.6f, 2.9f}));
    m.base_color_map.wrap_u = m.base_color_map.wrap_v = Wrap::mirrored_repeat;
  }
  {
    Material& m = add("fence, mixed wraps", card(fence(32), {-1.7f, -0.2f}, {1.6f, 2.9f}));
    m.base_color_map.wrap_u = Wrap::mirrored_repeat;
    m.base_color_map.wrap_v = Wrap::clamp_to_edge;
  }
  add("leaf, turned", card(leaf(64))).base_color_map.transform =
      glm::mat3x2(1.2f, 0.7f, -0.7f, 1.2f, 0.3f, -0.2f);
  add("noise, mirrored by its transform", card(noise(20, 20, 6))).base_color_map.transform =
      glm::mat3x2(-1, 0, 0, 1, 1, 0);
  add("one pixel row", card(noise(64, 1, 8)));
  add("two pixels", card(noise(2, 2, 9), {-1, -1}, {2, 2}));
  add("large noise", card(noise(160, 160, 10)));
  return list;
}

TEST(Cutout, IsWhereAlphaIs) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    Scene cut = c.scene;
    const auto counts = stage::cut_out_masks(cut);
    EXPECT_TRUE(cut.warnings.empty());
    EXPECT_EQ(counts.triangles, 2u);
    EXPECT_EQ(counts.left, cut.meshes[0].triangles.size());
    EXPECT_EQ(cut.materials[0].alpha_mode, AlphaMode::opaque);
    const Judgement found = judge(c.scene, cut);
    EXPECT_EQ(found.wrong, 0);
    EXPECT_EQ(found.twice, 0);
    printf("%-36s %6zu triangles, %d of %d samples within the tolerance\n", c.name, counts.left,
           found.near_line, found.samples);
    expect_watertight(c.scene, cut);
  }
}

/// The card as many triangles in a frame that is not the texture's: jittered squares with either diagonal.
Scene patched(Scene scene, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> jitter(-0.3f, 0.3f);
  Mesh& mesh = scene.meshes[0];
  auto& uv = mesh.texture_coordinates[0];
  const glm::vec2 low = uv[0], high = uv[2];
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const float dx = x > 0 && x < n ? jitter(random) : 0, dy = y > 0 && y < n ? jitter(random) : 0;
      const glm::vec2 at((static_cast<float>(x) + dx) / static_cast<float>(n),
                         (static_cast<float>(y) + dy) / static_cast<float>(n));
      mesh.positions.emplace_back(at, 0.0f);
      uv.push_back(low + (high - low) * at);
    }
  }
  mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
  mesh.triangles.clear();
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t y = 0; y + 1 < row; ++y) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t a = first + y * row + x, b = a + 1, c = b + row, d = a + row;
      if (random() % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  mesh.materials.assign(mesh.triangles.size(), 0);
  return scene;
}

TEST(Cutout, RunsAlongThePixelsOfANearestSampler) {
  for (const bool varying : {false, true}) {
    Scene scene = card(noise(9, 7, 3));
    scene.materials[0].base_color_map.magnify = Filter::nearest;
    if (varying) scene.meshes[0].colors = {{1, 1, 1, 1}, {1, 1, 1, 0.5f}, {1, 1, 1, 0.5f}, {1, 1, 1, 1}};
    stage::cut_out_masks(scene);
    const Cover cover(scene.meshes[0]);
    for (int i = 0; i < 9 * 7 * 4; ++i) {
      const int x = i / 4 % 9, y = i / 36;
      const glm::dvec2 at((x + (i % 2 == 0 ? 0.03 : 0.96)) / 9, (y + (i / 2 % 2 == 0 ? 0.04 : 0.97)) / 7);
      const double alpha = scene.images[0].rgba[static_cast<std::size_t>(4 * (9 * y + x) + 3)] / 255.0;
      const double left = alpha * (varying ? 1 - 0.5 * at.x : 1.0) - 0.5;
      if (std::abs(left) < 0.01) continue;
      EXPECT_EQ(cover.count(at), left > 0 ? 1 : 0) << x << " " << y << " " << i % 4;
    }
  }
}

TEST(Cutout, MeetsAcrossEdges) {
  Scene mirrored = card(noise(16, 12, 5), {-1.7f, -0.2f}, {1.6f, 2.9f});
  mirrored.materials[0].base_color_map.wrap_u = Wrap::mirrored_repeat;
  for (const Case& c :
       {Case{"noise", patched(card(noise(160, 160, 10)), 9, 1)}, Case{"leaf", patched(card(leaf(64)), 40, 2)},
        Case{"checker", patched(card(checker(64, 8)), 8, 3)}, Case{"mirrored", patched(mirrored, 7, 4)}}) {
    SCOPED_TRACE(c.name);
    Scene cut = c.scene;
    const auto counts = stage::cut_out_masks(cut);
    const Judgement found = judge(c.scene, cut);
    EXPECT_EQ(found.wrong, 0);
    EXPECT_EQ(found.twice, 0);
    expect_watertight(c.scene, cut);
    printf("%-10s %zu triangles became %zu\n", c.name, counts.triangles, counts.left);
  }
}

TEST(Cutout, FinerToleranceHolds) {
  Scene whole = card(noise(24, 24, 11)), cut = whole;
  stage::cut_out_masks(cut, {.tolerance_px = 1.0 / 32});
  EXPECT_EQ(judge(whole, cut, 1.0 / 32).wrong, 0);
}

TEST(Cutout, AreaIsThatOfTheAlpha) {
  for (const Case& c : {Case{"leaf", card(leaf(256))}, Case{"checker", card(checker(64, 16))},
                        Case{"fence", card(fence(128))}}) {
    Scene cut = c.scene;
    stage::cut_out_masks(cut);
    constexpr int n = 2048;
    int inside = 0;
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) inside += alpha_over(c.scene, {(x + 0.5f) / n, (y + 0.5f) / n}) >= 0;
    const double truth = static_cast<double>(inside) / n / n, area = area_of(cut.meshes[0]);
    printf("%s: area %.5f, alpha's %.5f: %.3f %%\n", c.name, area, truth, 100 * (area / truth - 1));
    EXPECT_NEAR(area / truth, 1.0, 0.005) << c.name;
  }
}

TEST(Cutout, FewTriangles) {
  Scene cut = card(checker(64, 32));
  EXPECT_LE(stage::cut_out_masks(cut).left, 60u);
  Scene soft = card(leaf(512));
  EXPECT_LE(stage::cut_out_masks(soft).left, 500u);
}

TEST(Cutout, SameBitsForAnyThreads) {
  Scene one = card(noise(200, 200, 12)), many = one;
  with_threads(1, [&] { stage::cut_out_masks(one); });
  with_threads(4, [&] { stage::cut_out_masks(many); });
  EXPECT_EQ(one.meshes[0].positions, many.meshes[0].positions);
  EXPECT_EQ(one.meshes[0].triangles, many.meshes[0].triangles);
}

}  // namespace
}  // namespace tenebra::testing
