// Replaces the global operators new and delete: large blocks ask the kernel for huge pages (2 MiB on x86-64).
//
// A solve fills vectors of tens of megabytes, by leaf and by row, many times a second. Each time the kernel hands out their pages
// one by one, 4 KiB each, and later reads miss the TLB. With huge pages the furnished room at 2.5 % takes 10 % less time on two
// threads, in the same memory (docs/design/performance.md). Nothing happens where the kernel's setting is "never".

#include <sys/mman.h>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ALVOR_ALLOCATIONS_ARE_CHECKED  // sanitizers have operators of their own
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALVOR_ALLOCATIONS_ARE_CHECKED
#endif

#ifndef ALVOR_ALLOCATIONS_ARE_CHECKED

namespace {

constexpr std::uintptr_t huge_page = std::uintptr_t{2} << 20;

/// Asks for huge pages within a block. They begin and end at multiples of their size.
void want_huge_pages(void* block, std::size_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = (begin + huge_page - 1) / huge_page * huge_page, end = (begin + size) / huge_page * huge_page;
  const int error_before = errno;
  // A refusal costs time only.
  if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
  errno = error_before;
}

}  // namespace

void* operator new(std::size_t size) {
  for (;;) {
    if (void* block = std::malloc(size > 0 ? size : 1)) {
      if (size >= huge_page) want_huge_pages(block, size);
      return block;
    }
    const std::new_handler make_room = std::get_new_handler();
    if (!make_room) throw std::bad_alloc();
    make_room();
  }
}

void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }

#endif
