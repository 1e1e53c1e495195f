// Pixels as the bytes of a PNG file, quickly: rows filtered by Sub or Up, and libdeflate's first level.
#pragma once

#include <string>

#include <tenebra/expected.h>
#include "io/image.h"

namespace tenebra::io {

/// `image` has 1, 3 or 4 channels and as many pixels as it says, at most 2^28. Fails if there is no memory.
Expected<std::string> png_of_pixels(const Image8& image);

}  // namespace tenebra::io
