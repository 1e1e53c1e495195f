// Writes bytes to a pipe, or whatever standard output is, in a way that can be stopped while it waits.
#pragma once

#include <string_view>

#include <tenebra/expected.h>
#include <tenebra/stop_flag.h>

namespace tenebra::io {

/// Writes all of `bytes` to standard output. Waits for the reader as long as that takes; once `stop` is
/// requested, for a quarter of a second in which it takes nothing at most, and then fails with "stopped".
/// Other failures are sentences.
Expected<void> write_to_stdout(std::string_view bytes, const StopFlag* stop);

/// Whether a person would see the bytes.
bool stdout_is_terminal();

}  // namespace tenebra::io
