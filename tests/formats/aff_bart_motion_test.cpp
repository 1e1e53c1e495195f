// Where cameras and moving parts of the three BART scenes are, against figures computed by an independent
// evaluator (aff-format.md, 8 and 9).
#include <algorithm>
#include <cmath>

#include <tenebra/frame_geometry.h>
#include "formats/aff_bart.h"
#include "scene/pose.h"

namespace tenebra::testing {
namespace {

struct CameraCase {
  Bart scene;
  int frame;
  double time_s;
  glm::dvec3 position, direction, up;
};

const CameraCase cameras[] = {
    {Bart::museum, 0, -1, {0, 1.8, -9}, {0, 0, 1}, {0, 1, 0}},
    {Bart::museum,
     60,
     0.204013,
     {2.49047, 2.26694, -1.95676},
     {-0.87835, 0.01519, 0.47777},
     {0.02523, 0.99957, 0.01460}},
    {Bart::museum,
     150,
     2.010033,
     {-2.42885, 2.44725, 2.94838},
     {0.73624, -0.18036, -0.65224},
     {0.09555, 0.98188, -0.16365}},
    {Bart::museum,
     216,
     3.334448,
     {-1.48172, 1.40985, -2.55777},
     {0.43782, 0.28390, 0.85306},
     {-0.12149, 0.95881, -0.25674}},
    {Bart::museum,
     299,
     5,
     {0.09517, 1.74933, -5.98824},
     {0.19035, -0.10134, -0.97647},
     {-0.01331, 0.99430, -0.10578}},
    {Bart::kitchen, 0, 0, {3.75, 2.3, 3.6}, {-0.31346, -0.41981, -0.85176}, {-0.12700, 0.90744, -0.40052}},
    {Bart::kitchen,
     100,
     2.503129,
     {3.62211, 1.22569, 1.75345},
     {-0.94668, -0.19720, 0.25477},
     {-0.23782, 0.96122, -0.13966}},
    {Bart::kitchen,
     300,
     7.509387,
     {3.87395, 0.19093, 1.04759},
     {-0.99901, 0.02232, 0.03839},
     {0.02270, 0.99970, 0.00963}},
    {Bart::kitchen,
     456,
     11.414268,
     {2.37779, 0.30963, 1.13823},
     {-0.97969, -0.09825, 0.17481},
     {-0.09126, 0.99469, 0.04764}},
    {Bart::kitchen,
     600,
     15.018773,
     {0.72841, 0.21642, 1.00277},
     {0.90269, -0.17159, 0.39459},
     {0.14797, 0.98491, 0.08980}},
    {Bart::kitchen,
     799,
     20,
     {3.27488, 0.33454, 2.98028},
     {-0.71736, -0.46255, 0.52100},
     {-0.35973, 0.88633, 0.29158}},
    {Bart::robots, 0, 0, {-3.5, 2, -203}, {0.05881, 0.09871, -0.99338}, {-0.00584, 0.99512, 0.09853}},
    {Bart::robots,
     100,
     6.257822,
     {-3.01556, 4.30125, -195.42712},
     {0.07037, -0.08840, -0.99360},
     {0.00261, 0.99608, -0.08843}},
    {Bart::robots,
     208,
     13.016270,
     {-2.15886, 11.29228, -165.32013},
     {-0.98187, -0.11470, 0.15089},
     {-0.12800, 0.98841, -0.08159}},
    {Bart::robots,
     300,
     18.773467,
     {4.33087, 6.00835, -112.99437},
     {0.44418, -0.08379, 0.89201},
     {0.03595, 0.99648, 0.07571}},
    {Bart::robots,
     456,
     28.535670,
     {-0.67030, 5.29835, 55.85385},
     {0.30790, 0.00088, 0.95142},
     {0.02259, 0.99971, -0.00824}},
    {Bart::robots,
     600,
     37.546934,
     {0, 8.97752, 34.93949},
     {0.10642, 0.04461, -0.99332},
     {0.00957, 0.99890, 0.04589}},
    {Bart::robots,
     700,
     43.804756,
     {0, 63.03514, -1.92055},
     {-0.30034, -0.95380, -0.00775},
     {-0.92244, 0.28838, 0.25680}},
    {Bart::robots, 799, 50, {0, 80, 0}, {-0.14145, -0.98505, 0.09829}, {-0.93672, 0.16530, 0.30859}},
};

TEST(AffBart, CameraFollowsItsKeys) {
  for (const CameraCase& c : cameras) {
    SCOPED_TRACE(::testing::Message() << file_of(c.scene) << " frame " << c.frame);
    const Scene& scene = scene_of(c.scene);
    const double time_s = frame_time_s(scene.clips.at(0), c.frame, 30.0);
    EXPECT_NEAR(time_s, c.time_s, 1e-6);
    const ViewRays view = evaluate_camera(scene, 0, time_s, 0, 2, 2);
    const glm::dvec3 forward = glm::normalize(glm::dvec3(view.d0 + view.dx + view.dy));
    const glm::dvec3 up = -glm::normalize(glm::dvec3(view.dy));
    const double tolerance = c.scene == Bart::robots ? 2e-3 : 2e-4;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(view.eye[k], c.position[k], tolerance);
      EXPECT_NEAR(forward[k], c.direction[k], 2e-4);
      EXPECT_NEAR(up[k], c.up[k], 2e-4);
    }
  }
}

struct KeyCase {
  Bart scene;
  const char* block;
  ChannelPath path;
  int frame;
  glm::dvec4 value;  ///< rotations: w x y z, sign free
};

const KeyCase keys[] = {
    {Bart::kitchen, "toycar", ChannelPath::rotation, 200, {0.07040, 0, 0.99752, 0}},
    {Bart::kitchen, "toycar", ChannelPath::rotation, 400, {-0.60988, 0, 0.79250, 0}},
    {Bart::kitchen, "toycar", ChannelPath::rotation, 795, {-0.71208, 0, 0.70209, 0}},
    {Bart::kitchen, "toycar", ChannelPath::translation, 200, {3.74796, 0, 2.74971, 0}},
    {Bart::kitchen, "toycar", ChannelPath::translation, 400, {2.67775, 0, 0.60761, 0}},
    {Bart::kitchen, "toycar", ChannelPath::translation, 795, {2.75240, 0, 3.48265, 0}},
    {Bart::kitchen, "toycar", ChannelPath::scale, 0, {1, 1, 1, 0}},
    {Bart::kitchen, "toycar", ChannelPath::scale, 795, {0.5, 1, 1, 0}},
    {Bart::kitchen, "rotating_wheel_left", ChannelPath::rotation, 286, {0.80349, 0, 0, -0.59532}},
    {Bart::kitchen, "rotating_wheel_left", ChannelPath::rotation, 287, {-0.97148, 0, 0, 0.23711}},
    {Bart::kitchen, "rotating_wheel_left", ChannelPath::rotation, 500, {0.66205, 0, 0, -0.74946}},
    {Bart::robots, "robot_transl1", ChannelPath::translation, 200, {-7.65810, 0, -173.47469, 0}},
    {Bart::robots, "robot_transl1", ChannelPath::translation, 456, {-7.22741, 0, -93.40482, 0}},
    {Bart::robots, "robot_transl1", ChannelPath::translation, 799, {-5, 0, -6, 0}},
    {Bart::robots, "step_transl1", ChannelPath::translation, 200, {-0.03380, 0.02891, 0, 0}},
    {Bart::robots, "step_transl1", ChannelPath::translation, 456, {0.09734, 0.14414, 0, 0}},
    {Bart::robots, "robot_rot1", ChannelPath::rotation, 200, {0.01438, 0, 0.99990, 0}},
    {Bart::robots, "robot_rot1", ChannelPath::rotation, 456, {-0.01077, 0, 0.99994, 0}},
    {Bart::robots, "lo_leg_rot1", ChannelPath::rotation, 200, {0.99805, -0.06249, 0, 0}},
    {Bart::robots, "lo_leg_rot1", ChannelPath::rotation, 456, {0.94855, 0.31663, 0, 0}},
    {Bart::robots, "gun_rot1", ChannelPath::rotation, 456, {0.66640, 0, 0, 0.74560}},
    {Bart::robots, "gun_rot1", ChannelPath::rotation, 770, {-0.95797, 0, 0, -0.28687}},
    {Bart::robots, "grip_rot2", ChannelPath::rotation, 90, {0.92668, -0.26522, 0.21636, 0.15529}},
    {Bart::robots, "grip_rot2", ChannelPath::rotation, 95, {1, 0, 0, 0}},
    {Bart::robots, "grip_rot2", ChannelPath::rotation, 673, {1, 0, 0, 0}},
    {Bart::robots, "head_rot6", ChannelPath::rotation, 506, {0.99890, 0, -0.04584, -0.00965}},
};

glm::dvec4 value_of(const NodePose& pose, ChannelPath path) {
  if (path == ChannelPath::translation) return {pose.translation, 0.0};
  if (path == ChannelPath::scale) return {pose.scale, 0.0};
  return {pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z};
}

TEST(AffBart, KeysInterpolateAsTheAuthorsDo) {
  for (const KeyCase& c : keys) {
    SCOPED_TRACE(::testing::Message() << c.block << " frame " << c.frame);
    const Scene& scene = scene_of(c.scene);
    Pose pose;
    scene::evaluate_pose(scene, 0, frame_time_s(scene.clips.at(0), c.frame, 30.0), pose);
    const auto node = std::find_if(scene.nodes.begin(), scene.nodes.end(),
                                   [&](const Node& n) { return n.name == c.block; });
    ASSERT_NE(node, scene.nodes.end());
    const NodePose& p = pose.nodes[static_cast<std::size_t>(node - scene.nodes.begin())];
    const glm::dvec4 found = value_of(p, c.path);
    const double sign = glm::dot(found, c.value) < 0.0 && c.path == ChannelPath::rotation ? -1.0 : 1.0;
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(sign * found[k], c.value[k], 2e-4) << k;
  }
}

struct FrameCase {
  Bart scene;
  int frame;
  glm::dvec3 low, high, mean;
  double area;
};

const FrameCase frames[] = {
    {Bart::museum,
     0,
     {-0.4604, 1.4484, -0.4754},
     {0.4621, 1.6007, 0.4745},
     {0.0019, 1.5247, -0.0001},
     467.9525},
    {Bart::museum,
     100,
     {-0.5803, 1.5725, -0.5729},
     {0.6203, 4.0042, 0.6240},
     {-0.0066, 2.7810, -0.0005},
     482.2415},
    {Bart::museum,
     299,
     {-0.7500, 1.5000, -0.6000},
     {1.2500, 4.4000, 0.5500},
     {0.5625, 3.0167, -0.0167},
     468.7956},
    {Bart::kitchen, 0, {4.3121, 0, 2.6709}, {4.5761, 0.1378, 2.8293}, {4.4466, 0.0470, 2.7502}, 213.6868},
    {Bart::kitchen,
     300,
     {3.0254, 0.0001, 0.2023},
     {3.2746, 0.1378, 0.4957},
     {3.1511, 0.0470, 0.3512},
     213.6868},
    {Bart::kitchen, 799, {2.6709, 0, 3.3369}, {2.8293, 0.1378, 3.4689}, {2.7502, 0.0470, 3.4017}, 213.6106},
    {Bart::robots,
     0,
     {-58.8073, -0.6198, -239.8072},
     {58.8269, 9.2121, 158.4643},
     {-8.4530, 4.9256, -48.5090},
     1846573.53},
    {Bart::robots,
     300,
     {-24.5127, -0.2752, -156.3637},
     {24.4633, 9.5060, 122.1058},
     {-1.5281, 5.0590, -36.6647},
     1846573.53},
    {Bart::robots,
     799,
     {-21.4936, -0.3996, -16.8041},
     {19.4011, 11.1585, 15.8347},
     {1.4502, 5.0858, 0.0080},
     1846573.53},
};

struct Measured {
  glm::dvec3 low{INFINITY}, high{-INFINITY}, sum{0.0};
  std::size_t corners = 0;
  double area = 0;
};

Measured measure(const Scene& scene, int frame_index) {
  FrameGeometry frame;
  evaluate_frame(scene, 0, frame_time_s(scene.clips.at(0), frame_index, 30.0), frame);
  EXPECT_EQ(frame.dropped_non_finite, 0u);
  Measured m;
  std::size_t t = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].mesh < 0) continue;
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
    const bool moving = moves(scene, static_cast<int>(i));
    for (const std::size_t end = t + mesh.triangles.size(); t < end; ++t) {
      glm::dvec3 p[3];
      for (int k = 0; k < 3; ++k) p[k] = frame.positions[frame.triangles[t][k]];
      if (!is_cone(mesh)) m.area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
      if (!moving) continue;
      for (const glm::dvec3& corner : p) {
        m.low = glm::min(m.low, corner);
        m.high = glm::max(m.high, corner);
        m.sum += corner;
        ++m.corners;
      }
    }
  }
  return m;
}

TEST(AffBart, MovingPartStandsWhereItShould) {
  for (const FrameCase& c : frames) {
    SCOPED_TRACE(::testing::Message() << file_of(c.scene) << " frame " << c.frame);
    const Measured m = measure(scene_of(c.scene), c.frame);
    const double tolerance = c.scene == Bart::robots ? 2e-3 : 2e-4;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(m.low[k], c.low[k], tolerance);
      EXPECT_NEAR(m.high[k], c.high[k], tolerance);
      EXPECT_NEAR(m.sum[k] / static_cast<double>(m.corners), c.mean[k], tolerance);
    }
    EXPECT_NEAR(m.area, c.area, 2e-6 * c.area);
  }
}

}  // namespace
}  // namespace tenebra::testing
