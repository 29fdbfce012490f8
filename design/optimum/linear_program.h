#pragma once

#include <Eigen/Core>
#include <limits>
#include <utility>
#include <vector>

namespace lightwell {

/// A variable x of a linear programme: its share of the objective, and its bounds.
struct LinearColumn {
  double cost = 0.0;
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();  ///< >= least
};

/// A constraint, least <= sum factor x <= most, of which one side may be infinite.
struct LinearRow {
  std::vector<std::pair<int, double>> terms{};  ///< column and factor; each column at most once
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
};

/// Minimise sum cost x within the bounds of all columns and rows (Dantzig 1963).
struct LinearProgram {
  std::vector<LinearColumn> columns{};
  std::vector<LinearRow> rows{};

  /// Appends a column and returns its index.
  int add_column(const LinearColumn& column) {
    columns.push_back(column);
    return static_cast<int>(columns.size()) - 1;
  }
};

struct LinearOptimum {
  bool is_feasible = false;  ///< false: no x meets all rows, and the rest is empty
  double cost = 0.0;
  Eigen::VectorXd x{};
  /// Dual value of each row: the derivative of the least cost by the row's bound that is reached; 0
  /// of a row that is not at a bound.
  Eigen::VectorXd row_price{};
};

/// The optimum by the simplex method (GLPK), to a tolerance of about 1e-8 in each row; rows and
/// costs should be scaled to the size of 1. Throws std::invalid_argument for numbers that are not
/// finite, std::runtime_error if the objective is unbounded or the simplex method fails.
LinearOptimum solve_linear(const LinearProgram& program);

}  // namespace lightwell
