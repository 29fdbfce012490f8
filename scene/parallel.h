#pragma once

#include <functional>
#include <memory>

namespace lightwell {

/// Calls body(begin, end) for pieces of at most `grain` indices that cover [0, count) once. Pieces
/// are the same for any number of threads, so a body that writes only to its own indices gives the
/// same bits on one thread or on many. The first exception thrown by a body is rethrown here.
void parallel_for(int count, int grain, const std::function<void(int begin, int end)>& body);

/// Limits parallel_for to at most `threads` threads during the life of the object; 0 means one per
/// core.
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

/// Number of threads that parallel_for uses at present.
int thread_count();

}  // namespace lightwell
