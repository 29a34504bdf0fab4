#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace spume::foam {

/// Scratch memory that is written before it is read: resizing neither keeps nor clears what it holds, so that
/// new pages are first touched by the threads that fill them, and a later call of the same size costs
/// nothing.
template <typename T>
class RawBuffer {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  RawBuffer() = default;
  /// A copy holds the same, whatever of it has a meaning.
  RawBuffer(const RawBuffer& other) {
    if (other.room_ == 0) return;
    allocate(other.room_);
    std::memcpy(memory_.get(), other.memory_.get(), room_ * sizeof(T));
  }
  RawBuffer(RawBuffer&& other) noexcept
      : memory_(std::move(other.memory_)), room_(std::exchange(other.room_, 0)) {}
  RawBuffer& operator=(RawBuffer other) noexcept {
    std::swap(memory_, other.memory_), std::swap(room_, other.room_);
    return *this;
  }

  /// Room for `count` values of no meaning; a little more is taken, so that a size that creeps up does not
  /// cost new memory each time.
  void resize(std::size_t count) {
    if (count <= room_) return;
    memory_.reset(), room_ = 0;
    allocate(count + count / 8);
  }
  T* data() { return memory_.get(); }
  const T* data() const { return memory_.get(); }
  T& operator[](std::size_t k) { return memory_.get()[k]; }
  const T& operator[](std::size_t k) const { return memory_.get()[k]; }

 private:
  static constexpr std::align_val_t kAlignment{alignof(T)};

  struct Release {
    void operator()(T* memory) const { ::operator delete(memory, kAlignment); }
  };

  void allocate(std::size_t room) {
    memory_.reset(static_cast<T*>(::operator new(room * sizeof(T), kAlignment)));
    room_ = room;
  }

  std::unique_ptr<T, Release> memory_;
  std::size_t room_ = 0;
};

}  // namespace spume::foam
