#include <fmt/format.h>

#include <map>

#include "scene/io/convex_cut.h"
#include "scene/io/numbered_scene.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/vs3/vs3_records.h"

namespace lightwell {
namespace {

using Vs3Kind = Vs3Record::Kind;

class Vs3Builder {
 public:
  Vs3Builder(const TextFile& file, const Vs3Content& content) : file_(file), content_(content) {}

  NumberedScene build() {
    Scene& scene = numbered_.scene;
    scene.file = file_.path();
    scene.title =
        content_.title.empty() ? file_.path().stem().string() : std::string(content_.title);
    numbered_.is_enclosure = content_.encl;
    for (const Vs3Record& record : content_.surfaces) pieces_.push_back({record.loop});
    for (std::size_t i = 0; i < content_.surfaces.size(); ++i) check_and_cut(i);
    for (std::size_t i = 0; i < content_.surfaces.size(); ++i) add_surface(i);
    if (scene.surfaces.empty()) {
      file_.fail(content_.surfaces.front().line, "no surface of the file has an area");
    }
    add_notes();
    validate(scene);
    return std::move(numbered_);
  }

 private:
  [[noreturn]] void fail(std::size_t i, const std::string& what) const {
    file_.fail(content_.surfaces[i].line, fmt::format("surface {} {}", i + 1, what));
  }

  // Checks the references of a surface to others and cuts the surface out of its base.
  void check_and_cut(std::size_t i) {
    const Vs3Record& record = content_.surfaces[i];
    const int count = static_cast<int>(content_.surfaces.size());
    if (record.kind == Vs3Kind::mask) {
      fail(i,
           "is a mask (M), which cannot be read; describe what the mask leaves visible as "
           "surfaces of their own");
    }
    if (record.combine != 0) {
      if (record.combine < 1 || record.combine > static_cast<int>(i)) {
        fail(i,
             fmt::format("is to be combined with surface {}; name one before it", record.combine));
      }
      const Vs3Record& with = content_.surfaces[static_cast<std::size_t>(record.combine) - 1];
      if (record.kind != Vs3Kind::radiating || with.kind != Vs3Kind::radiating) {
        fail(i, "is combined; only radiating surfaces (S) can be combined");
      }
      if (with.combine != 0) {
        fail(i, fmt::format("is to be combined with surface {}, which is itself combined; name "
                            "surface {}",
                            record.combine, with.combine));
      }
    }
    if (record.kind == Vs3Kind::null && record.base == 0) {
      fail(i, "is a null surface (N), which needs the number of its base surface");
    }
    if (record.base == 0) return;
    if (record.base < 1 || record.base > count) {
      fail(i, fmt::format("has base surface {}; there are surfaces 1 to {}", record.base, count));
    }
    cut_from_base(i, static_cast<std::size_t>(record.base) - 1);
  }

  void cut_from_base(std::size_t i, std::size_t base) {
    const Loop& hole = content_.surfaces[i].loop;
    const Vs3Record& of = content_.surfaces[base];
    if (of.kind != Vs3Kind::obstruction && base >= i) {
      fail(i, fmt::format("has base surface {}, which must come before it", base + 1));
    }
    if (of.base != 0) {
      fail(i, fmt::format("lies on surface {}, which is itself a subsurface; name surface {} as "
                          "its base",
                          base + 1, of.base));
    }
    const Eigen::Vector3d area = area_vector(hole), base_area = area_vector(of.loop);
    if (!(area.norm() > 0.0) || !(base_area.norm() > 0.0)) {
      fail(i, fmt::format("or its base surface {} has no area", base + 1));
    }
    if (!is_convex(hole) || !is_convex(of.loop)) {
      fail(i, fmt::format("and its base surface {} must be convex", base + 1));
    }
    // View3D computes in single precision.
    constexpr double tolerance = 1e-5;
    for (const Eigen::Vector3d& p : hole) {
      const double distance = (p - of.loop[0]).dot(base_area.normalized());
      if (!(std::abs(distance) <= tolerance * size_of(of.loop))) {
        fail(i, fmt::format("does not lie in the plane of its base surface {}", base + 1));
      }
    }
    if (!(area.dot(base_area) > 0.0)) {
      fail(i, fmt::format("faces away from its base surface {}; turn the order of its vertices",
                          base + 1));
    }
    const double before = total_area(pieces_[base]);
    pieces_[base] = cut_out(pieces_[base], hole);
    const double taken = before - total_area(pieces_[base]);
    if (!(std::abs(taken - area.norm()) <= tolerance * base_area.norm())) {
      fail(i, fmt::format("reaches beyond its base surface {} or overlaps another subsurface",
                          base + 1));
    }
  }

  static double total_area(const std::vector<Loop>& pieces) {
    double area = 0.0;
    for (const Loop& loop : pieces) area += area_vector(loop).norm();
    return area;
  }

  int row_of(std::size_t i) {
    const Vs3Record& record = content_.surfaces[i];
    int row = -1;
    if (record.combine != 0) {
      row = row_of_record_[static_cast<std::size_t>(record.combine) - 1];
    } else if (record.kind == Vs3Kind::radiating) {
      row = static_cast<int>(numbered_.rows.size());
      numbered_.rows.push_back({.name = record.name, .emittance = record.emittance});
    }
    row_of_record_.push_back(row);
    return row;
  }

  int material_of(const Vs3Record& record) {
    const bool is_opaque_only = record.kind != Vs3Kind::radiating;
    const double reflectance = is_opaque_only ? 0.0 : 1.0 - record.emittance;
    const std::string name =
        is_opaque_only ? "obstruction" : fmt::format("emittance {:g}", record.emittance);
    auto& materials = numbered_.scene.materials;
    const auto [entry, is_new] = material_.emplace(name, static_cast<int>(materials.size()));
    if (is_new) {
      const Bands& bands = numbered_.scene.bands;
      materials.push_back({.name = name,
                           .reflectance = constant_spectrum(bands, static_cast<float>(reflectance)),
                           .specular = constant_spectrum(bands, 0.0f),
                           .emission = constant_spectrum(bands, 0.0f),
                           .one_sided = true});
    }
    return entry->second;
  }

  void add_surface(std::size_t i) {
    const Vs3Record& record = content_.surfaces[i];
    const int row = row_of(i);
    MeshBuilder mesh;
    for (const Loop& loop : pieces_[i]) add_repaired(mesh, loop, repairs_);
    if (mesh.empty()) {
      add_loss(numbered_.scene,
               fmt::format("Surface {} '{}' has nothing left of its area.", i + 1, record.name));
      return;
    }
    const std::size_t facets = mesh.mesh().facets.size();
    numbered_.row_of_facet.insert(numbered_.row_of_facet.end(), facets, row);
    numbered_.scene.surfaces.push_back(
        {.name = record.name, .material = material_of(record), .shape = mesh.mesh()});
  }

  void add_notes() {
    auto& notes = numbered_.scene.notes;
    note_repairs(repairs_, numbered_.scene);
    if (content_.emit) {
      notes.emplace_back(
          "The control word emit=1 is passed over: factors are geometric, without emittances.");
    }
    if (content_.has_transformation) {
      notes.emplace_back("X records (coordinate transformations) are passed over, as View3D does.");
    }
  }

  const TextFile& file_;
  const Vs3Content& content_;
  NumberedScene numbered_;
  std::vector<std::vector<Loop>> pieces_;  // by record: the parts not covered by subsurfaces
  std::vector<int> row_of_record_;
  std::map<std::string, int> material_;
  Repairs repairs_;
};

}  // namespace

NumberedScene read_numbered_vs3(const std::filesystem::path& path) {
  const TextFile file(path);
  const Vs3Content content = read_vs3_records(file);
  return Vs3Builder(file, content).build();
}

Scene read_vs3(const std::filesystem::path& path) {
  return read_numbered_vs3(path).scene;
}

}  // namespace lightwell
