#include "viewer/still.h"

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

#include "raytrace/render.h"
#include "scene/errors.h"
#include "viewer/appearance.h"

namespace lightwell {
namespace {

// What render() reads of a solution; channels may be many times as large.
SolvedScene for_rendering(const SolvedScene& solved) {
  SolvedScene copy;
  copy.mesh = solved.mesh;
  const RadiositySolution& s = solved.solution;
  copy.solution.bands = s.bands;
  copy.solution.patch_radiosity = s.patch_radiosity;
  copy.solution.direct_irradiance = s.direct_irradiance;
  copy.solution.indirect_irradiance = s.indirect_irradiance;
  copy.solution.caustic_irradiance = s.caustic_irradiance;
  return copy;
}

}  // namespace

struct Still::Job {
  Job(const Scene& scene, const SolvedScene& of, const Camera& camera, double with_scale)
      : solved(for_rendering(of)),
        scale(with_scale),
        thread([this, &scene, camera] { run(scene, camera); }) {}
  ~Job() {
    cancelled = true;
    thread.join();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  void run(const Scene& scene, const Camera& camera) {
    try {
      const ElementCaster caster(solved.mesh);
      const DirectLight direct_light(scene, solved.mesh);
      RenderOptions options;
      options.progress = [this](std::string_view, double share) {
        progress = share;
        return !cancelled;
      };
      options.rows_done = [this](const Image& so_far, int first, int rows) {
        show(so_far, first, rows);
      };
      image = render(scene, caster, direct_light, solved.solution, camera, options);
    } catch (const Interrupted&) {
      // Nobody waits for it.
    } catch (const std::exception& error) {
      failure = error.what();
    }
    done = true;
  }

  void show(const Image& so_far, int first, int rows) {
    const BandArray strip = so_far.radiance.middleRows(Eigen::Index{first} * so_far.width,
                                                       Eigen::Index{rows} * so_far.width);
    const auto colors = display_colors(strip, solved.solution.bands, scale);
    const std::lock_guard lock(mutex);
    fresh.insert(fresh.end(), colors.begin(), colors.end());
  }

  SolvedScene solved;
  double scale;
  Image image{};
  std::string failure{};
  std::mutex mutex{};
  std::vector<std::uint8_t> fresh{};  ///< rows that nobody has taken yet; guarded by the mutex
  std::atomic<double> progress{0.0};
  std::atomic<bool> cancelled{false}, done{false};
  std::thread thread;  // last: it uses the others
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
                  double scale) {
  discard();
  camera_ = camera;
  picture_.assign(std::size_t{3} * camera.width * camera.height, 0);
  phase_ = StillPhase::rendering;
  job_ = std::make_unique<Job>(scene, solved, camera, scale);
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
  // Asked for first: what comes after the last rows is known to be all.
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

// VTK's rows begin at the bottom: those that are there lie at the window's top.
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
