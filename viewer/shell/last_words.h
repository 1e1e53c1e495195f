// How the program ends where no more memory is to be had.
#pragma once

#include <exception>

namespace tenebra::viewer {

/// From here on an exception that nobody catches (memory that fails while a failure is told, a thread's own)
/// ends the program with a sentence and the exit code of no_memory_code(), and no destructor runs. Files are
/// whole or absent all the same (OutputFile, Journal).
void set_last_words();

/// Whether it says that there is no memory, or none for a thread's stack.
bool is_memory_failure(const std::exception& error);

/// Tells that memory has run out, and what bounds it, without any memory.
void print_no_memory();

/// For a program that ran out of memory: another try is worth it, but under the same limit.
int no_memory_code();

}  // namespace tenebra::viewer
