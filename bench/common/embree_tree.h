// Embree's trees over a scene that moves: built anew, refitted, or in two levels by what moved; and trees
// that take long to build, for what stands still.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tenebra/simd_level.h>
#include <tenebra/visible_points.h>
#include "ao/reference/embree.h"

namespace tenebra::bench {

/// The first four follow triangles that move from frame to frame.
enum class TreeKind {
  rebuild,          ///< low quality, all of it anew
  refit,            ///< boxes follow the triangles, the order stays that of the first build
  two_level,        ///< what stands still once at high quality, what moves anew at low quality
  two_level_refit,  ///< the same, with boxes that follow
  medium,
  high
};
inline constexpr TreeKind moving_trees[] = {TreeKind::rebuild, TreeKind::refit, TreeKind::two_level,
                                            TreeKind::two_level_refit};
inline constexpr TreeKind still_trees[] = {TreeKind::medium, TreeKind::high};
const char* tree_name(TreeKind kind);

/// Settings of a device with this many threads, kept to the instructions of `simd`.
std::string embree_settings(int threads, SimdLevel simd);

/// Of each vertex whether it stands elsewhere in the two frames.
std::vector<std::uint8_t> moved_vertices(std::span<const glm::vec3> before, std::span<const glm::vec3> now);

/// Bits of a ray's mask: which triangles it meets.
inline constexpr unsigned meets_all = 1, meets_casters = 2;

/// Whether rays can be kept to some triangles, which Embree can be built without.
bool has_ray_masks();

class EmbreeTree {
public:
  struct Settings {
    TreeKind kind = TreeKind::rebuild;
    int threads = 1;
    SimdLevel simd = SimdLevel::automatic;
    bool only_casters = true;  ///< else the others are there, too, for rays with `meets_all`
  };
  /// Reads `vertices` whenever it builds: they stay where they are, with room for one more float behind them.
  /// `moves`: of each vertex, as of moved_vertices.
  EmbreeTree(const glm::vec3* vertices, const TriangleView& triangles, std::span<const std::uint8_t> moves,
             const Settings& settings);
  ~EmbreeTree();
  EmbreeTree(const EmbreeTree&) = delete;
  EmbreeTree& operator=(const EmbreeTree&) = delete;

  /// After the vertices have moved.
  void follow();
  RTCScene get() const { return scene_; }
  /// Whether packets of this many rays are traced as such. Embree takes wider ones for streams, which do not
  /// know which rays are valid.
  bool takes_packets_of(int rays) const;
  /// Triangle `prim` of Embree's geometry `geometry`.
  std::uint32_t id_of(unsigned geometry, unsigned prim) const { return ids_[first_[geometry] + prim]; }

private:
  struct Part {
    bool moves = false;
    bool casts = false;
    std::vector<std::uint32_t> ids;
  };
  void add(const Part& part, const glm::vec3* vertices, const TriangleView& triangles, TreeKind kind);

  RTCDevice device_;
  RTCScene scene_;
  std::vector<RTCGeometry> moving_;
  std::vector<std::size_t> first_;  ///< in ids_, of each geometry
  std::vector<std::uint32_t> ids_;
};

/// Vertices that a tree reads and a contest replaces.
class TreeVertices {
public:
  explicit TreeVertices(std::span<const glm::vec3> first) : vertices_(first.size() + 1) { put(first); }
  void put(std::span<const glm::vec3> now) { std::copy(now.begin(), now.end(), vertices_.begin()); }
  const glm::vec3* data() const { return vertices_.data(); }

private:
  std::vector<glm::vec3> vertices_;
};

}  // namespace tenebra::bench
