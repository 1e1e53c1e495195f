// What the converter may use of the machine.
#pragma once

#include <cstdint>

namespace tenebra::converter {

/// Limits this process, for a file of `file_bytes`: memory 1 GiB + 32 times the file, at most 16 GiB;
/// processor time 60 s + 1 s a MiB; no files written, no core file. It ends with the thread that started it.
void limit_this_process(std::uint64_t file_bytes);

}  // namespace tenebra::converter
