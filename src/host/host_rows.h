// A host's lists with the top row first and triangles counted from 0.
#pragma once

#include <tenebra/host_frame.h>

namespace tenebra::host {

/// In place.
void arrange(const HostLayout& layout, HostFrame& frame);

}  // namespace tenebra::host
