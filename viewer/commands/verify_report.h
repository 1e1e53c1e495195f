// What `tenebra verify` found, as text and as JSON.
#pragma once

#include <string>
#include <vector>

#include "oracle/mask_check.h"
#include "render/log/frame_log.h"

namespace tenebra::viewer {

/// One mask of one frame, checked.
struct CheckedMask {
  int frame = 0;
  int light = 0;  ///< as `tenebra info` numbers them
  int width = 0;  ///< pixels of a row of the mask
  oracle::MaskCheck check;
  double check_s = 0;  ///< what the exact answers took
};

struct Verification {
  std::vector<render::LogSetting> settings;  ///< what must be known to repeat it
  std::vector<CheckedMask> masks;
  std::size_t planned_frames = 0;
  std::size_t frames = 0;  ///< that were checked whole
  double seconds = 0;      ///< with drawing and reading

  std::uint64_t wrong() const;
  oracle::ExactMaskStats stats() const;
};

/// 0: all are right, 2: masks are wrong.
int exit_code_of(const Verification& verification);

std::string verification_text(const Verification& verification);
/// The wrong samples are named, the first 1,000 of each mask.
std::string verification_json(const Verification& verification);

}  // namespace tenebra::viewer
