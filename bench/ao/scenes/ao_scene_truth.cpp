#include "bench/ao/scenes/ao_scene_truth.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include "bench/ao/ao_peer.h"
#include "bench/ao/ao_rays.h"
#include "io/output_file.h"
#include "parallel/parallel.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr std::uint64_t definition = 1;  // hashed with the question: a changed definition needs a new one
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

/// As FNV-1a, but over words of eight bytes, each followed by a shift.
class ContentHash {
public:
  template <class T>
  void add(std::span<const T> values) {
    add_bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  template <class T>
  void add(const T& value) {
    add_bytes(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::uint64_t value() const { return hash_; }

private:
  void add_bytes(const char* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes + i, std::min<std::size_t>(8, count - i));
      hash_ = (hash_ ^ word) * 0x100000001b3u;
      hash_ ^= hash_ >> 29;
    }
  }
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::uint64_t key_of(const TruthQuestion& q) {
  ContentHash hash;
  hash.add(definition), hash.add(q.rays), hash.add(q.reach_m);
  hash.add(q.triangles.positions), hash.add(q.triangles.triangles), hash.add(q.triangles.casts_shadow);
  hash.add(q.points.width), hash.add(q.points.height);
  hash.add(std::span<const dvec3>(q.points.positions));
  hash.add(std::span<const std::uint32_t>(q.points.triangles)), hash.add(q.normals);
  return hash.value();
}

std::filesystem::path file_of(const TruthQuestion& q, std::string name, const std::filesystem::path& folder) {
  std::replace(name.begin(), name.end(), ' ', '_');
  return folder / fmt::format("ao_{}_{}x{}_{:016x}.truth", name, q.points.width, q.points.height, key_of(q));
}

/// One for each pixel; unknown where the file is missing or of another size.
std::vector<float> load(const std::filesystem::path& file, std::size_t pixels) {
  std::vector<float> values(pixels, unknown);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(4 * pixels)))
    values.assign(pixels, unknown);
  return values;
}

void save(const std::filesystem::path& file, const std::vector<float>& values) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  const std::string_view bytes(reinterpret_cast<const char*>(values.data()), 4 * values.size());
  (void)io::write_file(file, bytes);  // a cache: what is not kept is made anew
}

/// Where a pixel's rays start and how they are spread.
struct Point {
  Receiver at;
  vec3 face;
};
Point point_of(const TruthQuestion& q, float largest, std::size_t pixel) {
  const vec3 normal = q.normals[pixel];
  const vec3 face = face_on_side(q.triangles, q.points.triangles[pixel], normal);
  const dvec3 from = q.points.positions[pixel];
  return {{vec3(from + double{start_lift(from, largest)} * dvec3(face)), normal}, face};
}

void mirror(trees::RayBatch& rays, const vec3& face) {
  for (int i = 0; i < trees::batch_size; ++i) {
    const float below = 2 * std::min(0.0f, glm::dot(rays.direction(i), face));
    rays.set(i, rays.origin(i), rays.direction(i) - below * face);
  }
}

std::vector<float> cast(const TruthQuestion& q, const std::vector<std::size_t>& pixels) {
  const AoPeer peer(q.triangles, AoPeer::Casters::only, AoPeer::Edges::robust);
  const Tracer trace = peer.packets(false);
  const CosineRays rays(q.rays, 23);
  const float largest = largest_coordinate(q.triangles);
  std::vector<float> open(pixels.size());
  parallel::parallel_ranges(pixels.size(), 16, [&](std::size_t first, std::size_t last) {
    std::vector<trees::RayBatch> batches(static_cast<std::size_t>(q.rays / trees::batch_size));
    std::vector<float> distances(static_cast<std::size_t>(q.rays));
    for (std::size_t k = first; k < last; ++k) {
      const Point point = point_of(q, largest, pixels[k]);
      rays.batches(point.at, pixels[k], batches);
      for (trees::RayBatch& batch : batches) mirror(batch, point.face);
      std::fill(distances.begin(), distances.end(), q.reach_m);
      trace(batches, distances.data());
      double sum = 0;
      for (const float t : distances) sum += std::min(1.0, double{t} / double{q.reach_m});
      open[k] = static_cast<float>(sum / q.rays);
    }
  });
  return open;
}

/// Pixels of the lattice that see something which ambient light falls on.
std::vector<std::size_t> lattice(const TruthQuestion& q) {
  std::vector<std::size_t> pixels;
  for (int y = q.step / 2; y < q.points.height; y += q.step) {
    for (int x = q.step / 2; x < q.points.width; x += q.step) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(q.points.width) +
                     static_cast<std::size_t>(x);
      if (q.points.triangles[i] == no_triangle || q.normals[i] == vec3(0.0f)) continue;
      if (face_on_side(q.triangles, q.points.triangles[i], q.normals[i]) != vec3(0.0f)) pixels.push_back(i);
    }
  }
  return pixels;
}

}  // namespace

vec3 face_on_side(const TriangleView& triangles, std::uint32_t triangle, const vec3& normal) {
  const glm::uvec3 t = triangles.triangles[triangle];
  const dvec3 a = triangles.positions[t.x];
  const dvec3 n = glm::cross(dvec3(triangles.positions[t.y]) - a, dvec3(triangles.positions[t.z]) - a);
  const double square = glm::dot(n, n);
  if (!(square > 0)) return vec3(0.0f);
  const vec3 face(n / std::sqrt(square));
  return glm::dot(face, normal) < 0 ? -face : face;
}

// Points and vertices are rounded to float by half an ulp of each coordinate, sums by another.
float start_lift(const dvec3& position, float largest) {
  const dvec3 size = glm::abs(position);
  const double most = std::max({size.x, size.y, size.z, double{largest}});
  return static_cast<float>(4 * std::sqrt(3.0) * 0x1p-24 * most);
}

float largest_coordinate(const TriangleView& triangles) {
  float largest = 0;
  for (const glm::uvec3& t : triangles.triangles) {
    for (int k = 0; k < 3; ++k) {
      const vec3 p = glm::abs(triangles.positions[t[k]]);
      largest = std::max({largest, p.x, p.y, p.z});
    }
  }
  return largest;
}

AoSceneTruth cast_truth(const TruthQuestion& question) {
  AoSceneTruth truth{question.step, lattice(question), {}};
  truth.open = cast(question, truth.pixels);
  return truth;
}

AoSceneTruth find_truth(const TruthQuestion& question, const std::string& name,
                        const std::filesystem::path& folder) {
  if (folder.empty()) return cast_truth(question);
  const auto file = file_of(question, name, folder);
  std::vector<float> known = load(file, question.points.triangles.size());
  AoSceneTruth truth{question.step, lattice(question), {}};
  std::vector<std::size_t> missing;
  for (const std::size_t pixel : truth.pixels) {
    if (std::isnan(known[pixel])) missing.push_back(pixel);
  }
  const std::vector<float> found = cast(question, missing);
  for (std::size_t k = 0; k < missing.size(); ++k) known[missing[k]] = found[k];
  if (!missing.empty()) save(file, known);
  for (const std::size_t pixel : truth.pixels) truth.open.push_back(known[pixel]);
  return truth;
}

std::filesystem::path default_truth_folder() {
  const auto absolute = [](const char* variable) {
    const char* value = std::getenv(variable);
    const std::filesystem::path path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : std::filesystem::path();
  };
  if (const auto cache = absolute("XDG_CACHE_HOME"); !cache.empty()) return cache / "tenebra" / "bench";
  if (const auto home = absolute("HOME"); !home.empty()) return home / ".cache" / "tenebra" / "bench";
  return std::filesystem::temp_directory_path() / "tenebra-bench";
}

}  // namespace tenebra::bench
