#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "scene/io/lighting_design.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"
#include "scene/io/stf/stf_luminaires.h"
#include "scene/io/stf/stf_shells.h"

namespace lightwell {
namespace {

constexpr std::size_t most_rooms = 10'000;

// Keys that name what scenes and reports have no place for.
const std::set<std::string_view> keys_without_use = {"description", "progname", "progvers"};

class StfReader {
 public:
  explicit StfReader(const std::filesystem::path& path)
      : text_(path),
        file_(text_, remarks_),
        luminaires_(file_, scene_, design_, remarks_),
        shells_(file_, scene_, remarks_) {
    scene_.file = path;
  }

  void read() {
    StfSection& project = *file_.find("PROJECT");
    read_heading(project);
    read_rooms(project);
    set_levels(project, plans_, remarks_);
    for (std::size_t i = 0; i < rooms_.size(); ++i) add_room(*rooms_[i], plans_[i]);
    if (scene_.surfaces.empty()) {
      fail_without_surfaces(text_.path(), "the file has no room that can be read", remarks_);
    }
    set_maintenance();
    project.remark_unread(keys_without_use);
    for (const StfSection* room : rooms_) room->remark_unread(keys_without_use);
    luminaires_.remark_unread();
    shells_.remark_unread();
    file_.remark_unread();
    finish_scene(shells_.repairs(), remarks_, scene_);
  }

  Scene& scene() { return scene_; }
  LightingDesign& design() { return design_; }

 private:
  void read_heading(StfSection& project) {
    scene_.title = project.text("Name");
    const std::string planner = project.text("Planer"), author = project.text("Operator");
    design_.heading = {.project = scene_.title,
                       .author = author.empty() ? planner : author,
                       .date = project.text("Date"),
                       .remarks = project.text("Description")};
  }

  void read_rooms(StfSection& project) {
    if (!project.has("NrRooms")) {
      project.fail("lacks the key 'NrRooms'; add it, with the number of Room1 ...");
    }
    const std::size_t count = project.counted("Room", "NrRooms");
    if (count > most_rooms) {
      project.fail_limit(fmt::format("has {} rooms; at most {} can be read", count, most_rooms));
    }
    std::set<const StfSection*> known;
    for (std::size_t i = 1; i <= count; ++i) {
      const std::string reference = project.text(fmt::format("Room{}", i));
      StfSection* room = file_.find(reference);
      if (!room) {
        remarks_.add("Rooms without a section were left out", reference);
      } else if (known.insert(room).second) {
        remarks_.attempt("Rooms that cannot be used were left out", reference, [&] {
          const std::string name = room->text("Name");
          const std::string unique = names_.unique(name.empty() ? reference : name);
          plans_.push_back(read_stf_plan(*room, unique, remarks_));
          rooms_.push_back(room);
        });
      }
    }
  }

  void add_room(StfSection& room, const StfPlan& plan) {
    const auto floor = static_cast<int>(scene_.surfaces.size());
    shells_.add(room, plan);
    luminaires_.add(room, plan.level);
    remarks_.attempt("Working planes that cannot be used were left out", room.name(),
                     [&] { add_working_plane(room, plan, floor); });
    remarks_.attempt("Maintenance factors that cannot be used were left out", room.name(),
                     [&] { read_maintenance(room); });
  }

  void add_working_plane(StfSection& room, const StfPlan& plan, int floor) {
    const auto height = room.number("WorkingPlane");
    if (!height) return;
    if (!(*height >= 0.0 && *height < plan.height)) {
      room.fail("WorkingPlane", fmt::format("is {:g}; it must lie between 0 and the height {:g}",
                                            *height, plan.height));
    }
    design_.grids.push_back({.name = plan.name, .surface = floor, .height = *height});
  }

  void read_maintenance(StfSection& room) {
    const auto factor = room.number("MF");
    if (!factor) return;
    if (!(*factor > 0.0 && *factor <= 1.0)) {
      room.fail("MF", fmt::format("is {:g}; it must be above 0 and at most 1", *factor));
    }
    factors_.insert(*factor);
  }

  void set_maintenance() {
    if (factors_.size() == 1) design_.maintenance = MaintenanceParts{.room = *factors_.begin()};
    if (factors_.size() > 1) {
      remarks_.add(
          "Maintenance factors (MF) that differ from room to room were left out; give one with "
          "'report --maintenance'",
          fmt::format("{:g} to {:g}", *factors_.begin(), *factors_.rbegin()));
    }
  }

  TextFile text_;
  Scene scene_;
  LightingDesign design_;
  Remarks remarks_;
  StfFile file_;
  StfLuminaires luminaires_;
  StfShells shells_;
  NumberedNames names_;
  std::vector<StfSection*> rooms_;
  std::vector<StfPlan> plans_;
  std::set<double> factors_;
};

}  // namespace

Scene read_stf(const std::filesystem::path& path) {
  StfReader reader(path);
  reader.read();
  return std::move(reader.scene());
}

LightingDesign read_stf_lighting(const Scene& scene) {
  StfReader reader(scene.file);
  reader.read();
  return std::move(reader.design());
}

}  // namespace lightwell
