#include "shared/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "parallel/parallel.h"

namespace tenebra::viewer {
namespace {

using glm::dvec3;

// Section 4.2 of the paper: how errors are mapped to 0..1, and how features raise them.
constexpr double color_exponent = 0.7, split_error = 0.4, split_value = 0.95, feature_exponent = 0.5;
constexpr double feature_width_degrees = 0.082;
constexpr std::size_t rows_at_once = 32;

/// Linear sRGB to XYZ, and D65, which is its white.
const glm::dmat3& to_xyz() {
  static const glm::dmat3 matrix(0.4123907992659595, 0.21263900587151036, 0.01933081871559185,
                                 0.35758433938387796, 0.7151686787677559, 0.11919477979462599,
                                 0.1804807884018343, 0.07219231536073371, 0.9505321522496607);
  return matrix;
}
dvec3 white() {
  return to_xyz() * dvec3(1.0);
}

/// Luminance, red against green, blue against yellow: a linear form of CIELAB.
dvec3 opponent_of(const dvec3& linear) {
  const dvec3 v = to_xyz() * linear / white();
  return {116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)};
}
dvec3 linear_of(const dvec3& opponent) {
  static const glm::dmat3 from_xyz = glm::inverse(to_xyz());
  const double y = (opponent.x + 16) / 116;
  return from_xyz * (white() * dvec3(y + opponent.y / 500, y, y - opponent.z / 200));
}

/// CIELAB, with colours that count for less where it is dark (Hunt).
dvec3 lab_of(const dvec3& linear) {
  constexpr double knee = 6.0 / 29;
  const auto curve = [](double t) {
    return t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
  };
  const dvec3 v = to_xyz() * linear / white();
  const double lightness = 116 * curve(v.y) - 16;
  const dvec3 lab(lightness, 500 * (curve(v.x) - curve(v.y)), 200 * (curve(v.y) - curve(v.z)));
  return {lab.x, 0.01 * lightness * lab.y, 0.01 * lightness * lab.z};
}

/// HyAB: a distance for large differences of colour.
double distance_of(const dvec3& a, const dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Most of 0..1 is for the differences that occur.
double spread(double distance) {
  static const double largest = std::pow(distance_of(lab_of({0, 1, 0}), lab_of({0, 0, 1})), color_exponent);
  const double error = std::pow(distance, color_exponent), split = split_error * largest;
  if (error < split) return split_value / split * error;
  return split_value + (error - split) / (largest - split) * (1 - split_value);
}

/// Weights from -radius to radius.
using Taps = std::vector<double>;

Taps taps_of(int radius, auto weight) {
  Taps taps;
  for (int i = -radius; i <= radius; ++i) taps.push_back(weight(i));
  return taps;
}
double sum_of(const Taps& taps) {
  double sum = 0;
  for (const double tap : taps) sum += tap;
  return sum;
}
/// Positive weights of the sum 1, negative ones of -1.
Taps balanced(Taps taps) {
  double above = 0, below = 0;
  for (const double tap : taps) (tap > 0 ? above : below) += std::abs(tap);
  for (double& tap : taps) tap /= tap > 0 ? above : std::max(below, 1e-300);
  return taps;
}

/// A filter that works along rows and columns one after the other, and its share.
struct Blur {
  int channel = 0;
  Taps taps;
  double share = 1;
};

/// Table 1 of the paper: what the eye sees of each channel, as sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2
/// / b).
std::vector<Blur> eye_filters() {
  struct Term {
    int channel;
    double a, b;
  };
  constexpr std::array terms{Term{0, 1, 0.0047}, Term{1, 1, 0.0053}, Term{2, 34.1, 0.04},
                             Term{2, 13.5, 0.025}};
  constexpr double pi = std::numbers::pi, widest = 0.04;
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  std::vector<Blur> blurs;
  std::array<double, 3> sums{};
  for (const Term& term : terms) {
    Taps taps = taps_of(radius, [&](int i) {
      const double x = i / pixels_per_degree;
      return std::exp(-pi * pi * x * x / term.b);
    });
    const double of_row = sum_of(taps), weight = term.a * std::sqrt(pi / term.b) * of_row * of_row;
    for (double& tap : taps) tap /= of_row;
    sums[static_cast<std::size_t>(term.channel)] += weight;
    blurs.push_back({term.channel, std::move(taps), weight});
  }
  for (Blur& blur : blurs) blur.share /= sums[static_cast<std::size_t>(blur.channel)];
  return blurs;
}

/// First and second derivatives of a Gaussian as wide as an edge looks, and the Gaussian across them.
struct FeatureFilters {
  Taps across, edge, point;
};
FeatureFilters feature_filters() {
  const double deviation = 0.5 * feature_width_degrees * pixels_per_degree, square = deviation * deviation;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * square)); };
  Taps across = taps_of(radius, gaussian);
  const double sum = sum_of(across);
  for (double& tap : across) tap /= sum;
  return {std::move(across), balanced(taps_of(radius, [&](int i) { return -i * gaussian(i); })),
          balanced(taps_of(radius, [&](int i) { return (i * i / square - 1) * gaussian(i); }))};
}

struct Filters {
  std::vector<Blur> eye = eye_filters();
  FeatureFilters features = feature_filters();
  int margin = static_cast<int>(std::max(eye.front().taps.size(), features.across.size()) / 2);
};

/// Rows of numbers: some of a picture's, with `margin` more above and below; beyond the picture they repeat
/// its nearest pixel.
struct Plane {
  std::size_t width = 0;
  std::vector<double> values;

  Plane(std::size_t across, std::size_t rows) : width(across), values(across * rows) {}
  double* row(std::size_t y) { return values.data() + y * width; }
  const double* row(std::size_t y) const { return values.data() + y * width; }
  std::size_t rows() const { return values.size() / width; }
};

Plane along_rows(const Plane& in, const Taps& taps) {
  Plane out(in.width, in.rows());
  const std::size_t radius = taps.size() / 2;
  std::vector<double> padded(in.width + 2 * radius);
  for (std::size_t y = 0; y < in.rows(); ++y) {
    const double* const row = in.row(y);
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, in.width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill_n(padded.end() - static_cast<std::ptrdiff_t>(radius), radius, row[in.width - 1]);
    for (std::size_t k = 0; k < taps.size(); ++k)
      for (std::size_t x = 0; x < in.width; ++x) out.row(y)[x] += taps[k] * padded[x + k];
  }
  return out;
}

/// The rows without the margin above and below.
Plane along_columns(const Plane& in, const Taps& taps, std::size_t margin) {
  const std::size_t radius = taps.size() / 2;
  Plane out(in.width, in.rows() - 2 * margin);
  for (std::size_t y = 0; y < out.rows(); ++y)
    for (std::size_t k = 0; k < taps.size(); ++k) {
      const double* const row = in.row(y + margin - radius + k);
      for (std::size_t x = 0; x < in.width; ++x) out.row(y)[x] += taps[k] * row[x];
    }
  return out;
}

/// What is seen of some rows of a picture.
struct Seen {
  std::vector<dvec3> lab;
  std::vector<double> edge, point;  ///< how strong features are
};

std::array<Plane, 3> opponent_rows(const io::ImageF& image, std::size_t first, std::size_t last, int margin) {
  const auto width = static_cast<std::size_t>(image.width);
  const std::size_t rows = last - first + 2 * static_cast<std::size_t>(margin);
  std::array<Plane, 3> planes{Plane(width, rows), Plane(width, rows), Plane(width, rows)};
  for (std::size_t i = 0; i < rows; ++i) {
    const auto y = std::clamp(static_cast<std::ptrdiff_t>(first + i) - margin, std::ptrdiff_t{0},
                              static_cast<std::ptrdiff_t>(image.height) - 1);
    const float* const pixels = image.pixels.data() + 3 * width * static_cast<std::size_t>(y);
    for (std::size_t x = 0; x < width; ++x) {
      dvec3 linear;
      for (int c = 0; c < 3; ++c) {
        const double value = pixels[3 * x + static_cast<std::size_t>(c)];
        linear[c] = value > 0 ? std::min(value, 1.0) : 0.0;  // NaN: 0
      }
      const dvec3 opponent = opponent_of(linear);
      for (std::size_t c = 0; c < 3; ++c) planes[c].row(i)[x] = opponent[static_cast<int>(c)];
    }
  }
  return planes;
}

/// The length of a filter's answers along rows and along columns.
std::vector<double> strength(const Plane& light, const Taps& taps, const Taps& across, std::size_t margin) {
  const Plane by_x = along_columns(along_rows(light, taps), across, margin),
              by_y = along_columns(along_rows(light, across), taps, margin);
  std::vector<double> out(by_x.values.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::hypot(by_x.values[i], by_y.values[i]);
  return out;
}

Seen seen_rows(const io::ImageF& image, std::size_t first, std::size_t last, const Filters& filters) {
  std::array<Plane, 3> planes = opponent_rows(image, first, last, filters.margin);
  const auto width = static_cast<std::size_t>(image.width), margin = static_cast<std::size_t>(filters.margin);
  std::vector<dvec3> blurred(width * (last - first), dvec3(0.0));
  for (const Blur& blur : filters.eye) {
    const Plane part = along_columns(along_rows(planes[static_cast<std::size_t>(blur.channel)], blur.taps),
                                     blur.taps, margin);
    for (std::size_t i = 0; i < blurred.size(); ++i) blurred[i][blur.channel] += blur.share * part.values[i];
  }
  Seen out;
  for (const dvec3& opponent : blurred)
    out.lab.push_back(lab_of(glm::clamp(linear_of(opponent), dvec3(0.0), dvec3(1.0))));
  Plane& light = planes[0];
  for (double& value : light.values) value = (value + 16) / 116;
  out.edge = strength(light, filters.features.edge, filters.features.across, margin);
  out.point = strength(light, filters.features.point, filters.features.across, margin);
  return out;
}

double flip_sum(const Seen& a, const Seen& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.lab.size(); ++i) {
    const double color = spread(distance_of(a.lab[i], b.lab[i]));
    const double feature = std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i]));
    sum += std::pow(color, 1 - std::pow(feature / std::numbers::sqrt2, feature_exponent));
  }
  return sum;
}

}  // namespace

double mean_flip(const io::ImageF& a, const io::ImageF& b) {
  const Filters filters;
  const auto height = static_cast<std::size_t>(a.height);
  std::vector<double> sums((height + rows_at_once - 1) / rows_at_once);
  parallel::parallel_in_order(static_cast<int>(sums.size()), [&](int part) {
    const std::size_t first = static_cast<std::size_t>(part) * rows_at_once,
                      last = std::min(first + rows_at_once, height);
    sums[static_cast<std::size_t>(part)] =
        flip_sum(seen_rows(a, first, last, filters), seen_rows(b, first, last, filters));
  });
  return sum_of(sums) / (static_cast<double>(a.width) * static_cast<double>(height));
}

}  // namespace tenebra::viewer
