// All OpenGL that this machine has for contexts without a window.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tenebra::gl {

/// A device, or a platform without devices.
struct Offer {
  std::string name;     ///< "device 0", "surfaceless" or "OSMesa"
  std::string context;  ///< the word for it of context_choice_from_name; empty: it has none of its own
  std::string lacks;    ///< why it has no OpenGL 4.5 core; empty: it has, and the rest is known
  std::string vendor, renderer, version;
  bool software = false;                                    ///< it draws on the CPU
  bool taken = false;                                       ///< by ContextKind::automatic
  std::vector<std::pair<std::string, long long>> limits{};  ///< of OpenGL, by name
};

/// Makes a context on each, one after another; afterwards none is current.
std::vector<Offer> survey();

}  // namespace tenebra::gl
