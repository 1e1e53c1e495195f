#include "soft/occluders/group_frame.h"

#include <algorithm>

#include "base/sort_unique.h"

namespace tenebra::soft {

GroupFrame frame_of(std::span<const PointGroup* const> of, const PointGroups& groups,
                    std::vector<std::uint32_t>& receivers) {
  GroupFrame frame;
  glm::dvec3 low = of[0]->low, high = of[0]->high;
  receivers.clear();
  for (const PointGroup* group : of) {
    low = glm::min(low, group->low), high = glm::max(high, group->high);
    for (const Receiver& receiver : groups.receivers_of(*group)) {
      receivers.push_back(receiver.triangle);
      frame.receiver_tau = std::max(frame.receiver_tau, receiver.tau);
    }
  }
  if (of.size() > 1) base::sort_unique(receivers);
  frame.centre = 0.5 * (low + high);
  frame.half = glm::max(high - frame.centre, frame.centre - low);
  frame.receivers = receivers;
  return frame;
}

}  // namespace tenebra::soft
