// Replaces the global operators new and delete: blocks of all sizes lie in huge pages (2 MiB on x86-64), where the kernel gives
// any.
//
// A solve fills vectors of tens of megabytes, by leaf and by row, many times a second, and keeps a few kilobytes for each row.
// Each time the kernel hands out their pages one by one, 4 KiB each, and later reads miss the TLB. With huge pages a solve takes
// about three quarters of the time (docs/design/performance.md); where the kernel's setting is "never", it gives none.

#include <cstdlib>

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define ALVOR_ALLOCATIONS_ARE_CHECKED  // sanitizers have operators of their own
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ALVOR_ALLOCATIONS_ARE_CHECKED
#endif

#if defined(__GLIBC__) && !defined(ALVOR_ALLOCATIONS_ARE_CHECKED)

#include <malloc.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <new>

namespace {

constexpr std::uintptr_t huge_page = std::uintptr_t{2} << 20;
// malloc takes memory from the kernel in heaps of 64 MiB that begin at multiples of their size (but the first one). The first
// huge page of a heap is not asked for on its own: a server has many threads whose heaps never grow beyond it.
constexpr std::uintptr_t pages_of_heap = 32;
// Huge pages that are asked for beyond a block, in vain where nothing is mapped yet. malloc writes behind the block that it
// returns, and a page of which 4 KiB were touched before it is asked for does not become huge.
constexpr std::uintptr_t pages_ahead = 8;

/// Pages that this thread has asked for, by the last bits of their number.
thread_local std::array<std::uintptr_t, 64> asked{};

/// Asks for huge pages around a block and ahead of it. Not if the block lies in one page that this thread has asked for lately;
/// one that crosses into the next page always asks, a few hundred to a few thousand times in a solve.
void want_huge_pages(void* block, std::size_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = begin / huge_page, last = (begin + size) / huge_page;
  if (first == last && (asked[first % asked.size()] == first || first % pages_of_heap == 0)) return;
  for (const std::uintptr_t page : {first, last}) asked[page % asked.size()] = page;
  const int error_before = errno;
  // A refusal costs time only.
  madvise(reinterpret_cast<void*>(first * huge_page), (last - first + pages_ahead) * huge_page, MADV_HUGEPAGE);
  errno = error_before;
}

/// Lets malloc take memory in large steps, as pages cannot be huge where less is mapped. That ends the adjustment of its two
/// other limits as it goes; they are set to what they come to once a large block was freed.
[[gnu::constructor]] void take_large_steps() {
  constexpr int mebibyte = 1 << 20;
  mallopt(M_TOP_PAD, 16 * mebibyte);
  mallopt(M_MMAP_THRESHOLD, 32 * mebibyte);
  mallopt(M_TRIM_THRESHOLD, 64 * mebibyte);
}

}  // namespace

void* operator new(std::size_t size) {
  for (;;) {
    if (void* block = std::malloc(size > 0 ? size : 1)) {
      want_huge_pages(block, size);
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
