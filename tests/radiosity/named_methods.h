#pragma once

#include <gtest/gtest.h>

#include <string>

#include "radiosity/form_factors/form_factors.h"
#include "radiosity/solvers/solve_radiosity.h"

namespace lightwell::test {

/// For INSTANTIATE_TEST_SUITE_P over form_factor_methods; test names may hold letters alone.
inline std::string name_of_method(const testing::TestParamInfo<NamedFormFactorMethod>& tested) {
  std::string name(tested.param.name);
  std::erase(name, '-');
  return name;
}

/// The same over solver_methods.
inline std::string name_of_solver(const testing::TestParamInfo<NamedSolverMethod>& tested) {
  std::string name(tested.param.name);
  std::erase(name, '-');
  return name;
}

}  // namespace lightwell::test
