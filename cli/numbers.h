#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace lightwell {

/// Accepts whole numbers from `least` to `most`.
CLI::Validator whole_number(int least, int most);

/// The number that all of a text is; empty if it is none.
std::optional<double> parsed_number(const std::string& text);

/// Accepts finite numbers above zero.
CLI::Validator positive();

/// Accepts numbers from `least` to `most`, and no NaN, which CLI::Range lets pass. `what` such as
/// "an angle in degrees" begins the message.
CLI::Validator number_within(double least, double most, std::string what);

/// Accepts powers of two up to 2^20, for ray counts: sample points are stratified in powers of two.
CLI::Validator power_of_two();

}  // namespace lightwell
