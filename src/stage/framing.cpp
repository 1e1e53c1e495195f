#include "stage/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/view_basis.h"

namespace tenebra::stage {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr double degree = std::numbers::pi / 180;
constexpr double margin = 0.03;                           ///< of half the picture, on each side
constexpr double wanted_subject = 1 / 3.0, enough = 0.9,  // of that
    wanted_shadow = 0.02;
constexpr double view_pixels = 10000;
constexpr std::size_t most_triangles = 100000;  ///< of more, those no longer than a cell count by cells
constexpr float usual_aspect = 4 / 3.0f, widest_aspect = 2;
constexpr double slender = 3;      ///< what is that many times longer than wide
constexpr double end_on_deg = 18;  ///< this near to its axis its length is not seen
constexpr double steep_deg = 45;

/// From the subject towards the camera, degrees.
struct Direction {
  double azimuth, elevation;

  dvec3 unit() const {
    const double a = azimuth * degree, e = elevation * degree;
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
  }
};
Direction angles_of(const dvec3& unit) {
  return {std::atan2(unit.x, unit.z) / degree, std::asin(std::clamp(unit.y, -1.0, 1.0)) / degree};
}

/// How far places reach along a direction.
struct Reach {
  dvec3 direction;
  double most = -HUGE_VAL;
};

/// Where the sun throws the places: point -> linear point + shift.
struct Throw {
  glm::dmat3 linear{1.0};
  dvec3 shift{0.0};
};

/// The pyramid of a view, moved until it just holds some places.
class Fit {
public:
  Fit(const glm::dmat3& basis, const dvec3& centre, const dvec2& tan)
      : centre_(centre),
        tan_(tan * (1 - margin)),
        right_{basis[0] + tan_.x * basis[2]},
        left_{-basis[0] + tan_.x * basis[2]},
        top_{basis[1] + tan_.y * basis[2]},
        bottom_{-basis[1] + tan_.y * basis[2]},
        nearest_{basis[2]},
        farthest_{-basis[2]} {}

  void add(const std::vector<SubjectPart>& places, const Throw& thrown) {
    for (Reach* reach : {&right_, &left_, &top_, &bottom_, &nearest_, &farthest_}) {
      const dvec3 along = glm::transpose(thrown.linear) * reach->direction;
      const double shift = glm::dot(reach->direction, thrown.shift - centre_);
      for (const SubjectPart& place : places)
        reach->most = std::max(reach->most,
                               glm::dot(along, place.middle) + glm::dot(glm::abs(along), place.half) + shift);
    }
  }
  /// The pyramid's apex, in the view's right, up, back from the centre; at most so near that the nearest is
  /// shown fifteen times as large as the farthest.
  dvec3 apex(double least_m) const {
    constexpr double least_part = 0.07;
    const double distance =
        std::max((right_.most + left_.most) / (2 * tan_.x), (top_.most + bottom_.most) / (2 * tan_.y));
    return {
        0.5 * (right_.most - left_.most), 0.5 * (top_.most - bottom_.most),
        std::max(distance, nearest_.most + std::max(least_m, least_part * (nearest_.most + farthest_.most)))};
  }
  double nearest() const { return nearest_.most; }
  /// Width over height with which both sides of the pyramid touch the places, about.
  double aspect() const { return (right_.most + left_.most) / (top_.most + bottom_.most); }

private:
  dvec3 centre_;
  dvec2 tan_;
  Reach right_, left_, top_, bottom_, nearest_, farthest_;
};

struct Candidate {
  Direction direction;
  double shadow;                ///< share of the shadow's length that is to be seen
  std::optional<float> aspect;  ///< none: as wide as what is to be seen
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
  const auto cell_m = static_cast<float>(2 * glm::length(subject.half_cell()));
  Cover cover;
  for (const glm::uvec3& triangle : frame.triangles) {
    if (triangle == glm::uvec3(0)) continue;  // dropped
    const glm::vec3 a = frame.positions[triangle.x], b = frame.positions[triangle.y],
                    c = frame.positions[triangle.z];
    const glm::vec3 size = glm::max(glm::max(a, b), c) - glm::min(glm::min(a, b), c);
    if (few || glm::length(size) > cell_m) cover.triangles.push_back(triangle);
  }
  if (!few) cover.cells = subject.first_cells;
  return cover;
}

class Framer {
public:
  Framer(const Subject& subject, std::optional<double> floor_y)
      : subject_(subject), floor_y_(floor_y), cover_(cover_of(subject)) {}

  Framing framed(const Candidate& candidate) const {
    Framing framing = placed(candidate);
    measure(framing);
    return framing;
  }

  /// The share of what is seen from there that shows its back.
  double backs_from(const Direction& direction) const {
    const Framing framing = placed({direction, 0, usual_aspect});
    SmallView view = empty_view(framing);
    for (const glm::uvec3& triangle : subject_.first.triangles) {
      dvec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = dvec3(subject_.first.positions[triangle[k]]);
      if (triangle != glm::uvec3(0)) view.add(corners);
    }
    return view.share_of_backs();
  }

private:
  static SmallView empty_view(const Framing& framing) {
    const double width = std::sqrt(view_pixels * framing.aspect);
    return {framing.lens(), std::max(1, static_cast<int>(std::lround(width))),
            std::max(1, static_cast<int>(std::lround(width / framing.aspect)))};
  }

  Throw shadow_of(const dvec3& sun, double length) const {
    const dvec3 along = length / sun.y * sun;
    return {{dvec3(1, 0, 0), dvec3(-along.x, 0, -along.z), dvec3(0, 0, 1)},
            dvec3(along.x, 1, along.z) * *floor_y_};
  }
  static dvec3 sun_of(const Framing& framing) { return towards_sun(compass_of(framing.basis[0])); }

  Fit fit_of(const Framing& framing, double shadow) const {
    Fit fit(framing.basis, subject_.centre(), framing.lens().tan);
    fit.add(subject_.places, {});
    if (floor_y_) fit.add(subject_.places, shadow_of(sun_of(framing), shadow));
    if (subject_.empty()) fit.add({{dvec3(0.0), dvec3(1.0)}}, {});
    return fit;
  }

  Framing placed(const Candidate& candidate) const {
    Framing framing;
    framing.basis = scene::view_basis(-candidate.direction.unit(), {0, 1, 0});
    framing.aspect = candidate.aspect.value_or(1);
    for (int i = 0; i < 3 && !candidate.aspect; ++i)
      framing.aspect = static_cast<float>(
          std::clamp<double>(fit_of(framing, candidate.shadow).aspect(), 1 / widest_aspect, widest_aspect));
    const Fit fit = fit_of(framing, candidate.shadow);
    const dvec3 apex = fit.apex(0.05 * subject_.radius_m());
    framing.eye = subject_.centre() + framing.basis * apex;
    framing.near_m = static_cast<float>(0.1 * (apex.z - fit.nearest()));
    return framing;
  }

  /// How much of the picture subject and shadow fill at the start.
  void measure(Framing& framing) const {
    SmallView subject = empty_view(framing), shadow = empty_view(framing);
    const Throw thrown = floor_y_ ? shadow_of(sun_of(framing), 1) : Throw{};
    for (const glm::uvec3& triangle : cover_.triangles) {
      dvec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = dvec3(subject_.first.positions[triangle[k]]);
      subject.add(corners);
      for (dvec3& corner : corners) corner = thrown.linear * corner + thrown.shift;
      if (floor_y_) shadow.add(corners);
    }
    const dvec3 half = subject_.half_cell();
    const dvec2 half_m(glm::length(half * framing.basis[0]), glm::length(half * framing.basis[1]));
    for (const dvec3& cell : cover_.cells) {
      subject.add(cell, half_m);
      if (floor_y_) shadow.add(thrown.linear * cell + thrown.shift, half_m);
    }
    framing.subject_share = subject.share();
    framing.shadow_share = floor_y_ ? shadow.share(&subject) : 0;
  }

  const Subject& subject_;
  std::optional<double> floor_y_;
  Cover cover_;
};

/// From the front; where most of what is seen there shows its back, from another side or from above.
Direction first_direction(const Framer& framer) {
  constexpr double least_gain = 0.25;
  constexpr std::array directions{Direction{27, 17}, Direction{207, 17}, Direction{117, 17},
                                  Direction{297, 17}, Direction{27, 60}};
  Direction best = directions.front();
  double least = framer.backs_from(best);
  for (std::size_t i = 1; i < directions.size() && least > 0.5; ++i) {
    const double backs = framer.backs_from(directions[i]);
    if (backs < least - least_gain) best = directions[i], least = backs;
  }
  return best;
}

/// Ever nearer to the axis of what is slender, from that of its ends that is in front and above.
std::vector<Direction> foreshortening(const Subject& subject, const Direction& first) {
  std::vector<Direction> directions;
  if (subject.slenderness < slender) return directions;
  const dvec3 front = Direction{first.azimuth, 40}.unit();
  const dvec3 axis = glm::dot(subject.long_axis, front) < 0 ? -subject.long_axis : subject.long_axis;
  const dvec3 across = front - glm::dot(front, axis) * axis;
  if (!(glm::length(across) > 1e-3)) return directions;
  for (const double angle : {50.0, 35.0, 25.0, 20.0}) {
    const Direction direction =
        angles_of(std::cos(angle * degree) * axis + std::sin(angle * degree) * glm::normalize(across));
    if (direction.elevation > 5) directions.push_back(direction);
  }
  return directions;
}

std::vector<Candidate> candidates_of(const Subject& subject, const Direction& first, bool with_shadow,
                                     std::optional<float> aspect) {
  const std::vector<std::optional<float>> shapes =
      aspect ? std::vector<std::optional<float>>{aspect}
             : std::vector<std::optional<float>>{usual_aspect, 1.0f, 3 / 4.0f, 16 / 9.0f,
                                                 9 / 16.0f,    2.0f, 0.5f,     std::nullopt};
  const std::vector<double> shadows =
      with_shadow ? std::vector<double>{1, 0.6, 0.3, 0.1, 0} : std::vector<double>{0};
  std::vector<Direction> directions;
  const double turn = first.azimuth - 27;
  for (const Direction& usual : {Direction{27, 17}, {27, 30}, {0, 10}, {60, 17}, {90, 10}})
    directions.push_back(
        {usual.azimuth + turn, first.elevation > steep_deg ? first.elevation : usual.elevation});
  const std::vector<Direction> along = foreshortening(subject, first);
  std::vector<Candidate> all;
  const auto add = [&](const Direction& direction, std::optional<float> shape) {
    for (const double shadow : shadows) all.push_back({direction, shadow, shape});
  };
  for (const auto& shape : shapes)
    for (const Direction& direction : directions) add(direction, shape);
  for (const auto& shape : shapes)
    for (const Direction& direction : along) add(direction, shape);
  for (const auto& shape : shapes) add({first.azimuth, 60}, shape);  // what lies flat is seen from above
  return all;
}

bool is_end_on(const Subject& subject, const Direction& direction) {
  const double off_axis = std::acos(std::min(1.0, std::abs(glm::dot(subject.long_axis, direction.unit()))));
  return subject.slenderness >= slender && off_axis < end_on_deg * degree;
}

constexpr double whole_score = 2;  ///< of a natural view with as much of subject and shadow as is wanted

/// Below 1 where the subject fills less than enough, or its length is not seen.
double score_of(const Framing& framing, bool with_shadow, bool end_on, const Direction& direction) {
  const double filled = std::min(framing.subject_share / wanted_subject, 1.0);
  const double shaded = with_shadow ? std::min(framing.shadow_share / wanted_shadow, 1.0) : 1.0;
  const double natural = end_on ? 0.6 : direction.elevation > steep_deg ? 0.8 : 1.0;
  return filled < enough || end_on ? natural * filled * (1 + 0.1 * shaded) : 1 + natural * shaded;
}

struct Scored {
  double score;
  Framing framing;
};

}  // namespace

Lens Framing::lens() const {
  const double tan_y = std::tan(0.5 * vertical_fov_rad);
  return {.eye = eye, .basis = basis, .tan = {tan_y * aspect, tan_y}, .near_m = near_m};
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
  const Framer framer(subject, floor_y);
  const Direction first = first_direction(framer);
  std::vector<Scored> all;
  for (const Candidate& candidate : candidates_of(subject, first, floor_y.has_value(), aspect)) {
    Framing framing = framer.framed(candidate);
    const double score =
        score_of(framing, floor_y.has_value(), is_end_on(subject, candidate.direction), candidate.direction);
    all.push_back({score, framing});
    if (score >= whole_score || subject.empty()) return framing;
  }
  const double best = std::max_element(all.begin(), all.end(), [](const Scored& a, const Scored& b) {
                        return a.score < b.score;
                      })->score;
  // Where none fills enough, the first that is about as good: the usual directions come first.
  const double wanted = best >= 1 ? best : 0.9 * best;
  return std::find_if(all.begin(), all.end(), [&](const Scored& one) { return one.score >= wanted; })
      ->framing;
}

}  // namespace tenebra::stage
