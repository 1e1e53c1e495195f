// Large pages of memory for a whole program.
#pragma once

namespace tenebra::base {

/// For main() to begin with; a library must not. glibc asks the system for large pages only if GLIBC_TUNABLES
/// says so when the program starts: sets that and starts the program again, in the same process. Returns if
/// the system does not wait to be asked, GLIBC_TUNABLES is the user's, or it cannot be done.
void restart_with_large_pages(char** argv);

}  // namespace tenebra::base
