// tenebra-bench ao as a program, and the parts of it that others rest on: rays, objects, receivers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>

#include "bench/ao/ao_moving.h"
#include "bench/ao/ao_peer.h"
#include "bench/ao/ao_receivers.h"
#include "io/image.h"
#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::bench {
namespace {

testing::ProgramResult ao(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {TENEBRA_BENCH, "ao"});
  return testing::run_program(arguments);
}

void expect_ao_refusal(const std::vector<std::string>& arguments, const std::string& sentence) {
  const auto result = ao(arguments);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_LT(result.exit_code, 128) << "ended by a signal";
  EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
}

constexpr const char* last_lines[] = {
    "ao.outside_rms_255",     "ao.paper_rms_255",         "ao.inside_rms_255",
    "ao.surface_rms_255",     "ao.lookup_speedup",        "ao.frame_speedup",
    "ao.frame_speedup_half",  "ao.growth_1k_to_1m",       "ao.bytes",
    "ao.scene_rms_worst",     "ao.scene_p99_worst",       "ao.scene_max_worst",
    "ao.exact_rms_worst",     "ao.exact_max_worst",       "ao.scene_speedup_geomean",
    "ao.scene_speedup_worst", "ao.exact_speedup_geomean", "ao.first_frame_warm",
    "ao.flicker_mean_255",    "ao.estimate_worst"};

TEST(AoBench, RefusesInASentence) {
  expect_ao_refusal({"--bogus"}, "--bogus");
  expect_ao_refusal({"--threads", "-1"}, "--threads: found -1, expected 0 (all cores) or more");
  expect_ao_refusal({"--data", "/nowhere/at/all"}, "--data: /nowhere/at/all is not a folder");
  expect_ao_refusal({"--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  expect_ao_refusal({"--only", "atlantis"}, "--only: found atlantis, expected");
}

TEST(AoBench, ATinyRunNamesWhatIsMissingAndEndsWithTheFigures) {
  const testing::TemporaryFolder folder;
  const auto result = ao({"--tiny", "--data", folder.path().string(), "--csv", (folder / "ao.csv").string()});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* missing :
       {"bunny is left out", "FlightHelmet is left out", "spot.obj is missing", "museum5 20 is left out"})
    EXPECT_NE(result.output.find(missing), std::string::npos) << missing;
  std::size_t at = 0;
  for (const char* name : last_lines) {
    at = result.output.find(std::string("\n") + name + ": ", at);
    ASSERT_NE(at, std::string::npos) << name << " in its place";
    const double value = std::strtod(result.output.c_str() + at + std::strlen(name) + 3, nullptr);
    EXPECT_TRUE(std::isfinite(value)) << name;
  }
  EXPECT_EQ(result.output.find('\n', at + 1), result.output.size() - 1) << "nothing follows the last line";

  const std::string csv = testing::read_text(folder / "ao.csv");
  for (const char* row :
       {"figure6,robot head", "memory,robot head", "surface,robot head", "figure8,knot", "lookups,flake",
        "frames,far view", "flicker,city", "scenes,crowd near 64,default", "scenes,crowd near 64,embree"}) {
    EXPECT_NE(csv.find(row), std::string::npos) << row;
  }
  EXPECT_NE(testing::read_text(folder / "ao_figure8.svg").find("</svg>"), std::string::npos);
  EXPECT_TRUE(io::read_png(folder / "ao_figure6_robot_head_chords.png").has_value());
}

TEST(AoBench, PartsThatAreLeftOutAreNotNumbers) {
  const auto result = ao({"--tiny", "--only", "growth"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("\nao.outside_rms_255: not measured\n"), std::string::npos);
  EXPECT_EQ(result.output.find("\nao.growth_1k_to_1m: not measured\n"), std::string::npos);
}

/// Below half of a plane that closes the upper half of the sky, occlusion is what the integral says.
TEST(AoRays, MeetTheIntegralsOfAPlane) {
  const Object plane{"plane",
                     {{-1e4f, 1, -1e4f}, {-1e4f, 1, 1e4f}, {1e4f, 1, 1e4f}, {1e4f, 1, -1e4f}},
                     {{0, 1, 2}, {0, 2, 3}}};
  const AoPeer peer(plane);
  const CosineRays rays(4096, 1);
  const Receiver up{{0, 0, 0}, {0, 1, 0}}, sideways{{0, 0, 0}, {1, 0, 0}};
  // Up: t = 1 / cos, hidden 1 - t / D for cos >= 1 / D, density 2 cos: (1 - 1/D)^2.
  constexpr float reach = 4;
  for (const auto& tracer : {peer.single_rays(), peer.packets(false), peer.packets(true)}) {
    const auto hidden = occlusion(std::vector{up}, rays, reach, tracer);
    EXPECT_NEAR(hidden[0], (1 - 1 / reach) * (1 - 1 / reach), 2e-3);
    // Sideways: half of the rays go up; with no fall-off to speak of, half is hidden.
    EXPECT_NEAR(occlusion(std::vector{sideways}, rays, 1e8f, tracer)[0], 0.5, 2e-3);
  }
}

/// Both directions of every edge once: closed and turned outwards (positive volume).
void expect_closed(const Object& object) {
  std::map<std::pair<unsigned, unsigned>, int> edges;
  double volume = 0;
  for (const glm::uvec3& t : object.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    const glm::dvec3 a = object.positions[t.x], b = object.positions[t.y], c = object.positions[t.z];
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume, 0);
}

TEST(AoObjects, AreClosedAndTurnedOutwards) {
  const Object flake = make_flake(2), knot = make_knot(64, 8), finer = subdivided(knot, 1);
  EXPECT_EQ(flake.triangles.size(), 720u);
  EXPECT_EQ(knot.triangles.size(), 1024u);
  EXPECT_EQ(finer.triangles.size(), 4096u);
  for (const Object& object : {flake, knot, finer}) expect_closed(object);
}

TEST(AoReceivers, LieWhereTheySay) {
  const Object knot = make_knot(64, 8);
  const AoPeer peer(knot);
  const Ball ball{{0, 0, 0}, 3.6};
  for (const Receiver& r : corner_receivers(ball))
    EXPECT_GT(glm::length(glm::dvec3(r.position)), ball.radius);
  for (const Receiver& r : floor_receivers(knot, ball))
    EXPECT_LT(glm::length(glm::dvec3(r.position)), ball.radius);
  for (const Receiver& r : air_receivers(ball, peer, 100, 1)) {
    EXPECT_LT(glm::length(glm::dvec3(r.position)), ball.radius);
    // Within the tube every ray leaves through a back face.
    const PeerHit hit = peer.nearest(r.position, {0.36f, 0.48f, 0.8f});
    if (std::isfinite(hit.distance)) {
      EXPECT_LT(glm::dot(hit.normal, glm::vec3(0.36f, 0.48f, 0.8f)), 0.0f);
    }
  }
  for (const SurfacePoint& p : surface_points(knot, 100, 1)) {
    const glm::vec3 above = p.at.position + 1e-3f * p.at.normal;
    EXPECT_NEAR(peer.nearest(above, -p.at.normal).distance, 1e-3f, 1e-4f);
  }
}

TEST(AoMoving, FindsWhatMovesAndHowNear) {
  FrameGeometry now, next;
  now.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {5, 0, 0}, {6, 0, 0}, {5, 0, 1}};
  now.triangles = {{0, 1, 2}, {3, 4, 5}};
  next = now;
  for (int i = 3; i < 6; ++i) next.positions[static_cast<std::size_t>(i)].y += 0.5f;
  const MovingTriangles moving(now, next);
  EXPECT_EQ(moving.moves(), (std::vector<bool>{false, true}));
  EXPECT_TRUE(moving.within({5.2, 1.4, 0.2}, 1));  // 0.9 above where it comes to lie
  EXPECT_FALSE(moving.within({5.2, 1.6, 0.2}, 1));
  EXPECT_TRUE(moving.within({5.2, -0.9, 0.2}, 1));  // below where it lay
  EXPECT_TRUE(moving.within({4.1, 0, 0}, 1));       // beside a corner
  EXPECT_FALSE(moving.within({3.9, 0, 0}, 1));
  EXPECT_FALSE(moving.within({0.1, 0, 0.1}, 1));  // on the one that stands
}

}  // namespace
}  // namespace tenebra::bench
