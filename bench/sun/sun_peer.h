// The contestant: sums of the suns that points see, by Embree's occlusion rays in packets.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/common/bench_embree.h"
#include "sun/receivers.h"
#include "sun/suns.h"

namespace tenebra::bench {

/// What makes a packet, and what the inner loop runs over: an outer one is over 1,024 points.
enum class SunPacking { points_then_suns, suns_then_points, suns_of_a_point };
struct SunPlan {
  SunPacking packing = SunPacking::points_then_suns;
  int width = 8;        ///< rays in a packet: 16, 8, 4, or rays alone: 1
  bool sorted = false;  ///< receivers along a curve through space; else as they are given
};
/// Those with packets that Embree traces as such on this machine.
std::vector<SunPlan> sun_plans(const EmbreeScene& casters);
std::string sun_plan_name(const SunPlan& plan);

/// Where rays start, as planes of floats, padded to whole blocks with normals of zero. Made outside of all
/// measurements.
struct PeerPlaces {
  std::vector<float> x, y, z, nx, ny, nz;
  std::vector<std::uint32_t> receiver;  ///< of each point; its points follow each other
};
/// Lifted off their triangles by `lift_m`. Receivers are on fronts of triangles.
PeerPlaces peer_places(const sun::Receivers& receivers, const TriangleView& triangles, bool sorted,
                       float lift_m);

/// For each receiver the mean over its points of the weights of the suns that they see.
std::vector<double> peer_sums(const EmbreeScene& casters, const PeerPlaces& places, std::size_t receivers,
                              std::span<const sun::Sun> suns, const SunPlan& plan);

}  // namespace tenebra::bench
