#include "cli/udales_files.h"

#include <fmt/format.h>

#include "scene/atomic_file.h"

namespace lightwell {
namespace {

// One value a line, below `header` unless that is empty.
void write_list(AtomicStream& file, const char* header, const Eigen::ArrayXd& values, int digits) {
  if (*header != '\0') file.stream() << header << '\n';
  for (const double value : values) file.stream() << fmt::format("{:.{}f}\n", value, digits);
}

std::int64_t write_sparse(AtomicStream& file, const ViewFactors& factors) {
  constexpr float least = 5e-7f;
  std::int64_t count = 0;
  for (int i = 0; i < factors.row_count(); ++i) {
    for (const FormFactor& f : factors.row(i)) {
      if (!(f.value >= least)) continue;
      file.stream() << fmt::format("{} {} {:.6f}\n", i + 1, f.patch + 1, f.value);
      ++count;
    }
  }
  return count;
}

}  // namespace

std::vector<std::filesystem::path> udales_files(const std::filesystem::path& folder,
                                                const std::string& number) {
  return {folder / ("svf.inp." + number), folder / ("netsw.inp." + number),
          folder / ("vfsparse.inp." + number), folder / "Sdir.txt"};
}

std::int64_t write_udales(const std::filesystem::path& folder, const std::string& number,
                          const UdalesRadiation& radiation) {
  const auto files = udales_files(folder, number);
  AtomicStream svf(files[0]), netsw(files[1]), sparse(files[2]), direct(files[3]);
  write_list(svf, "# sky view factors", radiation.sky_view, 6);
  write_list(netsw, "# net shortwave on facets [W/m2] (including reflections and diffusive)",
             radiation.net, 4);
  const std::int64_t count = write_sparse(sparse, radiation.factors);
  write_list(direct, "", radiation.direct, 4);
  for (AtomicStream* file : {&svf, &netsw, &sparse, &direct}) file->close();
  for (AtomicStream* file : {&svf, &netsw, &sparse, &direct}) file->commit();
  return count;
}

}  // namespace lightwell
