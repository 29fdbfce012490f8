#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace lightwell {

/// Runs `import` in a child process, so that damaged files can neither crash this process nor hold
/// it up: readers of other libraries trust the counts and indices of a file. `import` returns the
/// fault of the file, or an empty string. `bytes` is the size of the file, by which the child's
/// time and memory are limited. Returns the fault; empty: the import is safe to repeat here.
std::string trial_fault(const std::function<std::string()>& import, std::int64_t bytes);

}  // namespace lightwell
