// Sections of docs/trade.md whose rows are pairs: as it is, and without.
#pragma once

#include <string>
#include <vector>

#include "bench/trade/trade_session.h"

namespace tenebra::bench {

inline constexpr const char* stages_title = "Stages switched off alone";
inline constexpr const char* needs_title = "Only what a scene requires";

/// `measured_by`: the paragraph on what measured it.
std::string stages_section(const std::string& measured_by, const std::vector<StageRow>& stages);
std::string needs_section(const std::string& measured_by, const std::vector<NeedRow>& needs);

}  // namespace tenebra::bench
