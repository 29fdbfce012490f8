#include "design/optimum/linear_program.h"

#include <glpk.h>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace lightwell {
namespace {

constexpr double tolerance = 1e-8;  // of rows, relative, and of reduced costs

using Problem = std::unique_ptr<glp_prob, decltype(&glp_delete_prob)>;

int kind_of_bounds(double least, double most) {
  if (least == most) return GLP_FX;
  if (std::isinf(least)) return std::isinf(most) ? GLP_FR : GLP_UP;
  return std::isinf(most) ? GLP_LO : GLP_DB;
}

// GLPK ends the process for numbers that it does not expect.
void require_finite(const LinearProgram& program) {
  bool is_finite = true;
  for (const LinearColumn& column : program.columns) {
    is_finite &=
        std::isfinite(column.cost) && std::isfinite(column.least) && column.most >= column.least;
  }
  for (const LinearRow& row : program.rows) {
    is_finite &= row.most >= row.least;
    for (const auto& [column, factor] : row.terms) is_finite &= std::isfinite(factor);
  }
  if (!is_finite)
    throw std::invalid_argument("a linear programme holds a number that is not finite");
}

void add_columns(glp_prob* problem, const std::vector<LinearColumn>& columns) {
  if (columns.empty()) return;
  glp_add_cols(problem, static_cast<int>(columns.size()));
  int number = 0;  // GLPK counts from 1
  for (const LinearColumn& column : columns) {
    ++number;
    glp_set_obj_coef(problem, number, column.cost);
    glp_set_col_bnds(problem, number, kind_of_bounds(column.least, column.most), column.least,
                     column.most);
  }
}

void add_rows(glp_prob* problem, const std::vector<LinearRow>& rows) {
  if (rows.empty()) return;
  glp_add_rows(problem, static_cast<int>(rows.size()));
  std::vector<int> columns;
  std::vector<double> factors;
  int number = 0;
  for (const LinearRow& row : rows) {
    ++number;
    columns.assign(1, 0);  // GLPK reads from the second element on
    factors.assign(1, 0.0);
    for (const auto& [column, factor] : row.terms) {
      if (factor == 0.0) continue;
      columns.push_back(column + 1);
      factors.push_back(factor);
    }
    glp_set_mat_row(problem, number, static_cast<int>(columns.size()) - 1, columns.data(),
                    factors.data());
    glp_set_row_bnds(problem, number, kind_of_bounds(row.least, row.most), row.least, row.most);
  }
}

// True if the simplex method came to an end. A basis may be too close to singular for it; another
// start and the primal method then lead around that basis.
bool run_simplex(glp_prob* problem) {
  glp_smcp options;
  glp_init_smcp(&options);
  options.msg_lev = GLP_MSG_OFF;
  options.meth = GLP_DUALP;
  options.tol_bnd = options.tol_dj = tolerance;
  glp_scale_prob(problem, GLP_SF_AUTO);
  glp_adv_basis(problem, 0);
  // A basis that is infeasible proves nothing about others.
  const auto is_settled = [&] {
    return glp_simplex(problem, &options) == 0 && glp_get_status(problem) != GLP_INFEAS;
  };
  if (is_settled()) return true;
  options.meth = GLP_PRIMAL;
  glp_std_basis(problem);
  return is_settled();
}

}  // namespace

LinearOptimum solve_linear(const LinearProgram& program) {
  require_finite(program);
  glp_term_out(GLP_OFF);
  const Problem problem(glp_create_prob(), &glp_delete_prob);
  glp_set_obj_dir(problem.get(), GLP_MIN);
  add_columns(problem.get(), program.columns);
  add_rows(problem.get(), program.rows);
  if (!run_simplex(problem.get())) {
    throw std::runtime_error("the simplex method found no basis to go on from");
  }
  const int status = glp_get_status(problem.get());
  if (status == GLP_NOFEAS) return {};
  if (status != GLP_OPT) throw std::runtime_error("a linear programme has no least cost");
  LinearOptimum optimum{
      .is_feasible = true,
      .cost = glp_get_obj_val(problem.get()),
      .x = Eigen::VectorXd(static_cast<Eigen::Index>(program.columns.size())),
      .row_price = Eigen::VectorXd(static_cast<Eigen::Index>(program.rows.size()))};
  for (int i = 0; i < optimum.x.size(); ++i) {
    optimum.x[i] = glp_get_col_prim(problem.get(), i + 1);
  }
  for (int i = 0; i < optimum.row_price.size(); ++i) {
    optimum.row_price[i] = glp_get_row_dual(problem.get(), i + 1);
  }
  return optimum;
}

}  // namespace lightwell
