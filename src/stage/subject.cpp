#include "stage/subject.h"

#include <algorithm>
#include <cmath>

namespace tenebra::stage {
namespace {

using glm::dvec3;

constexpr int cells = 64;

template <class Work>
void for_each_vertex(const FrameGeometry& frame, const Work& work) {
  for (const glm::uvec3& triangle : frame.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    for (int k = 0; k < 3; ++k) work(frame.positions[triangle[k]]);
  }
}

void extend(const FrameGeometry& frame, Subject& subject) {
  for_each_vertex(frame, [&](const glm::vec3& vertex) {
    const dvec3 at(vertex);
    const bool first = subject.empty();
    subject.low = first ? at : glm::min(subject.low, at);
    subject.high = first ? at : glm::max(subject.high, at);
  });
}

/// What the cells hold of vertices.
class Cells {
public:
  explicit Cells(const Subject& subject) : low_(subject.low), size_(subject.high - subject.low) {}

  void add(const FrameGeometry& frame) {
    for_each_vertex(frame, [&](const glm::vec3& vertex) {
      Cell& cell = held_[index_of(dvec3(vertex))];
      cell.low = glm::min(cell.low, vertex);
      cell.high = glm::max(cell.high, vertex);
    });
  }
  std::vector<SubjectPart> places() const {
    std::vector<SubjectPart> places;
    for (const Cell& cell : held_) {
      if (!cell.held()) continue;
      const dvec3 low(cell.low), high(cell.high);
      places.push_back({0.5 * (low + high), 0.5 * (high - low)});
    }
    return places;
  }
  std::vector<dvec3> middles() const {
    std::vector<dvec3> middles;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i].held()) continue;
      const dvec3 middle(static_cast<double>(i % cells) + 0.5, static_cast<double>(i / cells % cells) + 0.5,
                         static_cast<double>(i / cells / cells) + 0.5);
      middles.push_back(low_ + middle * size_ / static_cast<double>(cells));
    }
    return middles;
  }

private:
  struct Cell {
    glm::vec3 low{HUGE_VALF}, high{-HUGE_VALF};

    bool held() const { return low.x <= high.x; }
  };
  std::size_t index_of(const dvec3& at) const {
    std::size_t cell[3];
    for (int c = 0; c < 3; ++c) {
      const double part = size_[c] > 0 ? (at[c] - low_[c]) / size_[c] : 0;
      cell[c] = static_cast<std::size_t>(std::clamp(part * cells, 0.0, cells - 1.0));
    }
    return cell[0] + cells * (cell[1] + cells * cell[2]);
  }

  dvec3 low_, size_;
  std::vector<Cell> held_ = std::vector<Cell>(std::size_t{cells} * cells * cells);
};

/// The direction in which the places' spread is largest, by repeated multiplication with their covariance.
void find_long_axis(Subject& subject) {
  glm::dmat3 spread(0.0);
  const double scale = 1 / subject.radius_m();
  for (const SubjectPart& place : subject.places) {
    const dvec3 at = scale * (place.middle - subject.centre());
    spread += glm::outerProduct(at, at);
  }
  const double sum = spread[0][0] + spread[1][1] + spread[2][2];
  if (!(sum > 0)) return;
  dvec3 axis(1, 1.01, 0.99);
  for (int i = 0; i < 100; ++i) axis = glm::normalize(spread * axis + 1e-9 * sum * axis);
  const double along = glm::dot(axis, spread * axis);
  subject.long_axis = axis;
  subject.slenderness = std::sqrt(std::max(1.0, along / std::max(0.5 * (sum - along), 1e-12 * sum)));
}

}  // namespace

double Subject::radius_m() const {
  const double radius = empty() ? 0 : 0.5 * glm::length(high - low);
  return radius > 0 ? radius : 1;
}

dvec3 Subject::half_cell() const {
  return (high - low) * (0.5 / cells);
}

Subject subject_of(const Scene& scene) {
  constexpr int intervals = 8;
  const int clip = scene.clips.empty() ? -1 : 0;
  const double start_s = clip < 0 ? 0 : scene.clips.front().start_s;
  const double length_s = clip < 0 ? 0 : scene.clips.front().end_s - start_s;
  Subject subject;
  evaluate_frame(scene, clip, start_s, subject.first);
  extend(subject.first, subject);
  FrameGeometry frame;
  const auto at_times = [&](const auto& work) {
    for (int i = 1; i <= (length_s > 0 ? intervals : 0); ++i) {
      evaluate_frame(scene, clip, start_s + length_s * i / intervals, frame);
      work(frame);
    }
  };
  at_times([&](const FrameGeometry& now) { extend(now, subject); });
  if (subject.empty()) return subject;
  Cells held(subject);
  held.add(subject.first);
  subject.first_cells = held.middles();
  at_times([&](const FrameGeometry& now) { held.add(now); });
  subject.places = held.places();
  find_long_axis(subject);
  return subject;
}

}  // namespace tenebra::stage
