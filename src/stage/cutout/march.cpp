#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "stage/cutout/gates.h"

namespace tenebra::stage {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double saddle_gap = 1.0 / 64;  // of the way to its corner: keeps two arcs of one cell apart

/// The sheet within one more line on each side, at the place of the border line, where alpha is nothing: so
/// every loop closes. Lines are counted from -1.
class Marcher {
public:
  Marcher(const AlphaSheet& sheet, double threshold, double half_tolerance, std::size_t most_gates)
      : sheet_(sheet),
        columns_(static_cast<int>(sheet.xs.size())),
        rows_(static_cast<int>(sheet.ys.size())),
        threshold_(threshold),
        half_tolerance_(half_tolerance),
        most_gates_(most_gates) {}

  GateNet run() {
    std::vector<std::uint32_t> above, below;
    cross_row(-1, below);
    for (int row = -1; row < rows_ && !net_.too_many; ++row) {
      above.swap(below);
      cross_row(row + 1, below);
      march_row(row, above, below);
    }
    if (net_.too_many) return {.too_many = true};
    sort_bends();
    return std::move(net_);
  }

private:
  /// A piece of the level line within a cell, for the gate at which it begins.
  struct Bends {
    std::uint32_t gate;
    std::uint32_t first, last;
  };

  double value(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_)
      return -std::numeric_limits<double>::infinity();
    return sheet_.value(static_cast<std::size_t>(column), static_cast<std::size_t>(row));
  }
  bool inside(int column, int row) const { return value(column, row) >= threshold_; }
  glm::dvec2 place(int column, int row) const {
    return {sheet_.xs[static_cast<std::size_t>(std::clamp(column, 0, columns_ - 1))],
            sheet_.ys[static_cast<std::size_t>(std::clamp(row, 0, rows_ - 1))]};
  }

  /// The gate between two neighbouring grid points, or `none` where both are on the same side.
  std::uint32_t cross(int column, int row, int column_step) {
    const int column2 = column + column_step, row2 = row + 1 - column_step;
    const bool first_inside = inside(column, row);
    if (first_inside == inside(column2, row2)) return none;
    if (net_.gates.size() >= most_gates_) {
      net_.too_many = true;
      return none;
    }
    const glm::dvec2 a = place(column, row), b = place(column2, row2);
    const double length = glm::dot(b - a, glm::dvec2(1.0));
    double share = 0.5, reach = 0.0;
    if (length > 0) {
      const double va = value(column, row), vb = value(column2, row2);
      share = std::clamp((threshold_ - va) / (vb - va), corner_gap, 1 - corner_gap);
      reach = half_tolerance_ / length;
    }
    const double low = length > 0 ? std::max(share - reach, corner_gap) : share;
    const double high = length > 0 ? std::min(share + reach, 1 - corner_gap) : share;
    const glm::dvec2 way = b - a;
    Gate gate{a + way * share, a + way * low, a + way * high, lies_on_border(column, row, column_step)};
    if (!first_inside) std::swap(gate.left, gate.right);
    net_.gates.push_back(gate);
    return static_cast<std::uint32_t>(net_.gates.size() - 1);
  }

  bool lies_on_border(int column, int row, int column_step) const {
    return column_step == 1 ? row == 0 || row == rows_ - 1 : column == 0 || column == columns_ - 1;
  }

  void cross_row(int row, std::vector<std::uint32_t>& out) {
    out.resize(static_cast<std::size_t>(columns_) + 1);
    for (int column = -1; column < columns_; ++column)
      out[static_cast<std::size_t>(column + 1)] = cross(column, row, 1);
  }

  void march_row(int row, const std::vector<std::uint32_t>& above, const std::vector<std::uint32_t>& below) {
    std::uint32_t left = none;  // beyond the first line nothing is inside
    for (int column = -1; column < columns_; ++column) {
      const auto i = static_cast<std::size_t>(column + 1);
      const std::uint32_t right = cross(column + 1, row, 0);
      if (net_.too_many) return;
      march_cell(column, row, {above[i], right, below[i], left});
      left = right;
    }
  }

  /// `side`: from grid point k to k + 1, counter-clockwise from (column, row).
  void march_cell(int column, int row, const std::array<std::uint32_t, 4>& side) {
    const std::array<double, 4> corner{value(column, row), value(column + 1, row), value(column + 1, row + 1),
                                       value(column, row + 1)};
    std::array<int, 2> out_side{}, in_side{};
    int pieces = 0, ends = 0;
    for (int k = 0; k < 4; ++k) {
      if (side[static_cast<std::size_t>(k)] == none) continue;
      if (corner[static_cast<std::size_t>(k)] >= threshold_) {
        out_side[static_cast<std::size_t>(pieces++)] = k;
      } else {
        in_side[static_cast<std::size_t>(ends++)] = k;
      }
    }
    const Cell cell{corner, place(column, row), place(column + 1, row + 1), side};
    if (pieces == 1) connect(cell, out_side[0], in_side[0], -1);
    if (pieces == 2) connect_saddle(cell, out_side);
  }

  struct Cell {
    std::array<double, 4> corner;
    glm::dvec2 low, high;
    std::array<std::uint32_t, 4> side;
  };

  /// Two arcs: around the inside corners, or where the saddle between them is inside, around the others.
  void connect_saddle(const Cell& cell, const std::array<int, 2>& out_side) {
    const std::array<double, 4>& v = cell.corner;
    const double saddle = (v[0] * v[2] - v[1] * v[3]) / ((v[0] - v[1]) + (v[2] - v[3]));
    for (const int k : out_side) {
      const bool through = saddle >= threshold_;
      connect(cell, k, through ? (k + 1) % 4 : (k + 3) % 4, through ? (k + 1) % 4 : k);
    }
  }

  /// The line begins where the way around the cell leaves the region: at side `from`. `around`: the corner
  /// that an arc of a saddle goes around, or -1.
  void connect(const Cell& cell, int from, int to, int around) {
    const std::uint32_t begin = cell.side[static_cast<std::size_t>(from)];
    const std::uint32_t end = cell.side[static_cast<std::size_t>(to)];
    net_.next.resize(std::max<std::size_t>(net_.next.size(), begin + std::size_t{1}), none);
    net_.next[begin] = end;
    const auto first = static_cast<std::uint32_t>(net_.bends.size());
    bend_hyperbola(cell.corner, cell.low, cell.high, net_.gates[begin].at, net_.gates[end].at,
                   half_tolerance_ * (1 - saddle_gap), net_.bends);
    if (around >= 0) pull_to_corner(cell, around, first);
    if (around >= 0 || net_.bends.size() > first) net_.gates[begin].forced = net_.gates[end].forced = true;
    if (net_.bends.size() > first)
      pieces_.push_back({begin, first, static_cast<std::uint32_t>(net_.bends.size())});
  }

  void pull_to_corner(const Cell& cell, int around, std::size_t first) {
    const glm::dvec2 corner(around == 1 || around == 2 ? cell.high.x : cell.low.x,
                            around >= 2 ? cell.high.y : cell.low.y);
    for (std::size_t i = first; i < net_.bends.size(); ++i)
      net_.bends[i] += saddle_gap * (corner - net_.bends[i]);
  }

  /// From the order in which cells were met to the order of gates.
  void sort_bends() {
    std::sort(pieces_.begin(), pieces_.end(), [](const Bends& a, const Bends& b) { return a.gate < b.gate; });
    std::vector<glm::dvec2> sorted;
    sorted.reserve(net_.bends.size());
    net_.first_bend.assign(net_.gates.size() + 1, 0);
    std::size_t piece = 0;
    for (std::size_t gate = 0; gate < net_.gates.size(); ++gate) {
      net_.first_bend[gate] = static_cast<std::uint32_t>(sorted.size());
      if (piece == pieces_.size() || pieces_[piece].gate != gate) continue;
      sorted.insert(sorted.end(), net_.bends.begin() + pieces_[piece].first,
                    net_.bends.begin() + pieces_[piece].last);
      ++piece;
    }
    net_.first_bend.back() = static_cast<std::uint32_t>(sorted.size());
    net_.bends = std::move(sorted);
  }

  const AlphaSheet& sheet_;
  const int columns_, rows_;
  const double threshold_, half_tolerance_;
  const std::size_t most_gates_;
  GateNet net_;
  std::vector<Bends> pieces_;
};

}  // namespace

GateNet march(const AlphaSheet& sheet, double threshold, double half_tolerance, std::size_t most_gates) {
  return Marcher(sheet, threshold, half_tolerance, most_gates).run();
}

}  // namespace tenebra::stage
