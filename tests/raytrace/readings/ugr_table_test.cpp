#include "raytrace/readings/ugr_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "scene/errors.h"

namespace lightwell::ugr_table_test {
namespace {

const std::filesystem::path folder =
    std::filesystem::path(LIGHTWELL_TEST_DATA) / "luminaires" / "ugr";

/// Ratings crosswise (along C0), then endwise; 0 if the program prints only that UGR is below 10.
using Printed = Eigen::Array<double, ugr_rooms.size(), 2 * ugr_reflectances.size()>;

Printed printed(int luminaire, const std::string& program) {
  std::ifstream in(folder / ("ugr_table_0" + std::to_string(luminaire) + "_" + program + ".csv"));
  Printed table = Printed::Zero();
  std::string line, field;
  for (Eigen::Index row = 0; row < table.rows() && std::getline(in, line); ++row) {
    std::istringstream fields(line);
    for (Eigen::Index c = 0; c < table.cols() && std::getline(fields, field, ','); ++c) {
      if (field.find('<') == std::string::npos) table(row, c) = std::stod(field);
    }
  }
  EXPECT_TRUE((table > 0.0).any()) << "no table of " << program;
  return table;
}

LuminaireFile sample(int luminaire) {
  return read_luminaire(folder / ("sample_0" + std::to_string(luminaire) + ".ldt"));
}

Printed ours(int luminaire) {
  const UgrTable table = ugr_table(sample(luminaire));
  Printed both;
  both << table.along_c0, table.along_c90;
  return both;
}

struct Apart {
  double squares = 0.0, largest = 0.0;
  int count = 0;

  void add(const Printed& a, const Printed& b) {
    for (Eigen::Index i = 0; i < a.size(); ++i) {
      const double x = a.data()[i], y = b.data()[i];
      constexpr double least_printed = 10.0;
      if (std::min(x, y) < least_printed) continue;
      squares += (x - y) * (x - y);
      largest = std::max(largest, std::abs(x - y));
      ++count;
    }
  }
  double rms() const { return std::sqrt(squares / count); }
};

/// Two commercial programs differ for the same files. Lightwell's difference from each has
/// at most the RMS and the maximum of the difference between them.
TEST(UgrTable, IsThatOfDialuxAndRelux) {
  Apart dialux, relux, each_other;
  for (int luminaire = 1; luminaire <= 6; ++luminaire) {
    const Printed of_dialux = printed(luminaire, "Dialux"), of_relux = printed(luminaire, "Relux"),
                  table = ours(luminaire);
    dialux.add(table, of_dialux);
    relux.add(table, of_relux);
    each_other.add(of_dialux, of_relux);
  }
  std::printf("off DIALux by %.2f RMS, %.2f at most; Relux %.2f, %.2f; they %.2f, %.2f\n",
              dialux.rms(), dialux.largest, relux.rms(), relux.largest, each_other.rms(),
              each_other.largest);
  constexpr int all_but_what_is_below_10 = 5 * 190 + 40;
  EXPECT_GE(each_other.count, all_but_what_is_below_10);
  EXPECT_LE(dialux.rms(), each_other.rms());
  EXPECT_LE(relux.rms(), each_other.rms());
  EXPECT_LE(dialux.largest, each_other.largest);
  EXPECT_LE(relux.largest, each_other.largest);
}

/// UGR is 8 log10(I^2 / E) + const: twice the candela of the same luminaire add 8 log10 2.
TEST(UgrTable, RisesWithTheFlux) {
  LuminaireFile luminaire = sample(3);
  const UgrTable once = ugr_table(luminaire);
  const PhotometricWeb& web = *luminaire.web;
  luminaire.web =
      std::make_shared<PhotometricWeb>(web.planes(), web.gammas(), (2.0 * web.values()).eval());
  const UgrTable twice = ugr_table(luminaire);
  EXPECT_LT((twice.along_c90 - once.along_c90 - 8.0 * std::log10(2.0)).abs().maxCoeff(), 1e-9);
}

/// A quarter turn of the web and the opening changes the names of the planes and nothing else.
TEST(UgrTable, TurnsWithTheLuminaire) {
  const LuminaireFile as_measured = sample(3);
  LuminaireFile turned = as_measured;
  std::swap(turned.opening.along_c0, turned.opening.along_c90);
  const PhotometricWeb& web = *as_measured.web;
  const auto quarter = static_cast<Eigen::Index>(web.planes().size() / 4);
  Eigen::ArrayXXd values(web.values().rows(), web.values().cols());
  for (Eigen::Index p = 0; p < values.rows(); ++p) {
    values.row((p + quarter) % values.rows()) = web.values().row(p);
  }
  turned.web = std::make_shared<PhotometricWeb>(web.planes(), web.gammas(), values);
  const UgrTable a = ugr_table(as_measured), b = ugr_table(turned);
  EXPECT_LT((a.along_c0 - b.along_c90).abs().maxCoeff(), 1e-9);
  EXPECT_LT((a.along_c90 - b.along_c0).abs().maxCoeff(), 1e-9);
}

TEST(UgrTable, NeedsCandelaAndAnArea) {
  LuminaireFile luminaire = sample(1);
  luminaire.opening = {};
  EXPECT_THROW(ugr_table(luminaire), InputError);
  luminaire = sample(1);
  luminaire.is_radiometric = true;
  EXPECT_THROW(ugr_table(luminaire), InputError);
}

}  // namespace
}  // namespace lightwell::ugr_table_test
