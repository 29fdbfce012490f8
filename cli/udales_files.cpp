#include "cli/udales_files.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "radiosity/radiation/shortwave.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"
#include "scene/io/text_file.h"

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

// Visits the words of each line of numbers.
void for_each_row(const TextFile& file,
                  const std::function<void(int line, std::vector<std::string_view> words)>& visit) {
  file.for_each_line([&](int line, std::string_view text) {
    text = trimmed(text);
    if (text.empty() || text.front() == '#') return;
    std::vector<std::string_view> words;
    while (!text.empty()) {
      words.push_back(next_word(text));
      text = trimmed(text);
    }
    visit(line, std::move(words));
  });
}

double number_in(const TextFile& file, int line, const std::vector<std::string_view>& words,
                 std::size_t column) {
  const auto value = column < words.size() ? parse_finite(words[column]) : std::nullopt;
  if (!value) file.fail(line, fmt::format("needs a number in column {}", column + 1));
  return *value;
}

// Number of a type of facets, which uDALES writes whole.
int type_in(const TextFile& file, int line, const std::vector<std::string_view>& words) {
  constexpr double largest = 1e6;  // more types than facets of any case
  const double number = number_in(file, line, words, 0);
  if (std::abs(number) <= largest && number == std::floor(number)) return static_cast<int>(number);
  file.fail(line, fmt::format("{:g} is no type of facets; types are whole numbers", number));
}

// Albedos by the number of the type of facets.
std::map<int, double> read_albedos_of_types(const TextFile& file) {
  constexpr std::size_t albedo_column = 4;
  std::map<int, double> albedos;
  for_each_row(file, [&](int line, const std::vector<std::string_view>& words) {
    const double albedo = number_in(file, line, words, albedo_column);
    if (!(albedo >= 0.0 && albedo <= highest_albedo)) {
      file.fail(line,
                fmt::format("the albedo is {:g}; it lies from 0 to {:g}", albedo, highest_albedo));
    }
    albedos[type_in(file, line, words)] = albedo;
  });
  return albedos;
}

}  // namespace

Eigen::ArrayXd read_udales_albedos(const std::filesystem::path& folder, const std::string& number,
                                   int count) {
  const TextFile facets(folder / ("facets.inp." + number)),
      types(folder / ("factypes.inp." + number));
  const std::map<int, double> albedos = read_albedos_of_types(types);
  std::vector<double> of_facets;
  for_each_row(facets, [&](int line, const std::vector<std::string_view>& words) {
    const int type = type_in(facets, line, words);
    const auto found = albedos.find(type);
    if (found == albedos.end()) {
      facets.fail(line, fmt::format("the facet has the type {}, which {} does not have", type,
                                    types.path().string()));
    }
    of_facets.push_back(found->second);
  });
  if (std::ssize(of_facets) != count) {
    throw InputError(fmt::format("{} has {} facets, and the model {}; give the model of the case",
                                 facets.path().string(), of_facets.size(), count));
  }
  return Eigen::Map<const Eigen::ArrayXd>(of_facets.data(), count);
}

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
