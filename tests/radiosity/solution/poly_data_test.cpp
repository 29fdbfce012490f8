// Files of Lightwell, read by VTK as ParaView does; built where the window is.
#include "radiosity/solution/poly_data.h"

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <cstring>
#include <numeric>

#include "radiosity/solution/solution_file.h"
#include "tests/radiosity/small_solution.h"

namespace lightwell::poly_data_test {
namespace {

using PolyDataText = SolutionFile;

TEST_F(PolyDataText, IsPolyDataThatAnyVtkReaderOpens) {
  const SolvedScene solved = small_solution(3);
  write_solution(file(), solved);
  vtkNew<vtkXMLPolyDataReader> reader;
  EXPECT_TRUE(reader->CanReadFile(file().c_str()));
  reader->SetFileName(file().c_str());
  reader->Update();
  vtkPolyData* poly = reader->GetOutput();
  EXPECT_EQ(poly->GetNumberOfPoints(), 9);
  EXPECT_EQ(poly->GetNumberOfPolys(), 3);
  vtkPointData* light = poly->GetPointData();
  ASSERT_NE(light->GetScalars(), nullptr);
  EXPECT_STREQ(light->GetScalars()->GetName(), "rgb");
  EXPECT_EQ(light->GetScalars()->GetDataType(), VTK_UNSIGNED_CHAR);
  for (const char* name : {"irradiance", "direct_irradiance", "indirect_irradiance", "radiosity"}) {
    ASSERT_NE(light->GetArray(name), nullptr) << name;
    EXPECT_EQ(light->GetArray(name)->GetNumberOfComponents(), 3) << name;
    EXPECT_EQ(light->GetArray(name)->GetComponentName(0), std::string("__a_ _ _b__")) << name;
    EXPECT_STREQ(light->GetArray(name)->GetComponentName(2), "b") << name;
  }
  for (const char* name : {"patch", "twin", "surface", "material", "facet", "area"}) {
    EXPECT_NE(poly->GetCellData()->GetArray(name), nullptr) << name;
  }
}

/// E = 100 W/m^2 in every RGB band is 100 * 683 lx, because the luminance weights sum to 1; and a
/// grey vertex must look grey.
TEST_F(PolyDataText, HoldsIlluminanceInLuxAndColorsForDisplay) {
  SolvedScene solved = small_solution(3);
  solved.solution.bands = rgb_bands();
  solved.mesh.emission.setZero();
  solved.solution.direct_irradiance.setConstant(75.0f);
  solved.solution.indirect_irradiance.setConstant(25.0f);
  write_solution(file(), solved);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file().c_str());
  reader->Update();
  vtkPointData* light = reader->GetOutput()->GetPointData();
  // The three weights are rounded to float, each to half a unit in the last place.
  EXPECT_NEAR(light->GetArray("illuminance_lux")->GetComponent(0, 0), 68300.0, 68300.0 * 2e-7);
  // Every surface at the mean: x = 1/2, so x/(1+x) = 1/3, in sRGB 1.055 (1/3)^(1/2.4) - 0.055 =
  // 0.6125, and that is 156.2 of 255.
  for (int c = 0; c < 3; ++c) EXPECT_EQ(light->GetScalars()->GetComponent(4, c), 156.0);
}

// Arrays of several blocks of 32768 bytes, of one that is full, and of one value.
TEST_F(PolyDataText, HoldsArraysOfAnyLength) {
  PolyData data;
  data.points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  data.corners = {0, 1, 2};
  data.ends = {3};
  std::vector<double> long_values(20001);
  std::iota(long_values.begin(), long_values.end(), -0.5);
  std::vector<int> full_block(8192);
  std::iota(full_block.begin(), full_block.end(), -4000);
  add_values(data.field, "long", long_values.data(), 6667, 3);
  add_values(data.field, "full", full_block.data(), 8192);
  add_values(data.field, "one", full_block.data(), 1);
  add_strings(data.field, "words", {"", "b\xc3\xa4", "c"});
  write_pieces(file(), poly_data_text(std::move(data)));

  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file().c_str());
  reader->Update();
  vtkFieldData* const field = reader->GetOutput()->GetFieldData();
  for (const char* name : {"long", "full", "one"})
    ASSERT_NE(field->GetArray(name), nullptr) << name;
  EXPECT_EQ(field->GetArray("long")->GetNumberOfTuples(), 6667);
  EXPECT_EQ(0, std::memcmp(field->GetArray("long")->GetVoidPointer(0), long_values.data(),
                           sizeof(double) * long_values.size()));
  EXPECT_EQ(field->GetArray("full")->GetNumberOfTuples(), 8192);
  EXPECT_EQ(0, std::memcmp(field->GetArray("full")->GetVoidPointer(0), full_block.data(),
                           sizeof(int) * full_block.size()));
  EXPECT_EQ(field->GetArray("one")->GetTuple1(0), -4000.0);
  auto* const words = vtkStringArray::SafeDownCast(field->GetAbstractArray("words"));
  ASSERT_NE(words, nullptr);
  ASSERT_EQ(words->GetNumberOfValues(), 3);
  EXPECT_EQ(words->GetValue(0), "");
  EXPECT_EQ(words->GetValue(1), "b\xc3\xa4");
}

}  // namespace
}  // namespace lightwell::poly_data_test
