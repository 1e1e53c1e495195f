#include "bench/common/memory_meter.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

struct Held {
  std::atomic<std::ptrdiff_t> now{0}, most{0};

  void add(std::ptrdiff_t bytes) {
    const std::ptrdiff_t sum = now.fetch_add(bytes, std::memory_order_relaxed) + bytes;
    std::ptrdiff_t before = most.load(std::memory_order_relaxed);
    while (sum > before && !most.compare_exchange_weak(before, sum, std::memory_order_relaxed)) continue;
  }
};
// Constant-initialised and never destroyed: allocations come before main and after it.
constinit Held held;

std::ptrdiff_t bytes_of(void* memory) {
  return static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
}

void* counted(std::size_t size, std::size_t alignment) {
  const std::size_t least = std::max<std::size_t>(size, 1);
  void* const memory = alignment <= alignof(std::max_align_t)
                           ? std::malloc(least)
                           : std::aligned_alloc(alignment, (least + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  held.add(bytes_of(memory));
  return memory;
}

void give_back(void* memory) {
  held.add(-bytes_of(memory));
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size, 1);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  give_back(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  give_back(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  give_back(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  give_back(memory);
}

namespace tenebra::bench {

void count_memory(std::ptrdiff_t bytes) {
  held.add(bytes);
}

MemoryMeter::MemoryMeter() : before_(held.now) {
  held.most = before_;
}

double MemoryMeter::mb() const {
  return static_cast<double>(held.most - before_) / 1e6;
}

}  // namespace tenebra::bench
