#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

namespace lightwell {

/// "500M", "1.5G", "2GiB", "800 kB" in bytes: powers of 1024, whatever the case and with or without
/// B or iB; without a unit, bytes. Nothing for anything else, and for less than a megabyte.
std::optional<std::int64_t> parse_memory(const std::string& text);

/// Adds --memory SIZE, in bytes.
CLI::Option* add_memory(CLI::App& command, std::int64_t& bytes);

}  // namespace lightwell
