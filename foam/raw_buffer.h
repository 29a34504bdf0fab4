#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>

namespace spume::foam {

/// Scratch memory that is written before it is read: resizing neither keeps nor clears what it holds, so that
/// new pages are first touched by the threads that fill them, and a later call of the same size costs
/// nothing.
template <typename T>
class RawBuffer {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  /// Room for `count` values of no meaning; a little more is taken, so that a size that creeps up does not
  /// cost new memory each time.
  void resize(std::size_t count) {
    if (count <= room_) return;
    room_ = count + count / 8;
    memory_.reset();
    memory_.reset(static_cast<T*>(::operator new(room_ * sizeof(T))));
  }
  T* data() { return memory_.get(); }
  const T* data() const { return memory_.get(); }
  T& operator[](std::size_t k) { return memory_.get()[k]; }
  const T& operator[](std::size_t k) const { return memory_.get()[k]; }

 private:
  struct Release {
    void operator()(T* memory) const { ::operator delete(memory); }
  };
  std::unique_ptr<T, Release> memory_;
  std::size_t room_ = 0;
};

}  // namespace spume::foam
