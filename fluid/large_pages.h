#pragma once

#include <cstddef>
#include <vector>

namespace spume::fluid {

/// Memory aligned to 64 bytes. A block of a megabyte or more begins at a page of 2 MB and asks the system for
/// such pages: fields and markers are walked through many at a time, and pages of 4 kB then cost a tenth of
/// a sub-step in first touches and looks at page tables. Throws std::bad_alloc.
void* allocateLargePages(std::size_t bytes);
/// Frees what allocateLargePages(bytes) returned.
void freeLargePages(void* block, std::size_t bytes) noexcept;

/// Allocator of long arrays.
template <typename T>
struct LargePageAllocator {
  using value_type = T;
  LargePageAllocator() = default;
  template <typename U>
  LargePageAllocator(const LargePageAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(allocateLargePages(n * sizeof(T))); }
  void deallocate(T* block, std::size_t n) noexcept { freeLargePages(block, n * sizeof(T)); }
  bool operator==(const LargePageAllocator&) const { return true; }
};

template <typename T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

/// Resizes; memory grows by a quarter more than is asked for, so that a number that rises slowly does not
/// move to new pages each time.
template <typename T>
void resizeWithRoom(LargeVector<T>& v, std::size_t n) {
  if (n > v.capacity()) v.reserve(n + n / 4);
  v.resize(n);
}

}  // namespace spume::fluid
