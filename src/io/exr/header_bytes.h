// The bytes of an OpenEXR header, looked at before the library takes memory for what they state.
#pragma once

#include <string_view>

#include <tenebra/expected.h>

namespace tenebra::io::exr {

/// Fails with a phrase for what does not begin as an OpenEXR file does, and where an attribute states more
/// bytes than the file has, or not as many as its value takes.
Expected<void> check_header_bytes(std::string_view bytes);

}  // namespace tenebra::io::exr
