#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <optional>
#include <utility>

#include "scene/progress.h"

namespace lightwell::python {

/// Runs `work` on a thread of its own, without Python's lock. Meanwhile the calling thread calls
/// `callback`, unless that is None, with the phase and the share of progress, and looks for Ctrl-C,
/// twenty times a second. A callback that returns False, one that raises, and Ctrl-C stop the work.
/// Must be called with Python's lock held.
///
/// Throws Interrupted after False; what the callback raised, or KeyboardInterrupt; otherwise what
/// the work throws.
void run_long(const nanobind::object& callback, const std::function<void(const Progress&)>& work);

/// run_long() of work that returns a value.
template <class Work>
auto result_of_long(const nanobind::object& callback, Work&& work) {
  std::optional<decltype(work(Progress()))> result;
  run_long(callback, [&](const Progress& progress) { result.emplace(work(progress)); });
  return std::move(*result);
}

/// Stops the work of all threads, for good, and returns when they have stopped: to be called when
/// the interpreter is about to end. Must be called with Python's lock held.
void end_long_work();

/// Forgets the work of other threads: to be called in the child of a fork, where they do not exist.
void forget_long_work();

}  // namespace lightwell::python
