#include "scene/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#ifndef LIGHTWELL_STD_THREADS
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_group.h>
#endif

namespace lightwell {

#ifdef LIGHTWELL_STD_THREADS
// The thread sanitizer cannot see inside Debian's oneTBB; plain threads keep its reports
// trustworthy.
namespace {
std::atomic<int> thread_limit{0};
}

int thread_count() {
  const int limit = thread_limit;
  return limit > 0 ? limit : std::max(1u, std::thread::hardware_concurrency());
}

void parallel_for(int count, int grain, const std::function<void(int, int)>& body) {
  grain = std::max(grain, 1);
  std::atomic<int> next{0};
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto work = [&] {
    for (int begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain)) {
      try {
        body(begin, std::min(begin + grain, count));
      } catch (...) {
        const std::lock_guard lock(error_mutex);
        if (!error) error = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::jthread> threads;
  for (int t = 1; t < std::min(thread_count(), (count + grain - 1) / grain); ++t) {
    threads.emplace_back(work);
  }
  work();
  threads.clear();
  if (error) std::rethrow_exception(error);
}

struct ThreadLimit::Impl {
  int previous = 0;
};
ThreadLimit::ThreadLimit(int threads) : impl_(std::make_unique<Impl>()) {
  impl_->previous = thread_limit.exchange(threads);
}
ThreadLimit::~ThreadLimit() {
  thread_limit = impl_->previous;
}

#else

int thread_count() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(int count, int grain, const std::function<void(int, int)>& body) {
  grain = std::max(grain, 1);
  const int pieces = (count + grain - 1) / grain;
  // Without fp_settings a task takes the floating-point mode of whatever started oneTBB in the
  // process. After Embree's tree building that mode flushes denormals to zero.
  tbb::task_group_context callers_mode(
      tbb::task_group_context::bound,
      tbb::task_group_context::default_traits | tbb::task_group_context::fp_settings);
  tbb::parallel_for(
      0, pieces, [&](int piece) { body(piece * grain, std::min((piece + 1) * grain, count)); },
      callers_mode);
}

// Made in place: a copy of a global_control limits nothing.
struct ThreadLimit::Impl {
  explicit Impl(std::size_t threads)
      : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};
ThreadLimit::ThreadLimit(int threads)
    : impl_(std::make_unique<Impl>(
          static_cast<std::size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))) {}
ThreadLimit::~ThreadLimit() = default;

#endif

}  // namespace lightwell
