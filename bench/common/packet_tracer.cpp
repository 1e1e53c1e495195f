#include "bench/common/packet_tracer.h"

#include <fmt/format.h>

#include <cstring>

#include "bench/common/embree_packets.h"

namespace tenebra::bench {
namespace {

// By the type of the packet: the query's call and the code of that size.
void occluded(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRay16& r) {
  q.occluded16(valid, s, r);
}
void occluded(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRay8& r) {
  q.occluded8(valid, s, r);
}
void occluded(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRay4& r) {
  q.occluded4(valid, s, r);
}
const auto& code_of(const RayTileKernels& k, const RTCRay16&) {
  return k.sixteen;
}
const auto& code_of(const RayTileKernels& k, const RTCRay8&) {
  return k.eight;
}
const auto& code_of(const RayTileKernels& k, const RTCRay4&) {
  return k.four;
}

}  // namespace

std::vector<PacketPlan> packet_plans(const EmbreeTree& tree) {
  std::vector<PacketPlan> plans;
  for (const RayWay way : {RayWay::to_light, RayWay::from_light}) {
    plans.push_back({16, TileShape::square, way});
    plans.push_back({16, TileShape::wide, way});
    plans.push_back({8, TileShape::square, way});
    plans.push_back({4, TileShape::square, way});
  }
  std::erase_if(plans, [&](const PacketPlan& plan) { return !tree.takes_packets_of(plan.size); });
  return plans;
}

std::string packet_plan_name(const PacketPlan& plan) {
  const char* shape = plan.size == 4                    ? "2x2"
                      : plan.size == 8                  ? "4x2"
                      : plan.shape == TileShape::square ? "4x4"
                                                        : "8x2";
  return fmt::format("{} {}", shape, plan.way == RayWay::to_light ? "to" : "from");
}

template <int N, class Hits, class Rays>
PacketTracer::Packet<N, Hits, Rays>::Packet() {
  std::fill(std::begin(all), std::end(all), -1);
  std::fill(std::begin(valid), std::end(valid), 0);
  std::fill(std::begin(rays.mask), std::end(rays.mask), meets_casters);
  std::fill(std::begin(hits.ray.mask), std::end(hits.ray.mask), meets_all);
}

PacketTracer::PacketTracer(const EmbreeTree& tree, const PacketPlan& plan, SimdLevel simd)
    : tree_(tree), plan_(plan), lanes_(TileLanes::of(plan.shape)), kernels_(ray_tile_kernels(simd)) {}

template <class Chosen>
void PacketTracer::look_all(Chosen& packet, const ViewRays& view, float x, float y, std::uint32_t ids[16],
                            TilePlanes& planes, TilePoints& points) {
  const auto& code = code_of(kernels_, packet.rays);
  for (int first = 0; first < 16; first += Chosen::size) {
    code.look(view, lanes_, first, x, y, packet.hits);
    intersect(query_, packet.all, tree_.get(), packet.hits);
    code.met(packet.hits, first, planes, points);
    for (int i = 0; i < Chosen::size; ++i) {
      const unsigned geometry = packet.hits.hit.geomID[i];
      ids[first + i] = geometry == RTC_INVALID_GEOMETRY_ID ? no_triangle
                                                           : tree_.id_of(geometry, packet.hits.hit.primID[i]);
    }
  }
}

template <class Chosen>
std::uint32_t PacketTracer::lit_all(Chosen& packet, const TilePlanes& planes, const TilePoints& points,
                                    const LightAim& light) {
  const auto& code = code_of(kernels_, packet.rays);
  std::uint32_t lit = 0;
  for (int first = 0; first < 16; first += Chosen::size) {
    if (!code.aim(planes, points, first, light, packet.rays, packet.valid)) continue;
    occluded(query_, packet.valid, tree_.get(), packet.rays);
    lit |= code.lit(packet.rays, packet.valid) << first;
  }
  return lit;
}

void PacketTracer::look(const ViewRays& view, float x, float y, std::uint32_t ids[16], TilePlanes& planes,
                        TilePoints& points) {
  if (plan_.size == 16) return look_all(sixteen_, view, x, y, ids, planes, points);
  if (plan_.size == 8) return look_all(eight_, view, x, y, ids, planes, points);
  return look_all(four_, view, x, y, ids, planes, points);
}

std::uint32_t PacketTracer::lit(const TilePlanes& planes, const TilePoints& points, const LightAim& light) {
  if (plan_.size == 16) return lit_all(sixteen_, planes, points, light);
  if (plan_.size == 8) return lit_all(eight_, planes, points, light);
  return lit_all(four_, planes, points, light);
}

void TileGrid::take(const std::uint32_t* plane, glm::ivec2 at, std::uint32_t ids[16]) const {
  if (inside(at)) {
    for_pairs(at, [&](int pair, std::size_t from) { std::memcpy(ids + pair, plane + from, 8); });
    return;
  }
  for (int i = 0; i < 16; ++i) {
    const glm::ivec2 pixel = at + lane(i);
    ids[i] = pixel.x < width_ && pixel.y < height_ ? plane[place(pixel)] : no_triangle;
  }
}

void TileGrid::put(const std::uint32_t ids[16], glm::ivec2 at, std::uint32_t* plane) const {
  if (inside(at)) {
    for_pairs(at, [&](int pair, std::size_t to) { std::memcpy(plane + to, ids + pair, 8); });
    return;
  }
  for (int i = 0; i < 16; ++i) {
    const glm::ivec2 pixel = at + lane(i);
    if (pixel.x < width_ && pixel.y < height_) plane[place(pixel)] = ids[i];
  }
}

void TileGrid::put_bits(std::uint32_t bits, glm::ivec2 at, std::uint8_t* plane) const {
  static constexpr std::uint8_t two[4][2] = {{0, 0}, {255, 0}, {0, 255}, {255, 255}};
  if (inside(at)) {
    for_pairs(at, [&](int pair, std::size_t to) { std::memcpy(plane + to, two[bits >> pair & 3u], 2); });
    return;
  }
  for (int i = 0; i < 16; ++i) {
    const glm::ivec2 pixel = at + lane(i);
    if (pixel.x < width_ && pixel.y < height_) plane[place(pixel)] = two[bits >> i & 1u][0];
  }
}

}  // namespace tenebra::bench
