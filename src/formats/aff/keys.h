// BART's key frame blocks: `k name { transl ... rot ... scale ... visibility ... }`.
#pragma once

#include <optional>

#include <tenebra/animation.h>
#include "formats/aff/lexer.h"

namespace tenebra::formats {

struct AffKeys {
  std::optional<Track> translation;
  std::optional<Track> rotation;  ///< quaternions x, y, z, w as the file's axes give them: not always unit
  std::optional<Track> scale;
  std::optional<Track> visibility;
};

/// Reads `{ ... }`, after the block's name.
AffKeys read_key_block(AffLexer& in);

bool same_keys(const AffKeys& a, const AffKeys& b);
std::size_t memory_of(const AffKeys& keys);

}  // namespace tenebra::formats
