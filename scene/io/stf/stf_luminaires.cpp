#include "scene/io/stf/stf_luminaires.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "scene/degree.h"

namespace lightwell {
namespace {

// Web of a Lambertian opening that faces down, 1 cd at gamma = 0. Half degrees keep the linear
// interpolation of a cosine within h^2 / 8 = 1e-5.
SharedWeb even_web() {
  constexpr int steps = 180;
  std::vector<double> gammas;
  Eigen::ArrayXXd values(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    gammas.push_back(90.0 * i / steps);
    values(0, i) = i == steps ? 0.0 : std::cos(gammas.back() * degree);
  }
  return std::make_shared<const PhotometricWeb>(std::vector<double>{0.0}, std::move(gammas),
                                                values);
}

constexpr double largest_box = 100.0;        // m; larger numbers are millimetres
constexpr double most_of_a_luminaire = 1e9;  // lm and W

// True for a name that a file beside the scene may have.
bool may_name_a_file(const std::string& name) {
  constexpr std::size_t longest = 200;
  return !name.empty() && name.size() <= longest && name.find_first_of("/\\:") == std::string::npos;
}

}  // namespace

Eigen::Matrix3d stf_rotation(const Eigen::Vector3d& angles) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(angles.z() * degree, Vector3d::UnitZ()) *
          AngleAxisd(angles.y() * degree, Vector3d::UnitY()) *
          AngleAxisd(angles.x() * degree, Vector3d::UnitX()))
      .toRotationMatrix();
}

void StfLuminaires::add(StfSection& room, double floor) {
  const std::size_t count = room.counted("Lum", "NrLums");
  for (std::size_t i = 1; i <= count; ++i) {
    const std::string key = fmt::format("Lum{}", i);
    remarks_.attempt("Luminaires that cannot be used were left out",
                     fmt::format("[{}] {}", room.name(), key), [&] { add_one(room, key, floor); });
  }
}

void StfLuminaires::add_one(StfSection& room, const std::string& key, double floor) {
  const Type& type = type_of(room.text(key));
  const std::string at = key + ".Pos", turn = key + ".Rot";
  const std::vector<double> position = room.numbers(at, 3);
  const Eigen::Vector3d angles = room.vector_or(turn, Eigen::Vector3d::Zero());
  if (!type.is_known) return;
  Lamp lamp{.name = names_.unique(type.name)};
  const Spectrum white = constant_spectrum(scene_.bands, 1.0f);
  if (type.file) {
    place_luminaire(*type.file, scene_.bands, white, lamp);
    if (type.file->is_radiometric) scene_.relative_units = true;
  } else {
    if (!even_) even_ = even_web();
    lamp.shape = even_;
    lamp.opening = type.opening;
    lamp.intensity =
        white * static_cast<float>(type.lumens / luminous(scene_.bands, white) / even_->integral());
  }
  lamp.position = {position[0], position[1], floor + position[2]};
  lamp.axes = stf_rotation(angles);
  scene_.lamps.push_back(std::move(lamp));
  design_.watts.push_back(type.watts);
  design_.luminous_height.push_back(type.file ? type.file->opening_height : 0.0);
  design_.files.push_back(type.file);
}

const StfLuminaires::Type& StfLuminaires::type_of(const std::string& reference) {
  const auto found = types_.find(reference);
  if (found != types_.end()) return found->second;
  StfSection* section = file_.find(reference);
  StfSection none = file_.absent(reference);
  return types_.emplace(reference, read_type(reference, section ? *section : none)).first->second;
}

StfLuminaires::Type StfLuminaires::read_type(const std::string& reference, StfSection& section) {
  const std::string order_number = section.text("OrderNr"), name = section.text("Name");
  Type type{.name = !name.empty() ? name : !order_number.empty() ? order_number : reference};
  remarks_.attempt("Luminaires with values that cannot be used lack them", reference,
                   [&] { read_values(section, type); });
  type.file = find_file({order_number, name, reference});
  type.is_known = type.file || type.lumens > 0.0;
  if (type.file) {
    if (!(type.watts > 0.0)) type.watts = type.file->watts;
    constexpr double alike = 0.01;  // catalogues round the flux
    if (type.lumens > 0.0 && std::abs(type.file->flux() - type.lumens) > alike * type.lumens) {
      remarks_.mention(
          "Luminaires whose photometric file has another flux than their section have that of "
          "the file",
          reference);
    }
  } else if (type.is_known) {
    remarks_.add(
        "Luminaires without a photometric file beside the scene, named like their order number, "
        "name or section, became even openings of the size of their box that have their flux",
        reference);
  } else {
    remarks_.add("Luminaires without flux and without a photometric file were left out", reference);
  }
  return type;
}

void StfLuminaires::read_values(StfSection& section, Type& type) {
  section.count("NrLamps");
  if (const auto shape = section.number("Shape"); shape && *shape != 0.0) {
    remarks_.add("Luminaires of another shape than a box (Shape=0) were read as boxes", type.name);
  }
  const Eigen::Vector3d box = section.vector_or("Box", Eigen::Vector3d::Zero());
  if (!(box.minCoeff() >= 0.0 && box.maxCoeff() <= largest_box)) {
    section.fail("Box", fmt::format("is {:g} {:g} {:g}; sizes are in metres, from 0 to {:g}",
                                    box.x(), box.y(), box.z(), largest_box));
  }
  type.opening = {.along_c0 = box.x(), .along_c90 = box.y()};
  const auto at_least_0 = [&](const char* key) {
    const double value = section.number(key).value_or(0.0);
    if (!(value >= 0.0 && value <= most_of_a_luminaire)) {
      section.fail(
          key, fmt::format("is {:g}; it must be between 0 and {:g}", value, most_of_a_luminaire));
    }
    return value;
  };
  type.lumens = at_least_0("Flux");
  type.watts = at_least_0("Load");
}

SharedLuminaireFile StfLuminaires::find_file(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!may_name_a_file(name)) continue;
    for (const char* extension : {".ldt", ".ies", ".LDT", ".IES"}) {
      const std::filesystem::path path = scene_.file.parent_path() / (name + extension);
      if (!is_file(path)) continue;
      if (const SharedLuminaireFile& file = read_file(path)) return file;
    }
  }
  return nullptr;
}

// The photometric file, read once; null if it cannot be used.
const SharedLuminaireFile& StfLuminaires::read_file(const std::filesystem::path& path) {
  const auto [at, is_new] = files_.try_emplace(path);
  if (!is_new) return at->second;
  remarks_.attempt(
      "Photometric files that cannot be used were left out", path.filename().string(), [&] {
        auto file = std::make_shared<const LuminaireFile>(read_luminaire(path));
        Lamp trial;
        place_luminaire(*file, scene_.bands, constant_spectrum(scene_.bands, 1.0f), trial);
        for (const std::string& note : luminaire_notes(*file)) scene_.notes.push_back(note);
        at->second = std::move(file);
      });
  return at->second;
}

void StfLuminaires::remark_unread() const {
  for (const auto& [reference, type] : types_) {
    if (const StfSection* section = file_.find(reference)) {
      section->remark_unread({"manufacturer", "mountingtype"});
    }
  }
}

}  // namespace lightwell
