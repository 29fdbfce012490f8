#include "scene/cie_daylight.h"

#include <array>

namespace lightwell {
namespace {

constexpr double first_daylight_nm = 300.0, daylight_step_nm = 10.0;

// S_0, S_1 and S_2 (CIE 15:2018, table 6).
constexpr std::array<std::array<double, 3>, 54> daylight_functions = {
    {{0.04, 0.02, 0},     {6, 4.5, 2},         {29.6, 22.4, 4},     {55.3, 42, 8.5},
     {57.3, 40.6, 7.8},   {61.8, 41.6, 6.7},   {61.5, 38, 5.3},     {68.8, 42.4, 6.1},
     {63.4, 38.5, 3},     {65.8, 35, 1.2},     {94.8, 43.4, -1.1},  {104.8, 46.3, -0.5},
     {105.9, 43.9, -0.7}, {96.8, 37.1, -1.2},  {113.9, 36.7, -2.6}, {125.6, 35.9, -2.9},
     {125.5, 32.6, -2.8}, {121.3, 27.9, -2.6}, {121.3, 24.3, -2.6}, {113.5, 20.1, -1.8},
     {113.1, 16.2, -1.5}, {110.8, 13.2, -1.3}, {106.5, 8.6, -1.2},  {108.8, 6.1, -1},
     {105.3, 4.2, -0.5},  {104.4, 1.9, -0.3},  {100, 0, 0},         {96, -1.6, 0.2},
     {95.1, -3.5, 0.5},   {89.1, -3.5, 2.1},   {90.5, -5.8, 3.2},   {90.3, -7.2, 4.1},
     {88.4, -8.6, 4.7},   {84, -9.5, 5.1},     {85.1, -10.9, 6.7},  {81.9, -10.7, 7.3},
     {82.6, -12, 8.6},    {84.9, -14, 9.8},    {81.3, -13.6, 10.2}, {71.9, -12, 8.3},
     {74.3, -13.3, 9.6},  {76.4, -12.9, 8.5},  {63.3, -10.6, 7},    {71.7, -11.6, 7.6},
     {77, -12.2, 8},      {65.2, -10.2, 6.7},  {47.7, -7.8, 5.2},   {68.6, -11.2, 7.4},
     {65, -10.4, 6.8},    {66, -10.6, 7},      {61, -9.7, 6.4},     {53.3, -8.3, 5.5},
     {58.9, -9.3, 6.1},   {61.9, -9.8, 6.5}}};

}  // namespace

Eigen::Vector2d daylight_chromaticity(double kelvin) {
  constexpr double change = 7000.0;
  const double t = 1000.0 / kelvin;
  const double x = kelvin <= change ? 0.244063 + 0.09911 * t + 2.9678 * t * t - 4.6070 * t * t * t
                                    : 0.237040 + 0.24748 * t + 1.9018 * t * t - 2.0064 * t * t * t;
  return {x, -3.000 * x * x + 2.870 * x - 0.275};
}

SpectrumSamples daylight_spectrum(double kelvin) {
  const Eigen::Vector2d xy = daylight_chromaticity(kelvin);
  const double x = xy.x(), y = xy.y();
  const double scale = 0.0241 + 0.2562 * x - 0.7341 * y;
  const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / scale;
  const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / scale;
  SpectrumSamples spectrum;
  double nm = first_daylight_nm;
  for (const auto& [s0, s1, s2] : daylight_functions) {
    spectrum.wavelengths_nm.push_back(nm);
    spectrum.values.push_back(s0 + m1 * s1 + m2 * s2);
    nm += daylight_step_nm;
  }
  return spectrum;
}

}  // namespace lightwell
