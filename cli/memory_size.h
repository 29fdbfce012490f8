#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>

namespace lightwell {

/// Adds --memory SIZE: "500M", "1.5G", "2GiB", "800 kB" in bytes, powers of 1024, whatever the case
/// and with or without B or iB; without a unit, bytes. At least a megabyte.
CLI::Option* add_memory(CLI::App& command, std::int64_t& bytes);

}  // namespace lightwell
