#include "texture/mip_texture.h"

#include <algorithm>
#include <cmath>

namespace tenebra::texture {
namespace {

using glm::dvec2;
using glm::vec4;
using Table = std::array<float, 256>;

double linear_of(double encoded) {
  return encoded <= 12.92 * 0.0031308 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
double encoded_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

const Table& decode_table(bool srgb) {
  const auto make = [](bool curve) {
    Table table{};
    for (int i = 0; i < 256; ++i)
      table[static_cast<std::size_t>(i)] = static_cast<float>(curve ? linear_of(i / 255.0) : i / 255.0);
    return table;
  };
  static const Table curved = make(true), straight = make(false);
  return srgb ? curved : straight;
}

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// One level in floats while levels are made: colours linear, times alpha where that is a share.
struct FloatLevel {
  int width = 0, height = 0;
  std::vector<vec4> values;

  const vec4& at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Which old pixels a new one covers along one axis, and how much of each.
struct Cover {
  int first = 0, count = 0;
  std::array<float, 3> share{};
};
Cover cover_of(int i, int old_size, int new_size) {
  const double scale = static_cast<double>(old_size) / new_size, from = i * scale, to = (i + 1) * scale;
  Cover cover{static_cast<int>(from), 0, {}};
  for (int k = cover.first; k < old_size && k < to && cover.count < 3; ++k, ++cover.count) {
    const double share = std::min(to, k + 1.0) - std::max(from, static_cast<double>(k));
    cover.share[static_cast<std::size_t>(cover.count)] = static_cast<float>(share / scale);
  }
  return cover;
}

FloatLevel halved(const FloatLevel& from) {
  FloatLevel to{std::max(1, from.width / 2), std::max(1, from.height / 2), {}};
  to.values.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
  std::vector<Cover> columns;
  for (int x = 0; x < to.width; ++x) columns.push_back(cover_of(x, from.width, to.width));
  for (int y = 0; y < to.height; ++y) {
    const Cover rows = cover_of(y, from.height, to.height);
    for (const Cover& column : columns) {
      vec4 sum(0.0f);
      for (int j = 0; j < rows.count; ++j) {
        for (int k = 0; k < column.count; ++k) {
          sum += rows.share[static_cast<std::size_t>(j)] * column.share[static_cast<std::size_t>(k)] *
                 from.at(column.first + k, rows.first + j);
        }
      }
      to.values.push_back(sum);
    }
  }
  return to;
}

/// std::floor without a call: the baseline has no instruction for it. From 2^52 on all doubles are whole.
double floored(double x) {
  if (!(std::abs(x) < 0x1p52)) return x;
  const auto towards_zero = static_cast<double>(static_cast<std::int64_t>(x));
  return towards_zero > x ? towards_zero - 1 : towards_zero;
}

/// The coordinate in the picture, 0 to 1, that `coordinate` stands for.
double folded(double coordinate, Wrap mode) {
  if (mode == Wrap::clamp_to_edge) return std::clamp(coordinate, 0.0, 1.0);
  if (mode == Wrap::repeat) return coordinate - floored(coordinate);
  const double within = coordinate - 2 * floored(coordinate / 2);
  return within > 1 ? 2 - within : within;
}

/// Index of a neighbour of a pixel of the picture: -1 to size.
int neighbour(int i, int size, Wrap mode) {
  if (mode != Wrap::repeat) return std::clamp(i, 0, size - 1);
  return i < 0 ? size - 1 : i >= size ? 0 : i;
}

/// The footprint as an ellipse in pixels of level 0.
struct Ellipse {
  float major = 0, minor = 0;
  dvec2 axis{0.0};  ///< from end to end of the longer axis, in coordinates of the picture
};
Ellipse ellipse_of(const dvec2& dx, const dvec2& dy, const dvec2& size) {
  const dvec2 px = dx * size, py = dy * size;
  const double a = px.x * px.x + py.x * py.x, b = px.x * px.y + py.x * py.y, c = px.y * px.y + py.y * py.y;
  const double half = 0.5 * (a - c), root = std::sqrt(half * half + b * b), square = 0.5 * (a + c) + root;
  const double major = std::sqrt(square);
  if (!(major > 0) || !std::isfinite(major)) return {};
  Ellipse result;
  result.major = static_cast<float>(major);
  result.minor = static_cast<float>(std::abs(px.x * py.y - px.y * py.x) / major);
  dvec2 along = a >= c ? dvec2(half + root, b) : dvec2(b, root - half);
  const double length = std::sqrt(glm::dot(along, along));
  along = length > 0 ? along / length : dvec2(1, 0);
  result.axis = major * along / size;
  return result;
}

}  // namespace

MipTexture::MipTexture(const TextureImage& image, Content content)
    : decode_(decode_table(content == Content::srgb_color || content == Content::srgb_beside_data).data()) {
  const bool srgb = content == Content::srgb_color || content == Content::srgb_beside_data;
  const bool weighted = content == Content::srgb_color || content == Content::display_color;
  levels_.push_back({image.width, image.height, image.rgba});
  FloatLevel level{image.width, image.height, {}};
  level.values.reserve(image.rgba.size() / 4);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const vec4 value = pixel(0, x, y);
      level.values.push_back(weighted ? vec4(value.a * glm::vec3(value), value.a) : value);
    }
  }
  while (level.width > 1 || level.height > 1) {
    level = halved(level);
    Level& stored = levels_.emplace_back(Level{level.width, level.height, {}});
    stored.rgba.reserve(4 * level.values.size());
    for (const vec4& value : level.values) {
      const float share = weighted ? (value.a > 0 ? 1 / value.a : 0.0f) : 1.0f;
      for (int c = 0; c < 3; ++c) {
        const double linear = std::min(1.0f, value[c] * share);
        stored.rgba.push_back(to_byte(srgb ? encoded_of(linear) : linear));
      }
      stored.rgba.push_back(to_byte(value.a));
    }
  }
}

vec4 MipTexture::pixel(std::size_t level, int x, int y) const {
  const Level& from = levels_[level];
  return decoded(from.rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(from.width) +
                                         static_cast<std::size_t>(x)));
}

vec4 MipTexture::at_level(std::size_t level, Filter filter, const TextureMap& map, const dvec2& place) const {
  const int w = levels_[level].width, h = levels_[level].height;
  const double x = folded(place.x, map.wrap_u) * w, y = folded(place.y, map.wrap_v) * h;
  if (filter == Filter::nearest) {
    return pixel(level, std::min(static_cast<int>(x), w - 1), std::min(static_cast<int>(y), h - 1));
  }
  const double x0 = floored(x - 0.5), y0 = floored(y - 0.5);
  const auto column = static_cast<int>(x0), row = static_cast<int>(y0);
  const auto fx = static_cast<float>(x - 0.5 - x0), fy = static_cast<float>(y - 0.5 - y0);
  const int left = neighbour(column, w, map.wrap_u), right = neighbour(column + 1, w, map.wrap_u);
  const int top = neighbour(row, h, map.wrap_v), bottom = neighbour(row + 1, h, map.wrap_v);
  const std::uint8_t* const first = levels_[level].rgba.data();
  const auto at = [&](int i, int j) {
    return decoded(first + 4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(w) +
                                static_cast<std::size_t>(i)));
  };
  const vec4 upper = glm::mix(at(left, top), at(right, top), fx);
  const vec4 lower = glm::mix(at(left, bottom), at(right, bottom), fx);
  return glm::mix(upper, lower, fy);
}

vec4 MipTexture::at_detail(const TextureMap& map, float detail, const dvec2& place) const {
  if (map.mip == MipFilter::none) return at_level(0, map.minify, map, place);
  const float level = std::clamp(detail, 0.0f, static_cast<float>(levels_.size() - 1));
  if (map.mip == MipFilter::nearest) {
    return at_level(static_cast<std::size_t>(level + 0.5f), map.minify, map, place);
  }
  const auto lower = static_cast<std::size_t>(level);
  const float part = level - static_cast<float>(lower);
  const vec4 sharp = at_level(lower, map.minify, map, place);
  if (part == 0.0f) return sharp;
  return glm::mix(sharp, at_level(lower + 1, map.minify, map, place), part);
}

vec4 MipTexture::sample(const TextureMap& map, glm::vec2 uv, const Footprint& footprint) const {
  // In double: a repeated texture far from 0 keeps its fractions.
  const glm::dmat3x2 transform(map.transform);
  const dvec2 place = transform * glm::dvec3(uv, 1.0);
  constexpr double largest = 1e9;
  if (!(std::abs(place.x) < largest && std::abs(place.y) < largest)) return pixel(0, 0, 0);
  const dvec2 size(levels_[0].width, levels_[0].height);
  const Ellipse seen =
      ellipse_of(transform * glm::dvec3(footprint.dx, 0.0), transform * glm::dvec3(footprint.dy, 0.0), size);
  if (!(seen.major > 1)) return at_level(0, map.magnify, map, place);
  const bool many = map.minify == Filter::linear && map.mip != MipFilter::none;
  const float ratio = std::ceil(seen.major / std::max(seen.minor, 1.0f) - 1e-3f);
  const int taps = many ? std::clamp(static_cast<int>(std::min(ratio, 1e3f)), 1, most_taps) : 1;
  const float detail = std::log2(std::max(seen.major / static_cast<float>(taps), 1.0f));
  if (taps == 1) return at_detail(map, detail, place);
  vec4 sum(0.0f);
  for (int i = 0; i < taps; ++i) sum += at_detail(map, detail, place + ((i + 0.5) / taps - 0.5) * seen.axis);
  return sum / static_cast<float>(taps);
}

}  // namespace tenebra::texture
