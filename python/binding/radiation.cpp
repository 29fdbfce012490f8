#include <nanobind/stl/string.h>

#include <cmath>
#include <vector>

#include "python/binding/arrays.h"
#include "python/binding/found_form_factors.h"
#include "python/binding/long_work.h"
#include "python/binding/module.h"
#include "radiosity/radiation/radiant_exchange.h"

namespace nb = nanobind;

namespace lightwell::python {
namespace {

using MatrixIn = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::ArrayXd list_from(const ListIn<double>& values) {
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

ArrayOut matrix_out(const Eigen::MatrixXd& values) {
  const auto rows = static_cast<std::size_t>(values.rows());
  const auto columns = static_cast<std::size_t>(values.cols());
  return owned(RowMatrix(values), {rows, columns});
}

ArrayOut list_out(Eigen::ArrayXd values) {
  const auto count = static_cast<std::size_t>(values.size());
  return owned(std::move(values), {count});
}

ExchangeAreas areas_from(const ListIn<double>& area, const MatrixIn& factors,
                         const ListIn<double>& open) {
  const Eigen::MatrixXd F =
      Eigen::Map<const RowMatrix>(factors.data(), static_cast<Eigen::Index>(factors.shape(0)),
                                  static_cast<Eigen::Index>(factors.shape(1)));
  return exchange_areas(list_from(area), F, list_from(open));
}

/// Surfaces as lists; no temperature is NaN.
RadiantExchange exchange(const ExchangeAreas& areas, const ListIn<double>& emittance,
                         const ListIn<double>& kelvin, const ListIn<double>& heat,
                         double surroundings) {
  std::vector<RadiatingSurface> surfaces(emittance.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    surfaces[i].emittance = emittance.data()[i];
    surfaces[i].heat = heat.data()[i];
    if (!std::isnan(kelvin.data()[i])) surfaces[i].kelvin = kelvin.data()[i];
  }
  return result_of_long(
      nb::none(), [&](const Progress&) { return radiant_exchange(areas, surfaces, surroundings); });
}

using Factors = Eigen::MatrixXd(const ExchangeAreas&, const Eigen::ArrayXd&);

ArrayOut factors_of(Factors* factors, const ExchangeAreas& areas, const ListIn<double>& emittance) {
  const Eigen::ArrayXd eps = list_from(emittance);
  return matrix_out(
      result_of_long(nb::none(), [&](const Progress&) { return factors(areas, eps); }));
}

}  // namespace

void add_radiation(nb::module_& module) {
  nb::class_<ExchangeAreas>(module, "ExchangeAreas")
      .def_prop_ro("area", [](const ExchangeAreas& a) { return list_out(a.area); })
      .def_prop_ro("open", [](const ExchangeAreas& a) { return list_out(a.open); })
      .def_prop_ro("between", [](const ExchangeAreas& a) { return matrix_out(a.between); });
  nb::class_<RadiantExchange>(module, "RadiantExchange")
      .def_prop_ro("kelvin", [](const RadiantExchange& r) { return list_out(r.kelvin); })
      .def_prop_ro("radiosity", [](const RadiantExchange& r) { return list_out(r.radiosity); })
      .def_prop_ro("irradiation", [](const RadiantExchange& r) { return list_out(r.irradiation); })
      .def_prop_ro("heat", [](const RadiantExchange& r) { return list_out(r.heat); })
      .def_ro("to_surroundings", &RadiantExchange::to_surroundings);
  module.def("areas_of",
             [](const FoundFormFactors& found) { return exchange_areas(found.factors.factors); });
  module.def("areas_from", areas_from);
  module.def("radiant_exchange", exchange);
  module.def("gebhart_factors", [](const ExchangeAreas& areas, const ListIn<double>& emittance) {
    return factors_of(gebhart_factors, areas, emittance);
  });
  module.def("transfer_factors", [](const ExchangeAreas& areas, const ListIn<double>& emittance) {
    return factors_of(transfer_factors, areas, emittance);
  });
  module.attr("stefan_boltzmann") = stefan_boltzmann;
}

}  // namespace lightwell::python
