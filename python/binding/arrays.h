#pragma once

#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "raytrace/readings/probe.h"
#include "scene/bands.h"

// Arrays that Python and the library hand each other.
namespace lightwell::python {

template <class Scalar>
using NumpyArray = nanobind::ndarray<nanobind::numpy, Scalar>;

/// An array of NumPy as a result, by which stubs name its type.
class ArrayOut : public nanobind::object {
  NB_OBJECT_DEFAULT(ArrayOut, object, "numpy.ndarray", nanobind::ndarray_check)
};

using PointsIn = nanobind::ndarray<const double, nanobind::shape<-1, 3>, nanobind::c_contig,
                                   nanobind::device::cpu>;
template <class Scalar>
using ListIn =
    nanobind::ndarray<const Scalar, nanobind::shape<-1>, nanobind::c_contig, nanobind::device::cpu>;

/// A read-only array of memory that `owner` keeps alive: no copy.
template <class Scalar>
ArrayOut view_of(const Scalar* data, std::initializer_list<std::size_t> shape,
                 nanobind::handle owner) {
  static const Scalar nothing{};  // an empty array must not begin at null
  return nanobind::cast<ArrayOut>(
      nanobind::cast(NumpyArray<const Scalar>(data ? data : &nothing, shape, owner)));
}

/// A writable array that owns a container, which is moved: no copy of its memory.
template <class Container>
ArrayOut owned(Container from, std::initializer_list<std::size_t> shape) {
  auto kept = std::make_unique<Container>(std::move(from));
  using Scalar = std::remove_cvref_t<decltype(*kept->data())>;
  Scalar* const data = kept->data();
  const nanobind::capsule owner(kept.release(),
                                [](void* all) noexcept { delete static_cast<Container*>(all); });
  static Scalar nothing{};
  return nanobind::cast<ArrayOut>(
      nanobind::cast(NumpyArray<Scalar>(data ? data : &nothing, shape, owner)));
}

inline ArrayOut owned_bands(BandArray values) {
  const auto rows = static_cast<std::size_t>(values.rows());
  const auto columns = static_cast<std::size_t>(values.cols());
  return owned(std::move(values), {rows, columns});
}

/// Values of bands as lx, one for each row.
inline std::vector<double> luminous_values(const Bands& bands, const BandArray& E) {
  std::vector<double> lux(static_cast<std::size_t>(E.rows()));
  for (std::size_t i = 0; i < lux.size(); ++i) {
    lux[i] = luminous(bands, E.row(static_cast<Eigen::Index>(i)).transpose());
  }
  return lux;
}

/// The rows of an array of points, m.
inline std::vector<Eigen::Vector3d> points_from(const PointsIn& given) {
  std::vector<Eigen::Vector3d> points(given.shape(0));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = Eigen::Map<const Eigen::Vector3d>(given.data() + 3 * i);
  }
  return points;
}

/// Probes at the rows of an array of points, m, that face along the rows of `normals`.
inline std::vector<Probe> probes_from(const PointsIn& points, const PointsIn& normals) {
  const std::vector<Eigen::Vector3d> places = points_from(points), ways = points_from(normals);
  std::vector<Probe> probes;
  for (std::size_t i = 0; i < places.size(); ++i)
    probes.push_back({places[i], ways[i].stableNormalized()});
  return probes;
}

}  // namespace lightwell::python
