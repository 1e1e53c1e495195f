#include "stage/cutout/outline.h"

#include <algorithm>

#include "stage/cutout/cross.h"
#include "stage/cutout/gates.h"

namespace tenebra::stage {
namespace {

constexpr std::size_t look_ahead =
    512;  // gates that one segment may pass: bounds the work on a straight line

/// One loop's gates in order, bends among them as gates that allow nothing; no two neighbours in one place.
std::vector<Gate> collect_loop(const GateNet& net, std::uint32_t start, std::vector<bool>& seen) {
  std::vector<Gate> loop;
  const auto add = [&](const Gate& gate) {
    if (loop.empty() || loop.back().at != gate.at) return loop.push_back(gate);
    loop.back().forced = loop.back().forced || gate.forced;
  };
  for (std::uint32_t g = start; !seen[g]; g = net.next[g]) {
    seen[g] = true;
    add(net.gates[g]);
    for (std::uint32_t b = net.first_bend[g]; b < net.first_bend[g + 1]; ++b)
      add({net.bends[b], net.bends[b], net.bends[b], true});
  }
  while (loop.size() > 1 && loop.back().at == loop.front().at) {
    loop.front().forced = loop.front().forced || loop.back().forced;
    loop.pop_back();
  }
  return loop;
}

/// The directions in which a straight line leaves a vertex and passes all gates so far.
class Cone {
public:
  bool allows(glm::dvec2 direction) const {
    return open_ || (cross(right_, direction) >= 0 && cross(direction, left_) >= 0 &&
                     glm::dot(direction, left_ + right_) > 0);
  }
  /// False if nothing remains.
  bool narrow(glm::dvec2 left, glm::dvec2 right) {
    if (open_ || cross(left_, left) < 0) left_ = left;
    if (open_ || cross(right_, right) > 0) right_ = right;
    open_ = false;
    return cross(right_, left_) >= 0;
  }

private:
  bool open_ = true;
  glm::dvec2 left_{0.0}, right_{0.0};
};

/// The farthest gate after `from` that a straight line reaches through all gates between; at most `end`.
std::size_t farthest(const std::vector<Gate>& loop, std::size_t from, std::size_t end) {
  const glm::dvec2 at = loop[from].at;
  std::size_t best = from + 1;
  Cone cone;
  for (std::size_t i = from + 1; i <= std::min(end, from + look_ahead); ++i) {
    const Gate& gate = loop[i % loop.size()];
    if (cone.allows(gate.at - at)) best = i;
    if (gate.forced || !cone.narrow(gate.left - at, gate.right - at)) break;
  }
  return best;
}

/// Whether all of a loop lies within a square of this side.
bool is_speck(const std::vector<Gate>& loop, double side) {
  glm::dvec2 low = loop.front().at, high = low;
  for (const Gate& gate : loop) {
    low = glm::min(low, gate.at);
    high = glm::max(high, gate.at);
  }
  return high.x - low.x < side && high.y - low.y < side;
}

/// Begins at a vertex that must stay, if there is one. Greedy: each segment is as long as the gates allow.
void simplify(std::vector<Gate>& loop, Outline& out) {
  const auto forced = std::find_if(loop.begin(), loop.end(), [](const Gate& gate) { return gate.forced; });
  if (forced != loop.end()) std::rotate(loop.begin(), forced, loop.end());
  const std::size_t first = out.points.size();
  for (std::size_t i = 0; i < loop.size(); i = farthest(loop, i, loop.size())) {
    out.points.push_back(loop[i].at);
    out.next.push_back(static_cast<std::uint32_t>(out.points.size()));
  }
  if (out.points.size() - first < 3) {
    out.points.resize(first);
    out.next.resize(first);
  } else {
    out.next.back() = static_cast<std::uint32_t>(first);
  }
}

}  // namespace

Outline trace_outline(const AlphaSheet& sheet, double threshold, double tolerance) {
  // Half for what a chord leaves of its hyperbola, half for how far a segment passes beside a crossing, less
  // what keeps crossings apart from grid points.
  const GateNet net = march(sheet, threshold, 0.5 * (tolerance - corner_gap), most_gates);
  Outline outline;
  outline.too_long = net.too_many;
  std::vector<bool> seen(net.gates.size(), false);
  for (std::uint32_t g = 0; g < net.gates.size(); ++g) {
    if (seen[g]) continue;
    std::vector<Gate> loop = collect_loop(net, g, seen);
    if (!is_speck(loop, 0.5 * tolerance)) simplify(loop, outline);
  }
  return outline;
}

}  // namespace tenebra::stage
