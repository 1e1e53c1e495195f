// A log, or two beside each other, as one page that needs nothing else: no network, no other file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "log/log_file.h"
#include "log/page_pictures.h"

namespace tenebra::viewer {

/// The page in HTML: frame times over the animation, percentiles, stages, settings, pictures. `logs`: one or
/// two, each with at least one frame.
Expected<std::string> report_page(std::span<const LogFile> logs, const std::vector<PagePicture>& pictures);

}  // namespace tenebra::viewer
