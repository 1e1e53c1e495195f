// Embree as the opponent of the fields: nearest hits of single rays and of packets of sixteen.
#pragma once

#include <limits>

#include "base/stopwatch.h"
#include "bench/ao/ao_objects.h"
#include "bench/ao/ao_rays.h"
#include "bench/common/bench_embree.h"

namespace tenebra::bench {

struct PeerHit {
  float distance = std::numeric_limits<float>::infinity();  ///< t; infinity: none
  glm::vec3 normal{0.0f};                                   ///< of the face, not unit
};

/// Built once at the best quality.
class AoPeer {
public:
  enum class Casters { all, only };    ///< which triangles hide: all, or those that cast shadows
  enum class Edges { quick, robust };  ///< robust: no ray passes between two triangles that share an edge
  explicit AoPeer(const Object& object);
  explicit AoPeer(const TriangleView& triangles, Casters casters = Casters::all, Edges edges = Edges::quick);

  PeerHit nearest(glm::vec3 origin, glm::vec3 direction) const;

  /// Nearest hits beyond t = `from`, one ray after the other.
  Tracer single_rays(float from = 0) const;
  /// The same in packets of sixteen; `coherent` tells Embree that they run close together.
  Tracer packets(bool coherent, float from = 0) const;

  double build_ms() const { return build_ms_; }

private:
  base::Stopwatch watch_;  // starts before the scene is built
  EmbreeScene scene_;
  double build_ms_;
};

}  // namespace tenebra::bench
