#include "texture/mip_texture.h"

#include <algorithm>
#include <cmath>

#include "math/srgb.h"
#include "texture/bilinear.h"

namespace tenebra::texture {
namespace {

using glm::vec4;
using Table = std::array<float, 256>;

/// Linear values of the 256 levels of colour.
const Table& decode_table(bool srgb) {
  const auto make = [](bool curve) {
    Table table{};
    for (int i = 0; i < 256; ++i)
      table[static_cast<std::size_t>(i)] =
          static_cast<float>(curve ? math::linear_of_srgb(i / 255.0) : i / 255.0);
    return table;
  };
  static const Table curved = make(true), straight = make(false);
  return srgb ? curved : straight;
}

bool is_weighted(Content content) {
  return content == Content::srgb_color || content == Content::display_color;
}

/// What a mean shows: a colour without its weight, a direction of length 1.
glm::vec3 shown_of(const vec4& mean, Content content) {
  const glm::vec3 value(mean);
  if (is_weighted(content)) return (mean.a > 0 ? 1 / mean.a : 0.0f) * value;
  if (content != Content::normal) return value;
  const glm::vec3 direction = 2.0f * value - 1.0f;
  const float length = glm::length(direction);
  return length > 1e-6f ? 0.5f * (direction / length) + 0.5f : value;
}

std::uint16_t stored(float value) {
  return static_cast<std::uint16_t>(std::lround(MipTexture::one * std::clamp(value, 0.0f, 1.0f)));
}

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

}  // namespace

/// One level in floats while levels are made: colours linear, times alpha where that is a share.
struct MipTexture::FloatLevel {
  int width = 0, height = 0;
  std::vector<vec4> values;

  const vec4& at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }

  FloatLevel halved() const {
    FloatLevel to{std::max(1, width / 2), std::max(1, height / 2), {}};
    to.values.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    std::vector<Cover> columns;
    columns.reserve(static_cast<std::size_t>(to.width));
    for (int x = 0; x < to.width; ++x) columns.push_back(cover_of(x, width, to.width));
    for (int y = 0; y < to.height; ++y) {
      const Cover rows = cover_of(y, height, to.height);
      for (const Cover& column : columns) {
        vec4 sum(0.0f);
        for (int j = 0; j < rows.count; ++j) {
          for (int k = 0; k < column.count; ++k) {
            sum += rows.share[static_cast<std::size_t>(j)] * column.share[static_cast<std::size_t>(k)] *
                   at(column.first + k, rows.first + j);
          }
        }
        to.values.push_back(sum);
      }
    }
    return to;
  }
};

MipTexture::MipTexture(const TextureImage& image, Content content, Wrap wrap_u, Wrap wrap_v)
    : width_(image.width), height_(image.height), wrap_u_(wrap_u), wrap_v_(wrap_v) {
  const Table& linear = decode_table(content == Content::srgb_color || content == Content::srgb_beside_data);
  const bool weighted = is_weighted(content);
  std::size_t pixels = 0;
  for (level_count_ = 1; width(level_count_ - 1) > 1 || height(level_count_ - 1) > 1;) ++level_count_;
  for (int i = 0; i < level_count_; ++i)
    pixels += (static_cast<std::size_t>(width(i)) + 2) * (static_cast<std::size_t>(height(i)) + 2);
  texels_.reserve(4 * pixels);
  level_count_ = 0;

  FloatLevel level{image.width, image.height, {}};
  level.values.reserve(image.rgba.size() / 4);
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const std::uint8_t* const p = &image.rgba[i];
    level.values.emplace_back(linear[p[0]], linear[p[1]], linear[p[2]], static_cast<float>(p[3]) / 255.0f);
  }
  store(level, Content::data);
  if (weighted) {
    for (vec4& value : level.values) value = vec4(value.a * glm::vec3(value), value.a);
  }
  while (level.width > 1 || level.height > 1) {
    level = level.halved();
    store(level, content);
  }
}

void MipTexture::store(const FloatLevel& level, Content content) {
  const auto stride = static_cast<std::size_t>(level.width) + 2,
             rows = static_cast<std::size_t>(level.height) + 2;
  starts_[static_cast<std::size_t>(level_count_)] =
      static_cast<std::int32_t>(texels_.size() / 4 + stride + 1);
  texels_.resize(texels_.size() + 4 * stride * rows);
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      const vec4& value = level.at(x, y);
      const glm::vec3 shown = shown_of(value, content);
      std::uint16_t* const to = texel(level_count_, x, y);
      for (int c = 0; c < 3; ++c) to[c] = stored(shown[c]);
      to[3] = stored(value.a);
    }
  }
  add_border(level_count_++);
}

std::uint16_t* MipTexture::texel(int level, int x, int y) {
  const std::ptrdiff_t stride = width(level) + 2;
  return texels_.data() + 4 * (starts_[static_cast<std::size_t>(level)] + y * stride + x);
}

void MipTexture::add_border(int level) {
  const int w = width(level), h = height(level);
  for (int y = -1; y <= h; ++y) {
    const bool beyond = y < 0 || y == h;
    for (int x = -1; x <= w; x += beyond || x == w ? 1 : w + 1) {
      if (!beyond && x >= 0 && x < w) continue;
      std::copy_n(texel(level, wrap(x, w, wrap_u_), wrap(y, h, wrap_v_)), 4, texel(level, x, y));
    }
  }
}

vec4 MipTexture::pixel(int level, int x, int y) const {
  const std::ptrdiff_t stride = width(level) + 2;
  const std::uint16_t* const p =
      texels_.data() + 4 * (starts_[static_cast<std::size_t>(level)] + y * stride + x);
  return (1 / one) * vec4(p[0], p[1], p[2], p[3]);
}

}  // namespace tenebra::texture
