#include "radiosity/form_factors/form_factor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "radiosity/form_factors/text_output.h"
#include "radiosity/solution/poly_data.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

void add_comment(TextOutput& out, std::string_view comment) {
  while (!comment.empty()) {
    const std::size_t end = std::min(comment.find('\n'), comment.size());
    out.add("% {}\n", comment.substr(0, end));
    comment.remove_prefix(std::min(end + 1, comment.size()));
  }
}

}  // namespace

void write_matrix_market(const std::filesystem::path& path, const ViewFactors& view_factors,
                         const std::string& comment) {
  TextOutput out(path);
  out.add("%%MatrixMarket matrix coordinate real general\n");
  add_comment(out, comment);
  const int n = view_factors.row_count();
  out.add("{} {} {}\n", n, n, view_factors.entry_count());
  for (int i = 0; i < n; ++i) {
    for (const auto [j, F] : view_factors.row(i)) out.add("{} {} {:.9g}\n", i + 1, j + 1, F);
  }
  out.commit();
}

void write_view3d(const std::filesystem::path& path, const ViewFactors& view_factors,
                  const std::vector<double>& emittance, double metres_per_unit,
                  const View3dHeader& header) {
  const int n = view_factors.row_count();
  if (n > most_view3d_rows) {
    throw InputError(
        fmt::format("{}: View3D's result format writes out every zero, and {} rows would make "
                    "{:.1f} GB; at most {} are written. Use the Matrix Market file",
                    path.string(), n, 9e-9 * n * n, most_view3d_rows));
  }
  TextOutput out(path);
  // Readers of the format take the first 30 characters, whatever the padding.
  const std::string first = fmt::format("{} {} 0 {} 0 {}", header.program, header.version,
                                        header.is_enclosure ? 1 : 0, n);
  out.add("{:<30}\n", first);
  const double unit_area = metres_per_unit * metres_per_unit;
  for (int i = 0; i < n; ++i) {
    out.add("{}{:g}", i == 0 ? "" : " ",
            view_factors.area[static_cast<std::size_t>(i)] / unit_area);
  }
  out.add("\n");
  for (int i = 0; i < n; ++i) {
    int column = 0;
    const auto add_zeros_before = [&](int end) {
      for (; column < end; ++column) out.add("{}0.000000", column == 0 ? "" : " ");
    };
    for (const auto [j, F] : view_factors.row(i)) {
      add_zeros_before(j);
      out.add("{}{:.6f}", j == 0 ? "" : " ", F);
      column = j + 1;
    }
    add_zeros_before(n);
    out.add("\n");
  }
  for (int i = 0; i < n; ++i) {
    out.add("{}{:.3f}", i == 0 ? "" : " ", emittance[static_cast<std::size_t>(i)]);
  }
  out.add("\n");
  out.commit();
}

void write_row(const std::filesystem::path& path, const PatchMesh& mesh,
               const std::vector<int>& row_of_patch, const ViewFactors& view_factors, int i) {
  const auto elements = static_cast<std::size_t>(mesh.element_count());
  std::vector<float> factor(elements, 0.0f);
  std::vector<int> row(elements, 0), is_row(elements, 0);
  std::vector<double> area(elements, 0.0);
  for (std::size_t e = 0; e < elements; ++e) {
    const int j = row_of_patch[static_cast<std::size_t>(mesh.patch[e])];
    if (j < 0) continue;
    factor[e] = view_factors.factor(i, j);
    row[e] = j + 1;
    is_row[e] = j == i ? 1 : 0;
    area[e] = view_factors.area[static_cast<std::size_t>(j)];
  }
  PolyData data;
  set_element_polygons(data, mesh);
  std::vector<DataArray>& cells = data.of_polygons;
  add_values(cells, "view_factor", factor.data(), mesh.element_count());
  add_values(cells, "row", row.data(), mesh.element_count());
  add_values(cells, "is_row", is_row.data(), mesh.element_count());
  add_values(cells, "area", area.data(), mesh.element_count());
  data.polygon_scalars = "view_factor";
  write_pieces(path, poly_data_text(std::move(data)));
}

}  // namespace lightwell
