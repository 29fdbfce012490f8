// Files that VTK's own writer wrote, as those of earlier versions are; built where the window is.
#include "radiosity/solution/poly_data_file.h"

#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <functional>

#include "radiosity/solution/solution_file.h"
#include "radiosity/solution/solution_seal.h"
#include "tests/radiosity/refused_solution.h"
#include "tests/radiosity/small_solution.h"

namespace lightwell::poly_data_file_test {
namespace {

/// Files changed and sealed again: values are checked in spite of a valid seal.
class VtkSolution : public SolutionFile {
 protected:
  fs::path changed(const std::function<void(vtkPolyData*)>& change) {
    write_solution(file(), small_solution(3));
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file().c_str());
    reader->Update();
    change(reader->GetOutput());
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(reader->GetOutput());
    writer->SetFileName(file("changed.vtp").c_str());
    writer->SetEncodeAppendedData(0);
    writer->SetHeaderTypeToUInt64();
    writer->Write();
    put(file("changed.vtp"), solution_preamble("") + contents(file("changed.vtp")));
    seal_solution(file("changed.vtp"));
    return file("changed.vtp");
  }
  void expect_refused_after(const std::function<void(vtkPolyData*)>& change,
                            const std::string& reason) {
    expect_refused(changed(change), reason);
  }
};

// A solution of an earlier version, from VTK's writer, in 64-bit and in 32-bit numbers of points.
TEST_F(VtkSolution, HasTheBitsOfTheSolutionThatItWasMadeFrom) {
  for (const bool is_narrow : {false, true}) {
    const fs::path path = changed([&](vtkPolyData* p) {
      if (is_narrow) p->GetPolys()->ConvertTo32BitStorage();
    });
    const SolvedScene again = read_solution(path), made = small_solution(3);
    EXPECT_EQ(again.mesh.corners, made.mesh.corners);
    EXPECT_EQ(again.mesh.area.matrix(), made.mesh.area.matrix());
    EXPECT_EQ(again.solution.provenance.options, made.solution.provenance.options);
  }
}

TEST_F(VtkSolution, ReadsArraysOfAnyLength) {
  const fs::path path = changed([](vtkPolyData* p) {
    for (const int length : {1, 8192, 20001}) {  // one block of 32768 bytes is full with 8192
      vtkNew<vtkIntArray> values;
      values->SetName(std::to_string(length).c_str());
      for (int i = 0; i < length; ++i) values->InsertNextValue(7 * i);
      p->GetFieldData()->AddArray(values);
    }
  });
  PolyDataFile file(path);
  for (const int length : {1, 8192, 20001}) {
    const StoredArray* array = file.find(PolyDataFile::Place::field, std::to_string(length));
    ASSERT_NE(array, nullptr) << length;
    const std::vector<int> values = file.values<int>(*array);
    ASSERT_EQ(std::ssize(values), length);
    for (int i = 0; i < length; ++i) ASSERT_EQ(values[static_cast<std::size_t>(i)], 7 * i);
  }
}

TEST_F(VtkSolution, LightIsInWattsWhereAnOldFileDoesNotSay) {
  const fs::path old = changed([](vtkPolyData* p) { p->GetFieldData()->RemoveArray("light"); });
  EXPECT_FALSE(read_solution(old).solution.relative_units);
}

TEST_F(VtkSolution, IndicesOutOfRangeAreRefused) {
  const auto set = [](vtkFieldData* data, const char* name, vtkIdType row, double value) {
    data->GetArray(name)->SetComponent(row, 0, value);
  };
  using Poly = vtkPolyData*;
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "twin", 0, 3); }, "'twin' holds 3");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "patch", 2, -1); }, "'patch' holds -1");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "patch", 2, 0); },
                       "names patch 0, which does not include");
  expect_refused_after([&](Poly p) { set(p->GetCellData(), "area", 1, 0.0); }, "not positive");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "patch_material", 0, -4); },
                       "'patch_material' holds -4");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "patch_first_element", 1, 9); },
                       "does not divide");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "sphere_element", 1, 12); },
                       "'sphere_element' holds 12");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "sphere_facet_rings_sectors", 1, -5); },
                       "sphere grid 1");
  expect_refused_after([&](Poly p) { set(p->GetFieldData(), "outcome", 0, 7); },
                       "'outcome' holds 7");
  expect_refused_after(
      [&](Poly p) { p->GetPolys()->GetConnectivityArray()->SetComponent(2, 0, 9); },
      "names point 9 of 9");
  expect_refused_after(
      [&](Poly p) { p->GetPolys()->GetConnectivityArray()->SetComponent(2, 0, 0); }, "twice");
  expect_refused_after(
      [&](Poly p) {
        vtkNew<vtkCellArray> pentagon_first;
        pentagon_first->InsertNextCell({0, 1, 4, 2, 3});
        pentagon_first->InsertNextCell({1, 4, 2});
        pentagon_first->InsertNextCell({5, 6, 7, 8});
        p->SetPolys(pentagon_first);
      },
      "polygon 0 has neither 3 nor 4");
}

TEST_F(VtkSolution, MissingArraysAreNamed) {
  for (const char* name : {"patch_area", "patch_radiosity", "scene_hash",
                           "energy_emitted_absorbed_"
                           "escaped_unshot"}) {
    expect_refused_after([&](vtkPolyData* p) { p->GetFieldData()->RemoveArray(name); }, name);
  }
  for (const char* name : {"direct_irradiance", "normal"}) {
    expect_refused_after([&](vtkPolyData* p) { p->GetPointData()->RemoveArray(name); }, name);
  }
  expect_refused_after([](vtkPolyData* p) { p->Initialize(); }, "cannot read");
}

}  // namespace
}  // namespace lightwell::poly_data_file_test
