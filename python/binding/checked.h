#pragma once

#include <cstdint>
#include <string>

// Checks of numbers that Python hands over. Each throws InputError with a sentence that names the
// option, and returns the value.
namespace lightwell::python {

/// A finite number above 0.
double positive(const char* option, double value);

/// A limit of memory in bytes, from 2^20 to 2^62, rounded down.
std::int64_t bytes_of_memory(double value);

/// A whole number from `least` to `most`.
int whole_number(const char* option, int value, int least, int most);

/// An even number of cells along an edge of a hemicube, from 2 to 4096.
int even_number(const char* option, int value);

/// A power of two from 1 to 2^20: sample points are stratified in powers of two.
int power_of_two(const char* option, int value);

/// A share from 0.001 % to 100 %, as "0.5%" or "0.005".
double share(const char* option, const std::string& text);

}  // namespace lightwell::python
