#include "bench/picture/picture_errors.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace tenebra::bench {
namespace {

double root_mean(double sum, std::size_t count) {
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

}  // namespace

PictureError picture_error(const io::Image8& picture, const io::Image8& reference) {
  assert(picture.pixels.size() == reference.pixels.size());
  double sum = 0;
  std::size_t missed = 0;
  const std::size_t pixels = picture.pixels.size() / 3;
  for (std::size_t i = 0; i < pixels; ++i) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const int off = int{picture.pixels[3 * i + c]} - int{reference.pixels[3 * i + c]};
      sum += off * off;
      largest = std::max(largest, std::abs(off));
    }
    missed += largest > missed_step ? 1 : 0;
  }
  return {root_mean(sum, 3 * pixels),
          pixels == 0 ? 0 : static_cast<double>(missed) / static_cast<double>(pixels)};
}

double ChangeSums::rms() const {
  return root_mean(change, values);
}
double ChangeSums::reference_rms() const {
  return root_mean(reference, values);
}
double ChangeSums::flicker() const {
  return root_mean(apart, values);
}

void add_change(const io::Image8& before, const io::Image8& after, const io::Image8& reference_before,
                const io::Image8& reference_after, ChangeSums& sums) {
  assert(before.pixels.size() == reference_after.pixels.size());
  for (std::size_t i = 0; i < after.pixels.size(); ++i) {
    const int change = int{after.pixels[i]} - int{before.pixels[i]},
              reference = int{reference_after.pixels[i]} - int{reference_before.pixels[i]};
    sums.change += change * change;
    sums.reference += reference * reference;
    sums.apart += (change - reference) * (change - reference);
  }
  sums.values += after.pixels.size();
}

}  // namespace tenebra::bench
