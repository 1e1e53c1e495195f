// How the program ends where no more memory is to be had.
#pragma once

#include <exception>
#include <string>

namespace tenebra::viewer {

/// From here on an exception that nobody catches (of memory while a failure is reported, or of a thread) ends
/// the program with a sentence and the exit code of no_memory_code(), and no destructor runs. Files are whole
/// or absent all the same (OutputFile, Journal).
void set_last_words();

/// Where --memory bounds a window: libraries that do not ask whether they got memory (Mesa, LLVM, Dear ImGui)
/// crash or abort without it. If memory has failed or hardly any is left, that ends the program as end of
/// memory does.
void expect_crashes_without_memory();

/// Whether it says that there is no memory, or none for a thread's stack.
bool is_memory_failure(const std::exception& error);

/// That memory has run out, and what bounds it.
std::string no_memory_sentence();
/// Prints the same without needing any memory.
void print_no_memory();

/// For a program that ran out of memory: another try is worth it, but under the same limit.
int no_memory_code();

}  // namespace tenebra::viewer
