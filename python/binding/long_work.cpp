#include "python/binding/long_work.h"

#include <nanobind/stl/string.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace nb = nanobind;

namespace lightwell::python {
namespace {

struct PhaseShare {
  std::string phase{};
  double share = 0.0;
};

/// Messages between the working thread and the waiting thread.
class Exchange {
 public:
  /// Called by the working thread: notes progress, and returns whether the work is to go on.
  bool note(std::string_view phase, double share) {
    const std::lock_guard lock(mutex_);
    if (news_.empty() || news_.back().phase != phase) news_.push_back({std::string(phase)});
    news_.back().share = share;
    return !stops_;
  }
  void finish(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    error_ = std::move(error);
    is_done_ = true;
    done_.notify_one();
  }

  /// Called by the waiting thread: waits for the end, a twentieth of a second at most.
  bool is_done_after_waiting() {
    using namespace std::chrono_literals;
    std::unique_lock lock(mutex_);
    return done_.wait_for(lock, 50ms, [&] { return is_done_; });
  }
  /// The latest share of each phase since the last call.
  std::vector<PhaseShare> take_news() {
    const std::lock_guard lock(mutex_);
    return std::exchange(news_, {});
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  std::exception_ptr error() const { return error_; }

 private:
  std::mutex mutex_;
  std::condition_variable done_;
  std::vector<PhaseShare> news_;
  std::exception_ptr error_;
  bool stops_ = false, is_done_ = false;
};

/// The threads that wait for work, and whether the interpreter is about to end. Python ends such a
/// thread where it asks for the lock afterwards, which no C++ frame survives; so they stop before.
class WaitingThreads {
 public:
  void enter() {
    const std::lock_guard lock(mutex_);
    if (is_ending_) throw std::runtime_error("Python is about to end, so no work can begin");
    ++count_;
  }
  void leave() {
    const std::lock_guard lock(mutex_);
    --count_;
    left_.notify_all();
  }
  bool is_ending() const { return is_ending_; }
  /// Stops all work, and returns when no thread will ask for Python's lock any more.
  void end() {
    std::unique_lock lock(mutex_);
    is_ending_ = true;
    left_.wait(lock, [&] { return count_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable left_;
  int count_ = 0;
  std::atomic<bool> is_ending_ = false;
};

// Daemon threads outlive static objects, so the threads that wait are never destroyed.
WaitingThreads*& current_threads() {
  static auto* threads = new WaitingThreads;
  return threads;
}

WaitingThreads& waiting_threads() {
  return *current_threads();
}

/// Counts the thread among those that wait, as long as the object lives.
struct Waiting {
  Waiting() { waiting_threads().enter(); }
  ~Waiting() { waiting_threads().leave(); }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;
};

// Ends the part of a thread in a process that is about to end.
[[noreturn]] void sleep_until_the_process_ends() {
  waiting_threads().leave();
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

// Tells Python of the news and of signals. Returns false if the work is to stop.
bool tell_python(const nb::object& callback, Exchange& exchange) {
  if (PyErr_CheckSignals() != 0) nb::raise_python_error();
  const std::vector<PhaseShare> news = exchange.take_news();
  if (callback.is_none()) return true;
  for (const auto& [phase, share] : news) {
    if (callback(phase, share).ptr() == Py_False) return false;
  }
  return true;
}

// Waits for the end of the work. Returns what Python raised meanwhile; null: nothing. Called
// without Python's lock.
std::exception_ptr wait(const nb::object& callback, Exchange& exchange) {
  std::exception_ptr raised;
  bool is_told = true;
  for (bool is_done = false; !is_done;) {
    is_done = exchange.is_done_after_waiting();
    if (waiting_threads().is_ending()) {
      exchange.stop();
      if (is_done) sleep_until_the_process_ends();
      continue;
    }
    if (!is_told) continue;
    const nb::gil_scoped_acquire lock;
    try {
      is_told = tell_python(callback, exchange);
    } catch (...) {
      raised = std::current_exception();
      is_told = false;
    }
    if (!is_told) exchange.stop();
  }
  return raised;
}

}  // namespace

void run_long(const nb::object& callback, const std::function<void(const Progress&)>& work) {
  Exchange exchange;
  std::exception_ptr raised;
  const Waiting waiting;
  {
    const nb::gil_scoped_release others_may_run;
    std::thread worker([&] {
      std::exception_ptr error;
      try {
        work([&](std::string_view phase, double share) { return exchange.note(phase, share); });
      } catch (...) {
        error = std::current_exception();
      }
      exchange.finish(std::move(error));
    });
    raised = wait(callback, exchange);
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (exchange.error()) std::rethrow_exception(exchange.error());
}

void end_long_work() {
  const nb::gil_scoped_release others_may_finish;
  waiting_threads().end();
}

void forget_long_work() {
  // A thread of the parent may have held the mutex, so the object is left as it is.
  current_threads() = new WaitingThreads;
}

}  // namespace lightwell::python
