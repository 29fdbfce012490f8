#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/errors.h"
#include "scene/io/polygon_repair.h"
#include "scene/scene.h"

namespace lightwell {

/// Collects the approximations and omissions of a reader: one sentence for each kind, with the
/// names of the objects concerned.
class Remarks {
 public:
  /// Records that `what` ("Textures were left out in") concerns the object `name`: a loss, which is
  /// something of the file that is left out, approximated or missing.
  void add(std::string_view what, std::string_view name);
  /// add() for an object that cannot be used; the sentence ends with the reason `why` of the first.
  void add_unusable(std::string_view what, std::string_view name, std::string_view why);
  /// Calls `use`. Where that throws an InputError other than a LimitError, the object counts as
  /// unusable (see add_unusable()), and the result is false.
  template <class Use>
  bool attempt(std::string_view what, std::string_view name, Use&& use) {
    try {
      use();
      return true;
    } catch (const LimitError&) {
      throw;
    } catch (const InputError& error) {
      add_unusable(what, name, error.what());
      return false;
    }
  }
  /// Records an assumption or a peculiarity by which nothing of the file is lost.
  void mention(std::string_view what, std::string_view name);
  /// One sentence for every `what`, in the order of first mention, with at most five names.
  std::vector<std::string> sentences() const;
  /// Appends the sentences to Scene::notes, and those on losses, with all names, to Scene::losses.
  void report_to(Scene& scene) const;

 private:
  struct Remark {
    std::string what{};
    bool is_loss = true;
    std::vector<std::string> names{};
    std::set<std::string, std::less<>> known{};
    std::string why{};
  };
  Remark& record(std::string_view what, std::string_view name);
  static std::string sentence(const Remark& remark, std::size_t listed);

  std::vector<Remark> remarks_;
  std::map<std::string, std::size_t, std::less<>> numbers_{};  // of remarks, by `what`
};

/// Appends a sentence on something left out, approximated or missing to Scene::notes and losses.
void add_loss(Scene& scene, const std::string& sentence);

/// Appends the notes on repaired polygons. Dropped polygons, which are counted, and polygons that
/// cross themselves are losses.
void note_repairs(const Repairs& repairs, Scene& scene);

/// The error of a scene of which nothing can be used: `problem`, then what the remarks say.
/// Throws InputError.
[[noreturn]] void fail_without_surfaces(const std::filesystem::path& file, std::string_view problem,
                                        const Remarks& remarks);

/// Adds a remark on surfaces whose material has a picture, a mask or relief and whose facets lack
/// texture coordinates: there the mean of the picture is used, no mask and no relief.
void remark_pictures_without_uv(const Scene& scene, Remarks& remarks);

/// Removes texture coordinates from surfaces whose material shows no picture.
void drop_unused_uv(Scene& scene);

/// Adds a note if the scene has no light source.
void note_if_dark(Scene& scene);

/// The last steps of a reader whose surfaces may show pictures: drop_unused_uv(), all remarks, and
/// the notes on repairs and on darkness. Throws InputError of validate().
void finish_scene(const Repairs& repairs, Remarks& remarks, Scene& scene);

}  // namespace lightwell
