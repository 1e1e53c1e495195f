// Places of a light, one in each cell of a grid around it: what each weighs and how much of it passes.
// Included once per target.
#if defined(TENEBRA_TINT_LIGHT_GRID_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_TINT_LIGHT_GRID_INL_H_
#undef TENEBRA_TINT_LIGHT_GRID_INL_H_
#else
#define TENEBRA_TINT_LIGHT_GRID_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "simd/double8-inl.h"
#include "soft/polygon/light_fragments-inl.h"
#include "tint/soft_tint.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::tint::HWY_NAMESPACE {
using simd::HWY_NAMESPACE::any;
using simd::HWY_NAMESPACE::bits;
using simd::HWY_NAMESPACE::broadcast8;
using simd::HWY_NAMESPACE::Double8;
using simd::HWY_NAMESPACE::le;
using simd::HWY_NAMESPACE::load;
using simd::HWY_NAMESPACE::lt;
using simd::HWY_NAMESPACE::reduce_add_in_order;
using simd::HWY_NAMESPACE::select;
using simd::HWY_NAMESPACE::store;
using Polygon8 = soft::HWY_NAMESPACE::StoredPolygon<float>;  ///< of at most eight vertices

/// Rows and columns of cells: none where the last is before the first.
struct Cells {
  int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
};

constexpr int few_rows = 2;  ///< of eight: looked at without asking first which are reached

/// Buffers kept from point to point.
class LightGrid {
public:
  /// `side`: cells along each axis, a multiple of 8. One place in each, by Roberts's sequence in two
  /// dimensions.
  void set_side(int side) {
    if (side == side_) return;
    side_ = side;
    const std::size_t count = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    for (auto* values : {&x_, &y_, &weight_, &passed_[0], &passed_[1], &passed_[2]})
      values->assign(count, 0.0);
    for (int row = 0; row < side; ++row) {
      for (int column = 0; column < side; ++column) {
        const std::size_t i = at(row, column);
        const double n = static_cast<double>(i), u = n * 0.7548776662466927, v = n * 0.5698402909980532;
        x_[i] = 2.0 / side * (column + (u - std::floor(u))) - 1.0;
        y_[i] = 2.0 / side * (row + (v - std::floor(v))) - 1.0;
      }
    }
    row_middles_.resize(static_cast<std::size_t>(side));
    for (int row = 0; row < side; ++row)
      row_middles_[static_cast<std::size_t>(row)] = (2 * row + 1.0) / side - 1.0;
  }

  /// Starts with a new point: no place within these fragments weighs anything, and all pass.
  void start(const soft::HWY_NAMESPACE::FragmentList<float>& visible) {
    first_row_ = side_, last_row_ = -1;
    std::fill(total_, total_ + 8, 0.0);
    for (std::size_t i = 0; i < visible.size(); ++i) {
      const Cells cells = cells_around(visible[i]);
      first_row_ = std::min(first_row_, cells.first_row), last_row_ = std::max(last_row_, cells.last_row);
    }
    if (last_row_ < first_row_) return;
    const auto first = start_of_row(first_row_), last = start_of_row(last_row_ + 1);
    std::fill(weight_.begin() + first, weight_.begin() + last, 0.0);
    for (auto& channel : passed_) std::fill(channel.begin() + first, channel.begin() + last, 1.0);
  }

  /// Weighs the places in a visible fragment that have no weight yet: `weight(x, y)` of eight places.
  template <class Weight>
  void weigh(const Polygon8& fragment, const Weight& weight) {
    const Double8 zero = broadcast8(0.0);
    Double8 total = load<Double8>(total_);
    for_each_eight(cells_around(fragment), [&](std::size_t i, const auto& inside_cells) {
      const Double8 before = load<Double8>(&weight_[i]);
      const auto here = inside_cells & le(before, zero) & inside(fragment, i);
      if (!any(here)) return;
      const Double8 added = weight(load<Double8>(&x_[i]), load<Double8>(&y_[i]));
      store(select(here, added, before), &weight_[i]);
      total = total + select(here, added, zero);
    });
    store(total, total_);
  }
  double total() const { return reduce_add_in_order(load<Double8>(total_)); }  ///< weight of all places

  /// Multiplies what passes at the places with weight for which all lines are positive, which lie in `cells`,
  /// by `factor(place)`, or by one factor.
  template <class Factor>
  void pass(const glm::dvec3 (&lines)[4], const Cells& cells, const Factor& factor) {
    for_each_shadowed(lines, cells, [&](std::size_t i, const auto& shadowed) {
      for (std::uint32_t lanes = bits(shadowed); lanes != 0; lanes &= lanes - 1) {
        const std::size_t place = i + static_cast<std::size_t>(std::countr_zero(lanes));
        const glm::dvec3 passes(factor(glm::dvec2(x_[place], y_[place])));
        for (int c = 0; c < 3; ++c) passed_[c][place] *= passes[c];
      }
    });
  }
  void pass(const glm::dvec3 (&lines)[4], const Cells& cells, const glm::vec3& factor) {
    const glm::dvec3 passes(factor);
    for_each_shadowed(lines, cells, [&](std::size_t i, const auto& shadowed) {
      for (int c = 0; c < 3; ++c) {
        const Double8 before = load<Double8>(&passed_[c][i]);
        store(select(shadowed, broadcast8(passes[c]) * before, before), &passed_[c][i]);
      }
    });
  }

  /// The weights times what passes, summed.
  glm::dvec3 passed() const {
    Double8 sum[3] = {broadcast8(0.0), broadcast8(0.0), broadcast8(0.0)};
    for (std::ptrdiff_t i = start_of_row(first_row_); i < start_of_row(last_row_ + 1); i += 8) {
      const auto k = static_cast<std::size_t>(i);
      const Double8 weight = load<Double8>(&weight_[k]);
      for (int c = 0; c < 3; ++c) sum[c] = sum[c] + weight * load<Double8>(&passed_[c][k]);
    }
    return {reduce_add_in_order(sum[0]), reduce_add_in_order(sum[1]), reduce_add_in_order(sum[2])};
  }

  Cells all_cells() const { return {0, side_ - 1, 0, side_ - 1}; }
  /// Those of a box, and a little more, as its coordinates are rounded.
  Cells cells_between(const glm::dvec2& low, const glm::dvec2& high) const {
    const auto cell = [this](double place) {
      return static_cast<int>(std::clamp(std::floor((place + 1) * (side_ / 2)), 0.0, side_ - 1.0));
    };
    return {cell(low.x - box_slack), cell(high.x + box_slack), cell(low.y - box_slack),
            cell(high.y + box_slack)};
  }

private:
  std::size_t at(int row, int column) const { return static_cast<std::size_t>(row * side_ + column); }
  std::ptrdiff_t start_of_row(int row) const { return static_cast<std::ptrdiff_t>(row) * side_; }

  Cells cells_around(const Polygon8& polygon) const {
    glm::dvec2 low(polygon.x[0], polygon.y[0]), high = low;
    for (int k = 1; k < polygon.count; ++k) {
      const glm::dvec2 corner(polygon.x[k], polygon.y[k]);
      low = glm::min(low, corner), high = glm::max(high, corner);
    }
    return cells_between(low, high);
  }

  /// `body` gets the first of eight cells of a row, and which of them are among `cells`.
  template <class Body>
  static void for_each_eight_of_row(std::size_t row_start, const Cells& cells, const Body& body) {
    static constexpr double lanes[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const Double8 first = broadcast8(cells.first_column), last = broadcast8(cells.last_column);
    for (int column = cells.first_column / 8 * 8; column <= cells.last_column; column += 8) {
      const Double8 columns = broadcast8(column) + load<Double8>(lanes);
      body(row_start + static_cast<std::size_t>(column), le(first, columns) & le(columns, last));
    }
  }
  template <class Body>
  void for_each_eight(const Cells& cells, const Body& body) const {
    for (int row = cells.first_row; row <= cells.last_row; ++row)
      for_each_eight_of_row(at(row, 0), cells, body);
  }

  /// In which of eight rows of a square of cells the lines leave places: more than rounding could hide.
  std::uint32_t rows_reached(const glm::dvec3 (&lines)[4], int first_row, int first_column) const {
    const double half = 8.0 / side_ * (1 + 0x1p-30), middle = (2.0 * first_column + 8) / side_ - 1.0;
    const Double8 zero = broadcast8(0.0),
                  y = load<Double8>(&row_middles_[static_cast<std::size_t>(first_row)]);
    auto reached = le(zero, zero);
    for (const glm::dvec3& line : lines) {
      const double most = line.z + line.x * middle + (std::abs(line.x) + std::abs(line.y) / 8) * half;
      reached = reached & lt(zero, broadcast8(line.y) * y + broadcast8(most));
    }
    return bits(reached);
  }

  /// `body` gets the first of eight places of a row, and which of them have weight and are positive for all
  /// lines.
  template <class Body>
  void for_each_shadowed(const glm::dvec3 (&lines)[4], const Cells& cells, const Body& body) const {
    const int first = std::max(cells.first_row, first_row_), last = std::min(cells.last_row, last_row_);
    for (int row = first / 8 * 8; row <= last; row += 8)
      for (int column = cells.first_column / 8 * 8; column <= cells.last_column; column += 8) {
        std::uint32_t rows = 0xffu << std::max(first - row, 0) & 0xffu >> std::max(row + 7 - last, 0);
        if (std::popcount(rows) > few_rows) rows &= rows_reached(lines, row, column);
        for (; rows != 0; rows &= rows - 1)
          look_at_eight(at(row + std::countr_zero(rows), column), lines, body);
      }
  }
  template <class Body>
  void look_at_eight(std::size_t i, const glm::dvec3 (&lines)[4], const Body& body) const {
    const Double8 zero = broadcast8(0.0), x = load<Double8>(&x_[i]), y = load<Double8>(&y_[i]);
    auto shadowed = lt(zero, load<Double8>(&weight_[i]));
    for (const glm::dvec3& line : lines)
      shadowed = shadowed & lt(zero, broadcast8(line.x) * x + broadcast8(line.y) * y + broadcast8(line.z));
    if (any(shadowed)) body(i, shadowed);
  }

  /// Of eight places. An edge of no length but for rounding says nothing.
  auto inside(const Polygon8& polygon, std::size_t i) const {
    const Double8 x = load<Double8>(&x_[i]), y = load<Double8>(&y_[i]), least = broadcast8(-1e-6);
    auto in = le(x, x);
    for (int k = 0; k < polygon.count; ++k) {
      const int next = k + 1 < polygon.count ? k + 1 : 0;
      const glm::dvec2 a(polygon.x[k], polygon.y[k]),
          along = glm::dvec2(polygon.x[next], polygon.y[next]) - a;
      in = in & le(least,
                   broadcast8(along.x) * (y - broadcast8(a.y)) - broadcast8(along.y) * (x - broadcast8(a.x)));
    }
    return in;
  }

  int side_ = 0, first_row_ = 0, last_row_ = -1;  ///< rows: those that hold what is visible
  std::vector<double> x_, y_, weight_;            ///< weight 0: not visible
  std::vector<double> passed_[3];
  std::vector<double> row_middles_;
  double total_[8] = {};  ///< weights, every eighth
};

}  // namespace tenebra::tint::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
