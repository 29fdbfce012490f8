#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace lightwell {

/// Adds --memory SIZE, converted to bytes, such as "500M", "1.5G", "2GiB" or "800 kB". Units are
/// powers of 1024 in upper or lower case, with or without B or iB; a number alone is in bytes. The
/// least size is 1 MB (2^20 bytes).
CLI::Option* add_memory(CLI::App& command, std::int64_t& bytes);

}  // namespace lightwell
