#pragma once

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace spume::foam {

/// While it lives, numbers too small for full precision count as 0 on this thread. What a sweep in single
/// precision carries away from where something happens falls off to nothing within some rows, and arithmetic
/// with what has all but vanished is many times slower than with zeros.
class FlushTiny {
 public:
#if defined(__SSE__)
  FlushTiny() : before_(_mm_getcsr()) { _mm_setcsr(before_ | kFlushResults | kFlushOperands); }
  ~FlushTiny() { _mm_setcsr(before_); }

 private:
  static constexpr unsigned kFlushResults = 0x8000, kFlushOperands = 0x0040;
  unsigned before_;
#else
  FlushTiny() = default;
#endif

 public:
  FlushTiny(const FlushTiny&) = delete;
  FlushTiny& operator=(const FlushTiny&) = delete;
};

}  // namespace spume::foam
