// Ambient occlusion by fields against rays of an independent caster (Embree): outside the sphere, on a floor
// through it and in mid-air inside it, for the promised 4.5 MB and 256 rays. Counts are smaller than those of
// tenebra-bench, the bounds are the promises.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "ao/cast/sphere_maps.h"
#include "ao/field/field_lookup.h"
#include "ao/objects.h"
#include "support/samples.h"
#include "support/seeded_random.h"

namespace tenebra {
namespace {

using glm::dmat4;
using glm::vec3;
using testing::Object;
using testing::Random;

constexpr int rays = 256, reference_rays = 4096;

struct Receiver {
  vec3 position, normal;
};

/// Cosine-weighted directions by the concentric map, turned by `angle`.
std::vector<vec3> directions_at(const Receiver& r, int count, double angle) {
  const ao::Frame frame = ao::frame_around(r.normal);
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  std::vector<vec3> directions;
  for (int i = 0; i < count; ++i) {
    const vec3 h = ao::hemisphere_from_square(ao::lattice_point(i, count));
    directions.push_back((h.x * c - h.y * s) * frame.x + (h.x * s + h.y * c) * frame.y + h.z * r.normal);
  }
  return directions;
}

/// Linear fall-off.
double occlusion(double t, double distance) {
  return t < distance ? 1 - t / distance : 0;
}

/// The object as the reference sees it.
class Reference {
public:
  explicit Reference(const Object& object)
      : object_(object), peer_({object.positions, object.triangles, {}}) {}

  double hit(vec3 origin, vec3 direction, bool* behind = nullptr) const {
    const std::uint32_t id = peer_.nearest(origin, direction);
    if (id == no_triangle) return HUGE_VAL;
    const glm::uvec3 t = object_.triangles[id];
    const glm::dvec3 a(object_.positions[t.x]), b(object_.positions[t.y]), c(object_.positions[t.z]);
    const glm::dvec3 n = glm::cross(b - a, c - a), d(direction);
    if (behind) *behind = glm::dot(n, d) > 0;
    return std::max(0.0, glm::dot(n, a - glm::dvec3(origin)) / glm::dot(n, d));
  }
  double occlusion_at(const Receiver& r, double distance, double angle) const {
    double sum = 0;
    for (const vec3 d : directions_at(r, reference_rays, angle))
      sum += occlusion(hit(r.position, d), distance);
    return sum / reference_rays;
  }
  /// Most rays meet the back of a triangle first.
  bool in_the_solid(vec3 p, Random& random) const {
    int backs = 0;
    for (int i = 0; i < 32; ++i) {
      bool back = false;
      backs += hit(p, vec3(random.direction()), &back) < HUGE_VAL && back;
    }
    return backs > 16;
  }

private:
  const Object& object_;
  testing::PeerTracer peer_;
};

double field_occlusion(const ao::FieldInstance& instance, const Receiver& r, double distance, double angle) {
  const ao::FieldKernels kernels = ao::field_kernels(SimdLevel::automatic);
  const std::vector<vec3> directions = directions_at(r, rays, angle);
  double sum = 0;
  for (int i = 0; i < rays; i += trees::batch_size) {
    trees::RayBatch batch;
    float t[trees::batch_size];
    std::fill(t, t + trees::batch_size, static_cast<float>(distance));
    for (int k = 0; k < trees::batch_size; ++k)
      batch.set(k, r.position, directions[static_cast<std::size_t>(i + k)]);
    kernels.nearest_hits(instance, {&batch, 1}, t);
    for (const float d : t) sum += occlusion(d, distance);
  }
  return sum / rays;
}

/// A corner of three walls that touch the sphere, four radii wide.
std::vector<Receiver> corner_receivers(const ao::Ellipsoid& sphere, Random& random, int count) {
  std::vector<Receiver> receivers;
  for (int i = 0; i < count; ++i) {
    glm::dvec3 p, n(0);
    for (int k = 0; k < 3; ++k) p[k] = random.in(-1.01, 2.99);
    p[i % 3] = -1.01;
    n[i % 3] = 1;
    receivers.push_back({vec3(sphere.centre + sphere.axes.x * p), vec3(n)});
  }
  return receivers;
}

/// A floor on which the object stands, where it lies inside the sphere.
std::vector<Receiver> floor_receivers(const Object& object, const ao::Ellipsoid& sphere, Random& random,
                                      int count) {
  double lowest = HUGE_VAL;
  for (const glm::uvec3& t : object.triangles)
    for (int k = 0; k < 3; ++k) lowest = std::min(lowest, static_cast<double>(object.positions[t[k]].y));
  const double height = (lowest - sphere.centre.y) / sphere.axes.x - 1e-4;
  std::vector<Receiver> receivers;
  while (static_cast<int>(receivers.size()) < count) {
    const glm::dvec3 p(random.in(-1, 1), height, random.in(-1, 1));
    if (glm::dot(p, p) < 1) receivers.push_back({vec3(sphere.centre + sphere.axes.x * p), {0, 1, 0}});
  }
  return receivers;
}

/// Anywhere in the sphere, looking anywhere, not in the solid.
std::vector<Receiver> air_receivers(const Reference& reference, const ao::Ellipsoid& sphere, Random& random,
                                    int count) {
  std::vector<Receiver> receivers;
  while (static_cast<int>(receivers.size()) < count) {
    const glm::dvec3 p = random.in_cube(1);
    const vec3 at(sphere.centre + sphere.axes.x * p);
    if (glm::dot(p, p) < 1 && !reference.in_the_solid(at, random))
      receivers.push_back({at, vec3(random.direction())});
  }
  return receivers;
}

/// Root of the mean squared error in 1/255.
double rms_255(const ao::FieldInstance& instance, const Reference& reference,
               const std::vector<Receiver>& receivers, double distance) {
  Random random(99);
  double sum = 0;
  for (const Receiver& r : receivers) {
    const double exact = reference.occlusion_at(r, distance, random.in(0, 6.28));
    const double found = field_occlusion(instance, r, distance, random.in(0, 6.28));
    EXPECT_TRUE(found >= 0 && found <= 1) << found;
    sum += (found - exact) * (found - exact);
  }
  return 255 * std::sqrt(sum / static_cast<double>(receivers.size()));
}

void measure(const char* name, const Object& object) {
  Random random(7);
  const Reference reference(object);
  const trees::TriangleBvh bvh = object.bvh();
  const ao::DisplacementField chords = object.field(), sparse = object.field(ao::sparse_field);
  const ao::DisplacementField paper = object.field({FieldLayout::positions_directions, 4225, 1024, 8});
  const double distance = 2 * paper.bound.axes.x;
  const auto outside = corner_receivers(paper.bound, random, 300);
  const auto floor = floor_receivers(object, paper.bound, random, 80);
  const auto air = air_receivers(reference, paper.bound, random, 80);
  const auto rms = [&](const ao::DisplacementField& field, const auto& receivers,
                       ao::FieldEnds ends = ao::FieldEnds::both) {
    return rms_255(*ao::place_field(field, ends == ao::FieldEnds::both ? &bvh : nullptr, dmat4(1), ends),
                   reference, receivers, distance);
  };
  const double chords_outside = rms(chords, outside), paper_outside = rms(paper, outside);
  const double chords_floor = rms(chords, floor), paper_floor = rms(paper, floor);
  const double chords_air = rms(chords, air), paper_air = rms(paper, air);
  std::printf(
      "%s: outside %.2f, paper %.2f, sparse %.2f; floor %.2f, paper %.2f; in the air %.2f, paper %.2f\n",
      name, chords_outside, paper_outside, rms(sparse, outside), chords_floor, paper_floor, chords_air,
      paper_air);
  EXPECT_LE(chords.table.size(), 4'500'000u);
  EXPECT_LE(paper.table.size(), 4'500'000u);
  EXPECT_LE(chords_outside, 0.8);
  EXPECT_LE(paper_outside, 1.5);
  EXPECT_LE(std::max({chords_floor, paper_floor, chords_air, paper_air}), 5);
  // What the paper's first hit alone makes of a receiver inside.
  EXPECT_GT(rms(paper, air, ao::FieldEnds::first), paper_air);
}

void measure_file(const char* name, const std::string& path) {
  // Scans and models of others have licences of their own: they lie beside the checkout, not in it.
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << path << " is missing: this scene is measured where it is there";
  const std::optional<Object> object = testing::object_of(path);
  ASSERT_TRUE(object) << path << " is there, but cannot be read";
  measure(name, *object);
}

TEST(FieldAccuracy, OfABundledMesh) {
  const std::optional<Object> object =
      testing::largest_mesh_of(std::string(TENEBRA_SCENES_DIR) + "/court.glb");
  ASSERT_TRUE(object);
  measure("court.glb, largest mesh", *object);
}

TEST(FieldAccuracy, OfTheBunny) {
  measure_file("bunny", std::string(TENEBRA_SHARED_DIR) + "/scenes/extra/obj/bunny.obj");
}

TEST(FieldAccuracy, OfTheFlightHelmet) {
  measure_file("FlightHelmet",
               std::string(TENEBRA_SHARED_DIR) + "/scenes/extra/gltf/FlightHelmet/FlightHelmet.gltf");
}

}  // namespace
}  // namespace tenebra
