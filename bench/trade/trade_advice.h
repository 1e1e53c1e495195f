// Which setting to choose for what, said with the figures of the run.
#pragma once

#include <string>
#include <vector>

#include "bench/trade/trade_table.h"

namespace tenebra::bench {

using TradeTables = std::vector<const TradeTable*>;

/// --quality: what each preset sets.
std::string preset_section();

/// A few bullets each. They say what was measured, whatever it was.
std::string hard_advice(const TradeTables& tables);
std::string soft_advice(const TradeTables& tables);
std::string ao_advice(const TradeTables& tables);

}  // namespace tenebra::bench
