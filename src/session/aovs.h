// Layers of a frame beside its colours, by their words: "depth", "id", ...
#pragma once

#include <string>

#include <tenebra/expected.h>
#include "render/renderer.h"

namespace tenebra::session {

/// "depth,id,normal": some of the words, in any case.
Expected<render::AovChoice> parse_aovs(const std::string& text);

/// The words of those that are wanted: "depth,id".
std::string aov_words(render::AovChoice aovs);

/// Fails if `settings` do not compute what `aovs` need.
Expected<void> check_aovs(const render::AovChoice& aovs, const render::RenderSettings& settings);

}  // namespace tenebra::session
