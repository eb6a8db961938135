#include "bench/plan/heap.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> used{0}, most{0};

void* counted(void* block) {
  if (!block) throw std::bad_alloc();
  const std::size_t now = used += malloc_usable_size(block);
  std::size_t before = most;
  while (now > before && !most.compare_exchange_weak(before, now)) continue;
  return block;
}

void give_back(void* block) {
  if (block) used -= malloc_usable_size(block);
  std::free(block);
}

std::size_t rounded_up(std::size_t size, std::size_t alignment) { return (size + alignment - 1) / alignment * alignment; }

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(std::max<std::size_t>(size, 1))); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(align, rounded_up(std::max<std::size_t>(size, 1), align)));
}
void operator delete(void* block) noexcept { give_back(block); }
void operator delete(void* block, std::size_t) noexcept { give_back(block); }
void operator delete(void* block, std::align_val_t) noexcept { give_back(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { give_back(block); }

namespace alvor::bench {

std::size_t begin_heap_peak() { return most = used.load(); }
std::size_t heap_peak() { return most; }

}  // namespace alvor::bench
