// --config FILE: options of a command from a file.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace tenebra::viewer {

/// Adds --config FILE, behind all other options: it is read after them. The file has lines `name = value`
/// with the long names of `command`'s options
/// ("size = 800x600", "quiet = true", "no-cast = [a, b]"), # comments, and sections: what stands under
/// [render], [view], [verify] or [trade] is for that command only. What the command line says counts more
/// than the file. A failure is one sentence with file and name; names and sections that no command reads are
/// failures too, in sections of other commands as well.
void add_config_option(CLI::App& command);

/// The file that was given, once the options are read; "" if none.
std::string config_file_of(const CLI::App& command);

}  // namespace tenebra::viewer
