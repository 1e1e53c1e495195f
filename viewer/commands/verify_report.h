// What `tenebra verify` found, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oracle/fraction_check.h"
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

/// The visible fractions of one light with an area in one frame, checked.
struct CheckedFractions {
  int frame = 0;
  int light = 0;
  int width = 0;
  double promise = 0;  ///< how far a fraction may be off
  oracle::FractionCheck check;
  double check_s = 0;
};

struct Verification {
  std::vector<render::LogSetting> settings;  ///< what must be known to repeat it
  std::vector<CheckedMask> masks;
  std::vector<CheckedFractions> fractions;
  std::size_t planned_frames = 0;
  std::size_t frames = 0;  ///< that were checked whole
  double seconds = 0;      ///< with drawing and reading
  /// The most that coordinates differ in frames whose masks are compared with the file's numbers.
  std::optional<double> rounding_m;

  std::uint64_t wrong() const;
  oracle::ExactMaskStats stats() const;  ///< of the masks
  oracle::FractionStats fraction_stats() const;
};

/// 0: all are right, 2: some are wrong.
int exit_code_of(const Verification& verification);

std::string verification_text(const Verification& verification);
/// The wrong samples are named, the first 1,000 of each mask.
std::string verification_json(const Verification& verification);

}  // namespace tenebra::viewer
