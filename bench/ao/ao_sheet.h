// A contact sheet of the paper's Figure 6: the corner as each table shows it, its error beside it, and
// figures below.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/ao/ao_peer.h"
#include "bench/ao/ao_receivers.h"
#include "io/image.h"

namespace tenebra::bench {

class Sheet {
public:
  /// `truth`: occlusion at corner_receivers(ball), shown first.
  Sheet(const Ball& ball, const AoPeer& peer, std::span<const float> truth);

  /// A cell: the corner with `values`, beside it |values - truth| x 30, below it two lines of text (digits,
  /// letters of "sm", ".", "x"; others are left blank).
  void add(std::span<const float> values, const std::string& title, const std::string& caption);

  /// Four cells to a row; RGB.
  io::Image8 picture() const;

private:
  struct Seen {
    int wall = -1;             // 0..2; -1: the object or nothing
    float x = 0, y = 0;        // in cells of the grid
    std::uint8_t shade = 255;  // where there is no wall
  };
  struct Cell {
    std::vector<float> values;
    std::string title, caption;
  };
  std::uint8_t shade(const Seen& seen, std::span<const float> values, bool difference) const;

  std::vector<Seen> seen_;  // one per pixel of a cell
  std::vector<float> truth_;
  std::vector<Cell> cells_;
};

}  // namespace tenebra::bench
