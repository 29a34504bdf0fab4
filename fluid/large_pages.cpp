#include "fluid/large_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <new>

namespace spume::fluid {
namespace {

constexpr std::size_t kLine = 64, kPage = std::size_t{1} << 21;  // [bytes]
/// A block that would fill less than half of a page gets none; nor does the end of a longer one.
constexpr std::size_t kLeast = kPage / 2;

std::align_val_t alignmentOf(std::size_t bytes) { return std::align_val_t{bytes < kLeast ? kLine : kPage}; }

/// Bytes of large pages worth asking for, from the block's beginning on.
std::size_t inLargePages(std::size_t bytes) { return (bytes + kPage - kLeast) / kPage * kPage; }

}  // namespace

void* allocateLargePages(std::size_t bytes) {
  const std::size_t large = inLargePages(bytes), held = bytes < large ? large : bytes;
  void* block = ::operator new(held, alignmentOf(bytes));
#ifdef __linux__
  if (large > 0) madvise(block, large, MADV_HUGEPAGE);  // advice: whether it is taken changes nothing else
#endif
  return block;
}

void freeLargePages(void* block, std::size_t bytes) noexcept { ::operator delete(block, alignmentOf(bytes)); }

}  // namespace spume::fluid
