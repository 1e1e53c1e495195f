// The state of an OpenGL context that drawing changes, as it was: for contexts that somebody else draws in,
// too.
#pragma once

#include <array>
#include <vector>

namespace tenebra::gl {

/// Notes what passes (src/raster) and readbacks change of the current context, and sets it so again when it
/// goes; in between everything that they count on has OpenGL's initial values. Objects and the error flag are
/// not part of it: older errors of the host's are taken.
class KeptState {
public:
  KeptState();
  KeptState(const KeptState&) = delete;
  KeptState& operator=(const KeptState&) = delete;
  ~KeptState();

private:
  static constexpr std::size_t switch_count = 26, packing_count = 8, binding_count = 4, value_count = 4;
  std::array<unsigned char, switch_count> switches_{};
  std::array<int, packing_count> packing_{};
  std::array<int, binding_count> bindings_{};
  std::array<int, value_count> values_{};  // polygon mode, depth function, clip control
  unsigned char depth_mask_ = 0;
  std::vector<unsigned char> blends_, color_masks_, scissors_;  // of each draw buffer; of each viewport
  std::vector<float> viewports_;
  std::vector<double> depth_ranges_;
};

}  // namespace tenebra::gl
