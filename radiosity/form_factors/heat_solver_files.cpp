#include "radiosity/form_factors/heat_solver_files.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "radiosity/form_factors/text_output.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

void begin_foam_file(TextOutput& out, const char* type, const char* object) {
  out.add(
      "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n"
      "    location    \"constant\";\n    object      {};\n}}\n\n",
      type, object);
}

// The numbers 0 to count - 1 as a list of OpenFOAM.
void add_identity(TextOutput& out, int count) {
  out.add("{}(", count);
  for (int i = 0; i < count; ++i) out.add("{}{}", i == 0 ? "" : " ", i);
  out.add(")\n");
}

// A list for each face, with what `add` says of its factors.
template <class Add>
void add_face_lists(TextOutput& out, const ViewFactors& view_factors, int first, Add add) {
  out.add("{}\n(\n", view_factors.row_count() - first);
  for (int i = first; i < view_factors.row_count(); ++i) {
    const auto row = view_factors.row(i);
    const auto seen =
        std::ranges::find_if(row, [&](const FormFactor& each) { return each.patch >= first; });
    out.add("{}(", row.end() - seen);
    for (auto each = seen; each != row.end(); ++each) {
      if (each != seen) out.add(" ");
      add(*each);
    }
    out.add(")\n");
  }
  out.add(")\n");
}

// Lengths of the runs of rows of one name.
std::vector<int> patch_sizes(const ViewFactorRows& rows, int first) {
  std::vector<int> sizes;
  for (auto i = static_cast<std::size_t>(first); i < rows.name.size(); ++i) {
    const bool begins = sizes.empty() || rows.name[i] != rows.name[i - 1];
    if (begins) sizes.push_back(0);
    ++sizes.back();
  }
  return sizes;
}

// A name that MOOSE's lists of names can hold.
std::string as_word(std::string name) {
  for (char& c : name) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.';
    if (!is_plain) c = '_';
  }
  return name.empty() ? "surface" : name;
}

std::string unique_word(const std::string& name, std::set<std::string>& taken) {
  const std::string word = as_word(name);
  std::string result = word;
  for (int n = 2; !taken.insert(result).second; ++n) result = fmt::format("{}_{}", word, n);
  return result;
}

void add_user_object(TextOutput& out, const SurfaceViewFactors& surfaces) {
  out.add(
      "# View factors between surfaces: row i, column j, the share of what leaves i that reaches "
      "j.\n[UserObjects]\n  [view_factors]\n    type = SpecifiedViewFactor\n    boundary = '{}'\n"
      "    view_factors = '\n",
      fmt::join(surfaces.name, " "));
  for (std::size_t i = 0; i < surfaces.factor.size(); ++i) {
    out.add("      {:.9g}{}\n", fmt::join(surfaces.factor[i], " "),
            i + 1 < surfaces.factor.size() ? ";" : "'");
  }
  out.add("    execute_on = INITIAL\n  []\n[]\n");
}

void add_table(TextOutput& out, const SurfaceViewFactors& surfaces) {
  out.add("boundary,area,{}\n", fmt::join(surfaces.name, ","));
  for (std::size_t i = 0; i < surfaces.factor.size(); ++i) {
    out.add("{},{:.9g},{:.9g}\n", surfaces.name[i], surfaces.area[i],
            fmt::join(surfaces.factor[i], ","));
  }
}

}  // namespace

std::vector<std::string> openfoam_file_names() {
  return {"F", "globalFaceFaces", "finalAgglom", "subMap", "constructMap", "constructMapDim"};
}

void write_openfoam(const std::filesystem::path& folder, const ViewFactors& view_factors,
                    const ViewFactorRows& rows, int first) {
  const int faces = view_factors.row_count() - first;
  const auto write = [&](const char* type, const char* object, auto&& add_content) {
    TextOutput out(folder / object);
    begin_foam_file(out, type, object);
    add_content(out);
    out.commit();
  };
  write("scalarListList", "F", [&](TextOutput& out) {
    add_face_lists(out, view_factors, first,
                   [&](const FormFactor& each) { out.add("{:.9g}", each.value); });
  });
  write("labelListList", "globalFaceFaces", [&](TextOutput& out) {
    add_face_lists(out, view_factors, first,
                   [&](const FormFactor& each) { out.add("{}", each.patch - first); });
  });
  write("labelListList", "finalAgglom", [&](TextOutput& out) {
    const std::vector<int> sizes = patch_sizes(rows, first);
    out.add("{}\n(\n", sizes.size());
    for (const int size : sizes) add_identity(out, size);
    out.add(")\n");
  });
  for (const char* map : {"subMap", "constructMap"}) {
    write("labelListList", map, [&](TextOutput& out) {
      out.add("1\n(\n");
      add_identity(out, faces);
      out.add(")\n");
    });
  }
  write("labelList", "constructMapDim", [&](TextOutput& out) { out.add("1({})\n", faces); });
}

SurfaceViewFactors surface_view_factors(const std::filesystem::path& file,
                                        const ViewFactors& view_factors,
                                        const ViewFactorRows& rows) {
  std::map<std::string, std::size_t> number_of;
  std::vector<std::size_t> surface(rows.name.size(), 0);
  std::set<std::string> taken;
  SurfaceViewFactors result;
  for (std::size_t i = 0; i < rows.name.size(); ++i) {
    if (!(view_factors.area[i] > 0.0)) continue;
    const auto [at, is_new] = number_of.emplace(rows.name[i], result.name.size());
    surface[i] = at->second;
    if (is_new) {
      result.name.push_back(unique_word(rows.name[i], taken));
      result.area.push_back(0.0);
    }
    result.area[at->second] += view_factors.area[i];
  }
  if (result.name.size() > static_cast<std::size_t>(most_moose_surfaces)) {
    throw InputError(
        fmt::format("{}: view factors between {} surfaces would fill gigabytes as text; at most {} "
                    "are written. Join surfaces, or use the Matrix Market file",
                    file.string(), result.name.size(), most_moose_surfaces));
  }
  result.factor.assign(result.name.size(), std::vector<double>(result.name.size(), 0.0));
  for (int i = 0; i < view_factors.row_count(); ++i) {
    const auto I = surface[static_cast<std::size_t>(i)];
    const double A_i = view_factors.area[static_cast<std::size_t>(i)];
    for (const auto [j, F] : view_factors.row(i)) {
      result.factor[I][surface[static_cast<std::size_t>(j)]] += A_i * F / result.area[I];
    }
  }
  return result;
}

void write_moose(const std::filesystem::path& path, const ViewFactors& view_factors,
                 const ViewFactorRows& rows) {
  const SurfaceViewFactors surfaces = surface_view_factors(path, view_factors, rows);
  TextOutput out(path);
  if (path.extension() == ".i") {
    add_user_object(out, surfaces);
  } else {
    add_table(out, surfaces);
  }
  out.commit();
}

}  // namespace lightwell
