#include "soft/shafts.h"

#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "parallel/parallel.h"
#include "points/triangle_corners.h"

namespace tenebra {

using glm::dvec3;

namespace {

struct Box {
  dvec3 low, high;
};

Box box_of(const Corners& c) {
  const dvec3 a(c.v[0]), b(c.v[1]), d(c.v[2]);
  return {glm::min(a, glm::min(b, d)), glm::max(a, glm::max(b, d))};
}

bool apart(const Box& a, const Box& b) {
  return a.high.x < b.low.x || b.high.x < a.low.x || a.high.y < b.low.y || b.high.y < a.low.y ||
         a.high.z < b.low.z || b.high.z < a.low.z;
}

// The light's box, widened by the rounding of its vertices.
Box box_of(const AreaLight& light) {
  Box box{dvec3(INFINITY), dvec3(-INFINITY)};
  for (const glm::dvec2& v : light.outline) {
    const dvec3 q = light.centre + v.x * light.ex + v.y * light.ey;
    const dvec3 error = 0x1p-48 * (glm::abs(light.centre) + std::abs(v.x) + std::abs(v.y));
    box.low = glm::min(box.low, q - error), box.high = glm::max(box.high, q + error);
  }
  return box;
}

}  // namespace

struct ShaftCuller::State {
  std::vector<Box> boxes;
  std::vector<std::uint32_t> casters;
  ShaftStats stats;
};

ShaftCuller::ShaftCuller() : state_(std::make_unique<State>()) {}
ShaftCuller::ShaftCuller(ShaftCuller&&) noexcept = default;
ShaftCuller& ShaftCuller::operator=(ShaftCuller&&) noexcept = default;
ShaftCuller::~ShaftCuller() = default;
const ShaftStats& ShaftCuller::stats() const {
  return state_->stats;
}

bool ShaftCuller::for_each_group(const PointGroups& groups, const TriangleView& triangles,
                                 const AreaLight& light, const SoftShadowConfig&, const StopFlag* stop,
                                 const GroupBody& body) {
  State& s = *state_;
  s.stats = {};
  s.casters.clear();
  s.boxes.clear();
  for (std::uint32_t id = 0; id < triangles.triangles.size(); ++id) {
    if (!triangles.casts_shadow.empty() && triangles.casts_shadow[id] == 0) continue;
    s.casters.push_back(id);
    s.boxes.push_back(box_of(corners_of(triangles, id)));
  }
  const Box light_box = box_of(light);
  std::vector<std::vector<std::uint32_t>> lists(static_cast<std::size_t>(thread_count()));
  std::vector<ShaftStats> stats(lists.size());
  parallel_tasks(static_cast<int>(groups.groups.size()), [&](int g) {
    if (stop_requested(stop)) return;
    const PointGroup& group = groups.groups[g];
    const int thread = thread_index();
    std::vector<std::uint32_t>& list = lists[thread];
    list.clear();
    const Box shaft{glm::min(group.low, light_box.low), glm::max(group.high, light_box.high)};
    for (std::size_t i = 0; i < s.casters.size(); ++i) {
      if (apart(shaft, s.boxes[i])) continue;
      if (group.receiver_count == 1 && groups.receivers_of(group)[0].triangle == s.casters[i]) continue;
      list.push_back(s.casters[i]);
    }
    stats[thread].candidates += list.size();
    body(group, list, list.empty() ? GroupClass::lit : GroupClass::mixed, thread);
  });
  for (const ShaftStats& part : stats) s.stats.candidates += part.candidates;
  return !stop_requested(stop);
}

}  // namespace tenebra
