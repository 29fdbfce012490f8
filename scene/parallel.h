#pragma once

#include <functional>
#include <memory>

namespace lightwell {

/// Calls body(begin, end) for pieces of at most `grain` indices that cover [0, count) once. Pieces
/// are the same for any number of threads, so a body that writes only to its own indices gives the
/// same bits on one thread or on many. The first exception thrown by a body is rethrown here.
void parallel_for(int count, int grain, const std::function<void(int begin, int end)>& body);

/// Keeps parallel_for to at most `threads` threads while it lives; 0 means one per core.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How many threads parallel_for uses now.
int thread_count();

}  // namespace lightwell
