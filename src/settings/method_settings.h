// How a picture shows light.
#pragma once

#include <array>
#include <optional>

#include "shade/display.h"

namespace tenebra::settings {

/// Exposures by tone: what --exposure auto stands for.
using AutoExposures = std::array<float, shade::tones.size()>;

/// The properties of a scene that decide how it is shown.
struct SceneDisplay {
  Transfer transfer = Transfer::srgb;
  std::optional<AutoExposures> exposures;  ///< none: not measured
};

}  // namespace tenebra::settings
