#include "scene/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/view_basis.h"

namespace tenebra::scene {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double degree = std::numbers::pi / 180;
constexpr int cells = 64;
constexpr double margin = 0.03;                           ///< of half the picture, on each side
constexpr double wanted_subject = 1 / 3.0, enough = 0.9,  // of that
    wanted_shadow = 0.02;
constexpr int bitmap_width = 128;
constexpr std::size_t most_triangles = 100000;  ///< of more, those no longer than a cell count by cells

void extend(const FrameGeometry& frame, Subject& subject) {
  for (const glm::uvec3& triangle : frame.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    for (int k = 0; k < 3; ++k) {
      const dvec3 at(frame.positions[triangle[k]]);
      const bool first = subject.empty();
      subject.low = first ? at : glm::min(subject.low, at);
      subject.high = first ? at : glm::max(subject.high, at);
    }
  }
}

/// Cells that hold vertices.
class Cells {
public:
  explicit Cells(const Subject& subject) : low_(subject.low), size_(subject.high - subject.low) {}

  void add(const FrameGeometry& frame) {
    for (const glm::uvec3& triangle : frame.triangles)
      for (int k = 0; k < 3 && triangle != glm::uvec3(0); ++k) add(dvec3(frame.positions[triangle[k]]));
  }
  std::vector<dvec3> list() const {
    std::vector<dvec3> places;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i]) continue;
      const dvec3 middle(static_cast<double>(i % cells) + 0.5, static_cast<double>(i / cells % cells) + 0.5,
                         static_cast<double>(i / cells / cells) + 0.5);
      places.push_back(low_ + middle * size_ / static_cast<double>(cells));
    }
    return places;
  }

private:
  void add(const dvec3& at) {
    std::size_t cell[3];
    for (int c = 0; c < 3; ++c) {
      const double part = size_[c] > 0 ? (at[c] - low_[c]) / size_[c] : 0;
      cell[c] = static_cast<std::size_t>(std::clamp(part * cells, 0.0, cells - 1.0));
    }
    held_[cell[0] + cells * (cell[1] + cells * cell[2])] = true;
  }

  dvec3 low_, size_;
  std::vector<bool> held_ = std::vector<bool>(std::size_t{cells} * cells * cells);
};

/// Places in a view: right, up, back from the middle.
dvec3 in_view(const glm::dmat3& basis, const dvec3& centre, const dvec3& at) {
  return glm::transpose(basis) * (at - centre);
}

/// The pyramid of a view, moved until it just holds some places.
class Fit {
public:
  Fit(double tan_x, double tan_y) : tan_x_(tan_x * (1 - margin)), tan_y_(tan_y * (1 - margin)) {}

  void add(const dvec3& at, double pad) {
    right_ = std::max(right_, at.x + tan_x_ * at.z + pad * (1 + tan_x_));
    left_ = std::max(left_, -at.x + tan_x_ * at.z + pad * (1 + tan_x_));
    top_ = std::max(top_, at.y + tan_y_ * at.z + pad * (1 + tan_y_));
    bottom_ = std::max(bottom_, -at.y + tan_y_ * at.z + pad * (1 + tan_y_));
    nearest_ = std::max(nearest_, at.z + pad);
  }
  /// Of the pyramid; `least_m`: before the nearest place.
  dvec3 apex(double least_m) const {
    const double distance = std::max((right_ + left_) / (2 * tan_x_), (top_ + bottom_) / (2 * tan_y_));
    return {0.5 * (right_ - left_), 0.5 * (top_ - bottom_), std::max(distance, nearest_ + least_m)};
  }
  double nearest() const { return nearest_; }

private:
  double tan_x_, tan_y_;
  double right_ = -1e300, left_ = -1e300, top_ = -1e300, bottom_ = -1e300, nearest_ = -1e300;
};

/// Pixels of a small picture whose centres triangles cover.
class Bitmap {
public:
  explicit Bitmap(float aspect)
      : height_(std::max(1, static_cast<int>(std::lround(bitmap_width / aspect)))),
        held_(static_cast<std::size_t>(bitmap_width * height_)) {}

  dvec2 size() const { return {bitmap_width, height_}; }
  void add(const dvec2 (&v)[3]) {
    const dvec2 low = glm::min(glm::min(v[0], v[1]), v[2]), high = glm::max(glm::max(v[0], v[1]), v[2]);
    const auto first = [](double at) { return static_cast<int>(std::ceil(std::max(at, 0.0) - 0.5)); };
    const auto last = [](double at, int side) {
      return static_cast<int>(std::floor(std::min(at, static_cast<double>(side)) - 0.5));
    };
    if (!(low.x < bitmap_width && low.y < height_ && high.x > 0 && high.y > 0)) return;
    for (int y = std::max(first(low.y), 0); y <= last(high.y, height_); ++y)
      for (int x = std::max(first(low.x), 0); x <= last(high.x, bitmap_width); ++x)
        if (covers(v, {x + 0.5, y + 0.5})) held_[static_cast<std::size_t>(y * bitmap_width + x)] = true;
  }
  void add(const dvec2& middle, const dvec2& half) {
    const dvec2 low = glm::clamp(glm::ceil(middle - half - 0.5), dvec2(0), size()),
                high = middle + half - 0.5;
    for (int y = static_cast<int>(low.y); y <= high.y && y < height_; ++y)
      for (int x = static_cast<int>(low.x); x <= high.x && x < bitmap_width; ++x)
        held_[static_cast<std::size_t>(y * bitmap_width + x)] = true;
  }
  double share() const { return share_beside(nullptr); }
  double share_beside(const Bitmap* other) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < held_.size(); ++i)
      count += held_[i] && (other == nullptr || !other->held_[i]);
    return static_cast<double>(count) / static_cast<double>(held_.size());
  }

private:
  static bool covers(const dvec2 (&v)[3], const dvec2& at) {
    bool left = false, right = false;
    for (int k = 0; k < 3; ++k) {
      const dvec2 edge = v[(k + 1) % 3] - v[k], to = at - v[k];
      const double side = edge.x * to.y - edge.y * to.x;
      left = left || side > 0;
      right = right || side < 0;
    }
    return left != right;
  }

  int height_;
  std::vector<bool> held_;
};

struct Candidate {
  double azimuth, elevation;  ///< degrees, of the way from the subject to the camera
  double shadow;              ///< share of the shadow's length that is to be seen
  float aspect;
};

/// What covers the picture at the start: all triangles, or instead of many small ones the cells that hold
/// them.
struct Cover {
  std::vector<glm::uvec3> triangles;
  std::vector<dvec3> cells;  ///< middles
};
Cover cover_of(const Subject& subject) {
  const FrameGeometry& frame = subject.first;
  const bool few = frame.triangles.size() <= most_triangles;
  const auto cell_m = static_cast<float>(2 * subject.pad_m);
  Cover cover;
  for (const glm::uvec3& triangle : frame.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    const glm::vec3 a = frame.positions[triangle.x], b = frame.positions[triangle.y],
                    c = frame.positions[triangle.z];
    const glm::vec3 size = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
    if (few || glm::length(size) > cell_m) cover.triangles.push_back(triangle);
  }
  if (!few) cover.cells = subject.first_places;
  return cover;
}

class Framer {
public:
  Framer(const Subject& subject, std::optional<double> floor_y)
      : subject_(subject), floor_y_(floor_y), cover_(cover_of(subject)) {}

  Framing framed(const Candidate& candidate) {
    const double a = candidate.azimuth * degree, e = candidate.elevation * degree;
    const dvec3 back(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
    Framing framing;
    framing.basis = view_basis(-back, {0, 1, 0});
    framing.aspect = candidate.aspect;
    sun_ = towards_sun(compass_of(framing.basis[0]));
    place(candidate.shadow, framing);
    measure(framing);
    return framing;
  }

private:
  dvec3 shadow_of(const dvec3& at, double length) const {
    const double height = at.y - *floor_y_;
    return {at.x - length * sun_.x / sun_.y * height, *floor_y_, at.z - length * sun_.z / sun_.y * height};
  }

  void place(double shadow, Framing& framing) const {
    const double tan_y = std::tan(0.5 * framing.vertical_fov_rad);
    const dvec3 centre = subject_.centre();
    Fit fit(tan_y * framing.aspect, tan_y);
    for (const dvec3& at : subject_.places) {
      fit.add(in_view(framing.basis, centre, at), subject_.pad_m);
      if (floor_y_) fit.add(in_view(framing.basis, centre, shadow_of(at, shadow)), subject_.pad_m);
    }
    if (subject_.places.empty()) fit.add(dvec3(0.0), 1.0);
    const dvec3 apex = fit.apex(0.05 * subject_.radius_m());
    framing.eye = centre + framing.basis * apex;
    framing.near_m = static_cast<float>(0.1 * (apex.z - fit.nearest()));
  }

  /// How much of the picture subject and shadow fill at the start.
  void measure(Framing& framing) const {
    Bitmap subject(framing.aspect), shadow(framing.aspect);
    for (const glm::uvec3& triangle : cover_.triangles) {
      dvec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = dvec3(subject_.first.positions[triangle[k]]);
      add(framing, corners, subject);
      for (dvec3& corner : corners)
        if (floor_y_) corner = shadow_of(corner, 1);
      if (floor_y_) add(framing, corners, shadow);
    }
    for (const dvec3& cell : cover_.cells) {
      add(framing, cell, subject);
      if (floor_y_) add(framing, shadow_of(cell, 1), shadow);
    }
    framing.subject_share = subject.share();
    framing.shadow_share = shadow.share_beside(&subject);
  }
  static dvec2 tan_of(const Framing& framing) {
    const double tan_y = std::tan(0.5 * framing.vertical_fov_rad);
    return {tan_y * framing.aspect, tan_y};
  }
  static void add(const Framing& framing, const dvec3 (&corners)[3], Bitmap& to) {
    const dvec2 tan = tan_of(framing);
    dvec2 v[3];
    for (int k = 0; k < 3; ++k) {
      const dvec3 at = in_view(framing.basis, framing.eye, corners[k]);
      if (!(at.z < 0)) return;
      v[k] = 0.5 * to.size() * dvec2(1 - at.x / (tan.x * at.z), 1 + at.y / (tan.y * at.z));
    }
    to.add(v);
  }
  /// A cell as the rectangle that is as wide and high as it looks.
  void add(const Framing& framing, const dvec3& middle, Bitmap& to) const {
    const dvec2 tan = tan_of(framing);
    const dvec3 at = in_view(framing.basis, framing.eye, middle), half = subject_.half_cell();
    if (!(at.z < 0)) return;
    const dvec2 half_m(glm::length(half * framing.basis[0]), glm::length(half * framing.basis[1]));
    to.add(0.5 * to.size() * dvec2(1 - at.x / (tan.x * at.z), 1 + at.y / (tan.y * at.z)),
           0.5 * to.size() * half_m / (tan * -at.z));
  }

  const Subject& subject_;
  std::optional<double> floor_y_;
  Cover cover_;
  dvec3 sun_{0, 1, 0};
};

std::vector<Candidate> candidates_of(bool with_shadow, std::optional<float> aspect) {
  const std::vector<float> shapes =
      aspect ? std::vector<float>{*aspect}
             : std::vector<float>{4 / 3.0f, 1.0f, 3 / 4.0f, 16 / 9.0f, 9 / 16.0f, 2.0f, 0.5f};
  const std::vector<double> shadows =
      with_shadow ? std::vector<double>{1, 0.6, 0.3, 0.1, 0} : std::vector<double>{0};
  constexpr std::array directions{dvec2(27, 17), dvec2(27, 30), dvec2(0, 10), dvec2(60, 17)};
  std::vector<Candidate> all;
  for (const float shape : shapes)
    for (const dvec2& direction : directions)
      for (const double shadow : shadows) all.push_back({direction.x, direction.y, shadow, shape});
  // What lies flat is seen from above.
  for (const double shadow : shadows) all.push_back({27, 60, shadow, shapes.front()});
  return all;
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
  subject.first_places = held.list();
  at_times([&](const FrameGeometry& now) { held.add(now); });
  subject.places = held.list();
  subject.pad_m = glm::length(subject.half_cell());
  return subject;
}

Compass compass_of(const dvec3& right) {
  const dvec3 level(right.x, 0, right.z);
  const double length = glm::length(level);
  if (!(length > 1e-3 * glm::length(right))) return {};
  return {level / length, glm::cross(level / length, dvec3(0, 1, 0))};
}

dvec3 towards_sun(const Compass& compass) {
  constexpr double azimuth = 60 * degree, elevation = 50 * degree;
  const dvec3 level = std::cos(azimuth) * compass.back - std::sin(azimuth) * compass.right;
  return std::cos(elevation) * level + std::sin(elevation) * dvec3(0, 1, 0);
}

Framing frame_subject(const Subject& subject, std::optional<double> floor_y, std::optional<float> aspect) {
  Framer framer(subject, floor_y);
  Framing best;
  double best_score = -1;
  for (const Candidate& candidate : candidates_of(floor_y.has_value(), aspect)) {
    const Framing framing = framer.framed(candidate);
    const double filled = std::min(framing.subject_share / wanted_subject, 1.0);
    const double shaded = floor_y ? std::min(framing.shadow_share / wanted_shadow, 1.0) : 1.0;
    const double natural = candidate.elevation > 45 ? 0.8 : 1.0;
    const double score = filled < enough ? natural * filled * (1 + 0.1 * shaded) : 1 + shaded;
    if (score > best_score) best = framing;
    best_score = std::max(best_score, score);
    if (best_score >= 2 || subject.empty()) break;
  }
  return best;
}

}  // namespace tenebra::scene
