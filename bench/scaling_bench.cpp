// Time and peak memory of a solve over the number of elements.
//
//   scaling_bench [MOST_ELEMENTS [PLOT.svg]]     default: 100000
//
// A room with a lamp and 100 boxes on its floor, cut into even elements of falling size: the whole
// first pass of `lightwell solve --max-element-size L --refine off --accuracy 3%` (with refinement,
// the number of elements would not be given). Seconds are processor seconds. Peak memory is that of
// the process since its start; meshes grow from solve to solve. With PLOT.svg the program draws
// both.
#include <fmt/format.h>
#include <sys/resource.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "bench/rooms.h"
#include "radiosity/solve.h"
#include "scene/parallel.h"

namespace {

using namespace lightwell;

struct Row {
  int elements = 0;
  double seconds = 0.0, megabytes = 0.0;
};

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kilobytes = 1024.0;
  return static_cast<double>(usage.ru_maxrss) / kilobytes;
}

Row measure(const Scene& scene, double element_size) {
  const std::clock_t start = std::clock();
  SolveOptions options{.mesh = {.max_element_size = element_size},
                       .refine = {.tolerance = 0.0},
                       .accuracy = Accuracy{.share = 0.03}};
  SolveReport report;
  const SolvedScene solved = solve_scene(scene, options, &report);
  const Row row{.elements = solved.mesh.element_count(),
                .seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC,
                .megabytes = peak_megabytes()};
  fmt::print("{:8} elements {:7} patches {:4} rays {:8.2f} s {:7.0f} MB  error {:.2f} %  (",
             row.elements, solved.mesh.patch_count(), report.gather_rays, row.seconds,
             row.megabytes, 100.0 * solved.solution.error_estimate);
  for (const PhaseSeconds& phase : solved.solution.seconds) {
    fmt::print(" {} {:.1f}", phase.phase, phase.seconds);
  }
  fmt::print(" s of wall)\n");
  std::fflush(stdout);
  return row;
}

// Exponent p of seconds (or megabytes) ~ elements^p between two rows.
double exponent(const Row& a, const Row& b, double Row::*what) {
  return std::log(b.*what / a.*what) / std::log(static_cast<double>(b.elements) / a.elements);
}

constexpr double width = 520, height = 300, left = 60, top = 30, decades = 3.0;

std::string curve(const std::vector<Row>& rows, double Row::*what, double least,
                  const std::string& colour) {
  std::string path, dots;
  for (const Row& row : rows) {
    const double x = left + width * (std::log10(row.elements) - 3.0) / decades;
    const double y = top + height * (1.0 - std::log10(row.*what / least) / (decades + 1.0));
    path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", x, y);
    dots +=
        fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, colour);
  }
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}", path,
                     colour, dots);
}

void draw(const std::string& file, const std::vector<Row>& rows) {
  std::ofstream out(file);
  out << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 640 400" font-family="sans-serif" font-size="12">)"
      << "\n<rect width=\"640\" height=\"400\" fill=\"white\"/>\n";
  for (int d = 0; d <= 3; ++d) {
    const double x = left + width * d / decades;
    out << fmt::format(
        "<path d=\"M{0:.1f} {1:.1f} V{2:.1f}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{0:.1f}\" y=\"{3:.1f}\" text-anchor=\"middle\">10<tspan dy=\"-5\" "
        "font-size=\"9\">{4}</tspan></text>\n",
        x, top, top + height, top + height + 18, d + 3);
  }
  constexpr double least_seconds = 0.1, least_megabytes = 10.0;
  for (std::size_t d = 0; d <= 4; ++d) {
    const double decade = static_cast<double>(d);
    const double y = top + height * (1.0 - decade / (decades + 1.0));
    out << fmt::format(
        "<path d=\"M{0:.1f} {1:.1f} H{2:.1f}\" stroke=\"#ddd\"/>\n"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" text-anchor=\"end\" fill=\"#c0392b\">{5:g} s</text>\n"
        "<text x=\"{6:.1f}\" y=\"{4:.1f}\" fill=\"#2471a3\">{7}</text>\n",
        left, y, left + width, left - 6, y + 4, least_seconds * std::pow(10.0, decade),
        left + width + 4, least_megabytes * std::pow(10.0, d));
  }
  out << curve(rows, &Row::seconds, least_seconds, "#c0392b")
      << curve(rows, &Row::megabytes, least_megabytes, "#2471a3")
      << fmt::format(
             "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">elements</text>\n"
             "<text x=\"{}\" y=\"18\" text-anchor=\"middle\">processor time and peak memory (MB) "
             "of "
             "a solve</text>\n",
             left + width / 2, top + height + 38, left + width / 2)
      << "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  const int most_elements = argc > 1 ? std::atoi(argv[1]) : 100000;
  const Scene scene = room_of_boxes();
  fmt::print("a room with 100 boxes, {} threads\n", thread_count());
  std::vector<Row> rows;
  for (double element_size = 0.8;; element_size /= std::sqrt(2.0)) {
    rows.push_back(measure(scene, element_size));
    if (2 * rows.back().elements > most_elements) break;
  }
  const Row &first = rows[rows.size() > 7 ? rows.size() - 7 : 0], &last = rows.back();
  fmt::print("from {} to {} elements seconds grow as n^{:.2f}, memory as n^{:.2f}\n",
             first.elements, last.elements, exponent(first, last, &Row::seconds),
             exponent(first, last, &Row::megabytes));
  if (argc > 2) draw(argv[2], rows);
}
