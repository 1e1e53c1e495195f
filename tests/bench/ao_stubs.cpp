#include "ao_session.h"
namespace tenebra::bench {
Expected<void> measure_surface(AoSession&) {
  return {};
}
Expected<void> measure_frames(AoSession&) {
  return {};
}
Expected<void> measure_flicker(AoSession&) {
  return {};
}
}  // namespace tenebra::bench
