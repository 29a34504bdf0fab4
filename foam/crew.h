#pragma once

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace spume::foam {

/// Threads that stay together through many short rounds of the same tasks. An iteration of conjugate
/// gradients is two rounds of some 100 microseconds each, which waking a worker for every one of them would
/// lengthen. Here helpers are called once, then watch for the next round, and a thread takes the tasks it had
/// last time, whose data its cache still holds. Every round is finished by whoever is there: should no helper
/// come, the leader does all.
class Crew {
 public:
  /// Calls work(crew) on this thread while the arena's other threads, one for each further task at most,
  /// stand by. `tasks` is the number of tasks of every round. `work` may not throw.
  template <typename Work>
  static void lead(std::size_t tasks, const Work& work) {
    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    Crew crew(tasks, std::min(tasks, threads));
    tbb::task_group helpers;
    for (std::size_t member = 1; member < crew.members_; ++member)
      helpers.run([&crew, member] { crew.help(member); });
    work(crew);
    crew.dismissed_.store(true, std::memory_order_release);
    helpers.wait();
  }

  std::size_t tasks() const { return tasks_.size(); }

  /// A round: body(task) for each task in [0, tasks), in no order, until all are done.
  template <typename Body>
  void forEachTask(const Body& body) {
    body_ = &body;
    call_ = [](const void* b, std::size_t task) { (*static_cast<const Body*>(b))(task); };
    const std::uint32_t round = round_.load(std::memory_order_relaxed) + 1;
    round_.store(round, std::memory_order_release);
    takeTasks(0, round);
    awaitTasks(round);
  }

 private:
  /// The last round in which somebody took the task, and in which it was done; a cache line each.
  struct alignas(64) Task {
    std::atomic<std::uint32_t> taken{0}, done{0};
  };

  Crew(std::size_t tasks, std::size_t members) : members_(std::max<std::size_t>(members, 1)), tasks_(tasks) {}

  void help(std::size_t member);
  void takeTasks(std::size_t member, std::uint32_t round);
  void takeTask(std::size_t task, std::uint32_t round);
  void awaitTasks(std::uint32_t round) const;

  std::size_t members_;
  std::vector<Task> tasks_;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<bool> dismissed_{false};
  /// What the round does. Read only by who has taken a task, so while the round lasts.
  const void* body_ = nullptr;
  void (*call_)(const void*, std::size_t) = nullptr;
};

}  // namespace spume::foam
