#include "trade_session.h"
namespace tenebra::bench {
Expected<void> measure_trade_needs(TradeSession&) {
  return {};
}
}  // namespace tenebra::bench
