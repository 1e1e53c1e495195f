#include "bench/ao/ao_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "support/samples.h"

namespace tenebra::bench {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr int side = 144, text_height = 28, columns = 4;  // px
constexpr int cell_width = 2 * side, cell_height = side + text_height;

/// Five rows of three pixels for each character.
constexpr std::string_view characters = "0123456789.xsm";
constexpr std::array<std::array<std::uint8_t, 5>, 14> glyphs{{{7, 5, 5, 5, 7},
                                                              {2, 6, 2, 2, 7},
                                                              {7, 1, 7, 4, 7},
                                                              {7, 1, 7, 1, 7},
                                                              {5, 5, 7, 1, 1},
                                                              {7, 4, 7, 1, 7},
                                                              {7, 4, 7, 5, 7},
                                                              {7, 1, 1, 2, 2},
                                                              {7, 5, 7, 5, 7},
                                                              {7, 5, 7, 1, 7},
                                                              {0, 0, 0, 0, 2},
                                                              {0, 5, 2, 5, 0},
                                                              {0, 3, 2, 1, 3},
                                                              {0, 7, 7, 5, 5}}};

void write_text(io::Image8& image, int left, int top, const std::string& text) {
  constexpr int size = 2;
  for (const char c : text) {
    const auto known = characters.find(c);
    for (int i = 0; known != std::string_view::npos && i < 15 * size * size; ++i) {
      const int x = i % (3 * size), y = i / (3 * size);
      if (((glyphs[known][static_cast<std::size_t>(y / size)] >> (2 - x / size)) & 1) == 0) continue;
      const auto pixel = static_cast<std::size_t>(((top + y) * image.width + left + x) * 3);
      std::fill_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(pixel), 3, std::uint8_t{0});
    }
    left += 4 * size;
  }
}

}  // namespace

Sheet::Sheet(const Ball& ball, const AoPeer& peer, std::span<const float> truth)
    : truth_(truth.begin(), truth.end()) {
  const double near_wall = -1.05 * ball.radius, step = 6 * ball.radius / (wall_points - 1);
  const dvec3 eye = ball.centre + dvec3(7.0, 5.5, 8.0) * ball.radius;
  const ViewRays view = testing::pinhole(eye, ball.centre + dvec3(0.3 * ball.radius), 0.27, side, side);
  for (int i = 0; i < side * side; ++i) {
    const vec3 direction = view.d0 + (static_cast<float>(i % side) + 0.5f) * view.dx +
                           (static_cast<float>(i / side) + 0.5f) * view.dy;
    Seen seen;
    const PeerHit hit = peer.nearest(view.eye, direction);
    auto nearest = static_cast<double>(hit.distance);
    if (std::isfinite(hit.distance)) {
      const float facing = std::abs(glm::dot(glm::normalize(hit.normal), glm::normalize(direction)));
      seen.shade = static_cast<std::uint8_t>(80 + 120 * facing);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double t = (ball.centre[axis] + near_wall - eye[axis]) / static_cast<double>(direction[axis]);
      if (!(t > 0) || t >= nearest) continue;
      const dvec3 on = (eye + t * dvec3(direction) - ball.centre - near_wall) / step;
      const double x = on[(axis + 1) % 3], y = on[(axis + 2) % 3];
      if (x < 0 || y < 0 || x >= wall_points - 1 || y >= wall_points - 1) continue;
      seen = {axis, static_cast<float>(x), static_cast<float>(y)};
      nearest = t;
    }
    seen_.push_back(seen);
  }
  add(truth, "", "");
}

void Sheet::add(std::span<const float> values, const std::string& title, const std::string& caption) {
  cells_.push_back({{values.begin(), values.end()}, title, caption});
}

std::uint8_t Sheet::shade(const Seen& seen, std::span<const float> values, bool difference) const {
  if (seen.wall < 0) return difference ? 255 : seen.shade;
  const int x = static_cast<int>(seen.x), y = static_cast<int>(seen.y);
  const float fx = seen.x - static_cast<float>(x), fy = seen.y - static_cast<float>(y);
  const auto at = [&](int i, int j) {
    const auto k = static_cast<std::size_t>(seen.wall * wall_points * wall_points + j * wall_points + i);
    return difference ? 30 * std::abs(values[k] - truth_[k]) : values[k];
  };
  const float closed = (1 - fy) * ((1 - fx) * at(x, y) + fx * at(x + 1, y)) +
                       fy * ((1 - fx) * at(x, y + 1) + fx * at(x + 1, y + 1));
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(1 - closed, 0.0f, 1.0f)));
}

io::Image8 Sheet::picture() const {
  const int rows = (static_cast<int>(cells_.size()) + columns - 1) / columns;
  io::Image8 image{columns * cell_width, rows * cell_height, 3, {}};
  image.pixels.assign(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3,
                      255);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const int left = static_cast<int>(c) % columns * cell_width,
              top = static_cast<int>(c) / columns * cell_height;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < cell_width; ++x) {
        const Seen& seen = seen_[static_cast<std::size_t>(y * side + x % side)];
        const auto pixel = static_cast<std::ptrdiff_t>(((top + y) * image.width + left + x) * 3);
        std::fill_n(image.pixels.begin() + pixel, 3, shade(seen, cells_[c].values, x >= side));
      }
    }
    write_text(image, left + 4, top + side + 2, cells_[c].title);
    write_text(image, left + 4, top + side + 15, cells_[c].caption);
  }
  return image;
}

}  // namespace tenebra::bench
