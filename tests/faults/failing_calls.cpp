// Makes one call of the system or of the allocator fail, for tests: preloaded (LD_PRELOAD) into the program.
//
//   FAIL_CALL   open, read, write, fsync, ftruncate, close, rename, mmap, thread or memory
//   FAIL_AT     which of these calls, from 1
//   FAIL_WITH   an error number; "short": half of the bytes are written, then ENOSPC; "once": a half is, and
//               nothing fails
//   FAIL_ON     "call": that one alone; "all": and all that follow
//   FAIL_UNDER  only files whose path begins like this count; those of calls without a file always do
//   FAIL_NOTE   a file, made when the call fails, with what it was
//
// No standard library: memory fails, too. What glibc calls inside itself is not seen, fopen and malloc are.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

constexpr std::size_t longest_path = 4096;

struct Plan {
  const char* call = "";
  long at = 0;
  int error = 0;
  bool partly = false;  ///< writes: half of the bytes
  bool all = false;
  const char* under = "";
  const char* note = "";
};

const char* text_of(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? text : "";
}

Plan read_plan() {
  Plan plan;
  plan.call = text_of("FAIL_CALL");
  plan.at = std::atol(text_of("FAIL_AT"));
  const char* with = text_of("FAIL_WITH");
  plan.partly = std::strcmp(with, "short") == 0 || std::strcmp(with, "once") == 0;
  plan.error = std::strcmp(with, "short") == 0 ? ENOSPC : std::atoi(with);
  plan.all = std::strcmp(text_of("FAIL_ON"), "all") == 0;
  plan.under = text_of("FAIL_UNDER");
  plan.note = text_of("FAIL_NOTE");
  return plan;
}

Plan plan;
std::atomic<long> count{0};
std::atomic<bool> ready{false};
std::atomic<int> full_file{-1};  ///< of which half was written

using Main = int (*)(int, char**, char**);
Main program_main = nullptr;
/// What libraries do before main is not the program's.
int start_main(int count_of_words, char** words, char** environment) {
  plan = read_plan();
  ready = true;
  return program_main(count_of_words, words, environment);
}

void note(const char* what) {
  const long file = ::syscall(SYS_openat, AT_FDCWD, plan.note, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  static_cast<void>(!::syscall(SYS_write, file, what, std::strlen(what)));
  ::syscall(SYS_close, file);
}

/// Whether this call, of `path`, is to fail.
bool fails(const char* call, const char* path) {
  if (!ready || std::strcmp(call, plan.call) != 0) return false;
  if (std::strncmp(path, plan.under, std::strlen(plan.under)) != 0 && *path != '\0') return false;
  const long number = ++count;
  if (number == plan.at) note(path);
  return number == plan.at || (plan.all && number > plan.at);
}

bool fails_on(const char* call, int file) {
  if (!ready || std::strcmp(call, plan.call) != 0) return false;
  char link[64], path[longest_path] = {};
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  if (::syscall(SYS_readlink, link, path, sizeof path - 1) <= 0) return false;
  return fails(call, path);
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

int open_file(int folder, const char* path, int flags, mode_t mode) {
  if (fails("open", path)) {
    errno = plan.error;
    return -1;
  }
  return static_cast<int>(::syscall(SYS_openat, folder, path, flags, mode));
}

/// Whether this thread loads a library: glibc's loader crashes where that memory fails (oneTBB loads its
/// allocator so).
thread_local bool loading = false;

bool memory_fails() {
  if (loading || !fails("memory", "")) return false;
  errno = ENOMEM;
  return true;
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int words, char** word, Main init, void (*fini)(), void (*end)(),
                      void* stack) {
  using Start = int (*)(Main, int, char**, Main, void (*)(), void (*)(), void*);
  program_main = main;
  return next<Start>("__libc_start_main")(start_main, words, word, init, fini, end, stack);
}

#define OPEN_MODE(flags)         \
  mode_t mode = 0;               \
  if ((flags)&O_CREAT) {         \
    va_list rest;                \
    va_start(rest, flags);       \
    mode = va_arg(rest, mode_t); \
    va_end(rest);                \
  }

int open(const char* path, int flags, ...) {
  OPEN_MODE(flags)
  return open_file(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  OPEN_MODE(flags)
  return open_file(AT_FDCWD, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
  OPEN_MODE(flags)
  return open_file(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
  OPEN_MODE(flags)
  return open_file(folder, path, flags, mode);
}

std::FILE* fopen(const char* path, const char* mode) {
  if (fails("open", path)) {
    errno = plan.error;
    return nullptr;
  }
  static const auto real = next<std::FILE* (*)(const char*, const char*)>("fopen");
  return real(path, mode);
}
std::FILE* fopen64(const char* path, const char* mode) {
  return fopen(path, mode);
}

ssize_t read(int file, void* to, size_t size) {
  if (fails_on("read", file)) {
    errno = plan.error;
    return -1;
  }
  return ::syscall(SYS_read, file, to, size);
}

ssize_t write(int file, const void* from, size_t size) {
  if (full_file == file) {
    full_file = -1;
    errno = plan.error;
    return -1;
  }
  if (fails_on("write", file)) {
    if (plan.partly) {
      full_file = plan.error != 0 ? file : -1;  // what is left of these bytes comes next
      return ::syscall(SYS_write, file, from, size / 2 + (size == 1 ? 1 : 0));
    }
    if (plan.error != 0) {
      errno = plan.error;
      return -1;
    }
  }
  return ::syscall(SYS_write, file, from, size);
}

#define FAILING(call, type, ...)  \
  if (call) {                     \
    errno = plan.error;           \
    return static_cast<type>(-1); \
  }                               \
  return static_cast<type>(::syscall(__VA_ARGS__))

int fsync(int file) {
  FAILING(fails_on("fsync", file), int, SYS_fsync, file);
}
int ftruncate(int file, off_t size) {
  FAILING(fails_on("ftruncate", file), int, SYS_ftruncate, file, size);
}
int ftruncate64(int file, off64_t size) {
  return ftruncate(file, size);
}
int close(int file) {
  const bool failing = fails_on("close", file);
  const long closed = ::syscall(SYS_close, file);  // it is closed, whatever close says
  if (!failing) return static_cast<int>(closed);
  errno = plan.error;
  return -1;
}
int rename(const char* from, const char* to) {
  FAILING(fails("rename", from), int, SYS_rename, from, to);
}

void* mmap(void* where, size_t size, int access, int flags, int file, off_t offset) {
  if (fails("mmap", "")) {
    errno = plan.error;
    return MAP_FAILED;
  }
  return reinterpret_cast<void*>(::syscall(SYS_mmap, where, size, access, flags, file, offset));
}
void* mmap64(void* where, size_t size, int access, int flags, int file, off64_t offset) {
  return mmap(where, size, access, flags, file, offset);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) {
  if (fails("thread", "")) return EAGAIN;
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto real = next<Create>("pthread_create");
  return real(thread, attributes, body, argument);
}

void* dlopen(const char* file, int mode) {
  static const auto real = next<void* (*)(const char*, int)>("dlopen");
  const bool outer = loading;
  loading = true;
  void* const library = real(file, mode);
  loading = outer;
  return library;
}

void* malloc(std::size_t size) {
  return memory_fails() ? nullptr : __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) {
  return memory_fails() ? nullptr : __libc_calloc(number, size);
}
void* realloc(void* old, std::size_t size) {
  return memory_fails() ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memory_fails() ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return aligned_alloc(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  if (memory_fails()) return ENOMEM;
  *out = __libc_memalign(alignment, size);
  return *out != nullptr ? 0 : ENOMEM;
}
}
