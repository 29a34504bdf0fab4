#include "foam/crew.h"

#include <thread>

namespace spume::foam {
namespace {

/// Looks at a flag before a waiting thread gives way to others: some 20 microseconds.
constexpr int kLooks = 1000;

/// Waits for a little while; longer when that has not helped `looks` times.
void waitALittle(int& looks) {
  if (++looks > kLooks) {
    std::this_thread::yield();
    return;
  }
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

void Crew::help(std::size_t member) {
  int looks = 0;
  for (std::uint32_t seen = 0; !dismissed_.load(std::memory_order_acquire);) {
    const std::uint32_t round = round_.load(std::memory_order_acquire);
    if (round == seen) {
      waitALittle(looks);
      continue;
    }
    takeTasks(member, seen = round);
    looks = 0;
  }
}

/// Its own tasks first, then those nobody has begun.
void Crew::takeTasks(std::size_t member, std::uint32_t round) {
  for (std::size_t turn = 0; turn < members_; ++turn)
    for (std::size_t task = (member + turn) % members_; task < tasks_.size(); task += members_)
      takeTask(task, round);
}

/// Rounds only grow and a round ends when all its tasks have been taken: who comes late finds none left.
void Crew::takeTask(std::size_t task, std::uint32_t round) {
  std::uint32_t last = tasks_[task].taken.load(std::memory_order_relaxed);
  if (last >= round || !tasks_[task].taken.compare_exchange_strong(last, round, std::memory_order_acquire))
    return;
  call_(body_, task);
  tasks_[task].done.store(round, std::memory_order_release);
}

void Crew::awaitTasks(std::uint32_t round) const {
  int looks = 0;
  for (const Task& task : tasks_)
    while (task.done.load(std::memory_order_acquire) != round) waitALittle(looks);
}

}  // namespace spume::foam
