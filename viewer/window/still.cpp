#include "viewer/window/still.h"

#include <vtkActor2D.h>
#include <vtkImageData.h>
#include <vtkImageMapper.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include "raytrace/scene_renderer.h"
#include "scene/errors.h"
#include "viewer/export/appearance.h"

namespace lightwell {
namespace {

// The parts of a solution that render() reads. Light channels, which may be many times as large,
// are left out.
SolvedScene for_rendering(const SolvedScene& solved) {
  SolvedScene copy;
  copy.mesh = solved.mesh;
  const RadiositySolution& s = solved.solution;
  copy.solution.bands = s.bands;
  copy.solution.patch_radiosity = s.patch_radiosity;
  copy.solution.direct_irradiance = s.direct_irradiance;
  copy.solution.indirect_irradiance = s.indirect_irradiance;
  copy.solution.caustic_irradiance = s.caustic_irradiance;
  copy.solution.interpolation_error = s.interpolation_error;
  copy.solution.gather_noise = s.gather_noise;
  copy.solution.parts = s.parts;
  copy.solution.error_estimate = s.error_estimate;
  return copy;
}

bool is_same(const BandArray& a, const BandArray& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a == b).all();
}

// True if two solutions of one scene have the same light. Between them only dimming can change
// elements and lamps.
bool is_same_light(const SolvedScene& a, const SolvedScene& b) {
  return a.mesh.element_count() == b.mesh.element_count() &&
         is_same(a.mesh.emission, b.mesh.emission) &&
         is_same(a.mesh.source_scale, b.mesh.source_scale) &&
         is_same(a.solution.direct_irradiance, b.solution.direct_irradiance) &&
         is_same(a.solution.indirect_irradiance, b.solution.indirect_irradiance) &&
         is_same(a.solution.caustic_irradiance, b.solution.caustic_irradiance);
}

}  // namespace

struct Still::Kept {
  Kept(const Scene& of_scene, const SolvedScene& of) : scene(of_scene), solved(for_rendering(of)) {}

  // Made by the first job, in the job's thread, which does not block the window.
  SceneRenderer& renderer() {
    const std::lock_guard lock(mutex);
    if (!made) made = std::make_unique<SceneRenderer>(scene, solved.mesh, solved.solution);
    return *made;
  }

  const Scene& scene;
  const SolvedScene solved;
  std::mutex mutex{};  ///< guards `made`
  std::unique_ptr<SceneRenderer> made{};
};

struct Still::Job {
  Job(std::shared_ptr<Kept> with, const Camera& camera, const Eigen::Array3f& with_scale)
      : kept(std::move(with)), scale(with_scale), thread([this, camera] { run(camera); }) {}
  ~Job() {
    cancelled = true;
    thread.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void run(const Camera& camera) {
    try {
      RenderOptions options;
      options.run.progress = [this](std::string_view, double share) {
        progress = share;
        return !cancelled;
      };
      options.rows_done = [this](const Image& so_far, int first, int rows) {
        show(so_far, first, rows);
      };
      image = kept->renderer().render(camera, options);
    } catch (const Interrupted&) {
      // The job was cancelled.
    } catch (const std::exception& error) {
      failure = error.what();
    }
    done = true;
  }

  void show(const Image& so_far, int first, int rows) {
    const BandArray strip = so_far.radiance.middleRows(Eigen::Index{first} * so_far.width,
                                                       Eigen::Index{rows} * so_far.width);
    const auto colors = display_colors(strip, kept->solved.solution.bands, scale);
    const std::lock_guard lock(mutex);
    fresh.insert(fresh.end(), colors.begin(), colors.end());
  }

  std::shared_ptr<Kept> kept;
  Eigen::Array3f scale;
  Image image{};
  std::string failure{};
  std::mutex mutex{};
  std::vector<std::uint8_t> fresh{};  ///< rows not taken over yet; guarded by the mutex
  std::atomic<double> progress{0.0};
  std::atomic<bool> cancelled{false}, done{false};
  std::thread thread;  // last, since the thread uses the other members
};

Still::Still()
    : data_(vtkSmartPointer<vtkImageData>::New()), actor_(vtkSmartPointer<vtkActor2D>::New()) {
  vtkNew<vtkImageMapper> mapper;
  mapper->SetInputData(data_);
  mapper->SetColorWindow(255.0);
  mapper->SetColorLevel(127.5);
  actor_->SetMapper(mapper);
  actor_->VisibilityOff();
}

Still::~Still() = default;

void Still::add_to(vtkRenderer* renderer) const {
  renderer->AddViewProp(actor_);
}

void Still::begin(const Scene& scene, const SolvedScene& solved, const Camera& camera,
                  const Eigen::Array3f& scale) {
  discard();
  camera_ = camera;
  picture_.assign(std::size_t{3} * camera.width * camera.height, 0);
  phase_ = StillPhase::rendering;
  if (!kept_ || &kept_->scene != &scene || !is_same_light(kept_->solved, solved)) {
    kept_ = std::make_shared<Kept>(scene, solved);
  }
  job_ = std::make_unique<Job>(kept_, camera, scale);
}

void Still::discard() {
  std::erase_if(ending_, [](const std::unique_ptr<Job>& job) { return job->done.load(); });
  if (job_) {
    job_->cancelled = true;
    ending_.push_back(std::move(job_));
  }
  phase_ = StillPhase::none;
  rows_ = 0;
  actor_->VisibilityOff();
}

double Still::progress() const {
  return job_ ? job_->progress.load() : 0.0;
}

bool Still::advance() {
  if (phase_ != StillPhase::rendering) return false;
  // Read before the rows: if the job was done, the rows taken below include the last.
  const bool is_done = job_->done;
  std::vector<std::uint8_t> fresh;
  {
    const std::lock_guard lock(job_->mutex);
    fresh.swap(job_->fresh);
  }
  const auto row = std::size_t{3} * static_cast<std::size_t>(camera_.width);
  std::copy(fresh.begin(), fresh.end(),
            picture_.begin() + static_cast<std::ptrdiff_t>(row) * rows_);
  rows_ += static_cast<int>(fresh.size() / row);
  if (!fresh.empty()) draw();
  if (!is_done) return !fresh.empty();
  if (!job_->failure.empty()) {
    failure_ = job_->failure;
    discard();
    phase_ = StillPhase::failed;
    return true;
  }
  image_ = std::move(job_->image);
  job_.reset();
  phase_ = StillPhase::shown;
  return true;
}

// VTK's rows begin at the bottom, so the finished rows are reversed and placed at the window's top.
void Still::draw() {
  data_->SetDimensions(camera_.width, rows_, 1);
  data_->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto row = std::ptrdiff_t{3} * camera_.width;
  auto* out = static_cast<std::uint8_t*>(data_->GetScalarPointer());
  for (int y = 0; y < rows_; ++y) {
    std::copy_n(picture_.begin() + row * (rows_ - 1 - y), row, out + row * y);
  }
  data_->Modified();
  actor_->SetPosition(0.0, camera_.height - rows_);
  actor_->VisibilityOn();
}

}  // namespace lightwell
