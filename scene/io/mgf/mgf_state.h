#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <string>

#include "scene/bands.h"
#include "scene/io/mgf/mgf_color.h"
#include "scene/io/remarks.h"
#include "scene/scene.h"

namespace lightwell {

/// A material of an MGF file. Shares count for the luminance, in the colour of their time.
struct MgfMaterial {
  struct Lobe {
    Spectrum share = Spectrum::Zero(3);
    double alpha = 0.0;  ///< root mean square slope of facets
  };
  bool is_two_sided = true;
  Spectrum diffuse = Spectrum::Zero(3), passed = Spectrum::Zero(3);
  Spectrum exitance = Spectrum::Zero(3);  ///< W/m^2
  Lobe mirror{}, straight{};
  double index = 1.0;  ///< of refraction
  int number = -1;     ///< of the scene's material; -1: not yet made
};

/// A vertex of an MGF file.
struct MgfVertex {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
};

/// Current values of one kind: named ones, and the one in use.
template <class Value>
class MgfContext {
 public:
  Value& current() { return *current_; }
  const std::string& name() const { return name_; }
  Value* find(const std::string& name) {
    const auto found = named_.find(name);
    return found == named_.end() ? nullptr : &found->second;
  }
  /// Uses the value of this name. False: there is none.
  bool use(const std::string& name) {
    Value* found = find(name);
    if (!found) return false;
    current_ = found;
    name_ = name;
    return true;
  }
  /// Defines a name and uses its value.
  void define(const std::string& name, const Value& value) {
    named_[name] = value;
    use(name);
  }
  /// Uses a value without a name.
  void reset() {
    unnamed_ = Value();
    current_ = &unnamed_;
    name_.clear();
  }

 private:
  std::map<std::string, Value> named_;
  Value unnamed_{};
  Value* current_ = &unnamed_;
  std::string name_{};
};

/// The material of the scene that an MGF material amounts to.
Material mgf_material(const MgfMaterial& from, const std::string& name, Remarks& remarks);

}  // namespace lightwell
